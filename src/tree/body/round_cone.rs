//! A piece of wood with round ends: the hull of two balls, as a ray meets it.
//!
//! The hull is the union of the balls about `m(h) = a + h (b - a)` with radii `r_a + h dr`, `dr = r_b - r_a`, for h in 0..1. A point at
//! `w` from `a` is inside where for some h
//!
//! ```text
//! f(h) = |w - h l|² - (r_a + h dr)² <= 0,    l = b - a,    k = |l|² - dr²
//! ```
//!
//! `f` is least at `h = (w·l + r_a dr) / k`. Where that lies in 0..1 the surface is a cone, `|w|² - r_a² = (w·l + r_a dr)² / k`, which a
//! ray `w + t d` meets at the roots of a quadratic; the balls at the ends are the rest.

use bevy::math::{DVec3, Vec3};

/// The hull of two balls.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RoundCone {
    /// Middles of the balls, m.
    pub ends: [Vec3; 2],
    /// Their radii, m.
    pub radii_m: [f32; 2],
}

/// The quantities of the derivation above.
struct Hull {
    a: DVec3,
    l: DVec3,
    radius: f64,
    dr: f64,
    k: f64,
}

impl Hull {
    /// Where `f` is least, for a point at `w` from `a`; beyond 0..1 too. A hull that is one ball has it at the greater end.
    fn nearest(&self, w: DVec3) -> f64 {
        if self.k > 0.0 {
            (w.dot(self.l) + self.radius * self.dr) / self.k
        } else if self.dr > 0.0 {
            1.0
        } else {
            0.0
        }
    }

    fn is_inside(&self, w: DVec3) -> bool {
        let h = self.nearest(w).clamp(0.0, 1.0);
        (w - h * self.l).length() <= self.radius + h * self.dr
    }

    /// The nearest meeting with the cone between the balls.
    fn hit_cone(&self, w: DVec3, d: DVec3, from: f64) -> Option<f64> {
        if self.k <= 0.0 {
            return None;
        }
        let (along, way) = (w.dot(self.l) + self.radius * self.dr, d.dot(self.l));
        let square = d.length_squared() - way * way / self.k;
        let half = w.dot(d) - along * way / self.k;
        let rest = w.length_squared() - self.radius * self.radius - along * along / self.k;
        let root = (half * half - square * rest).sqrt();
        if root.is_nan() {
            return None;
        }
        // Both roots without the difference of numbers that are nearly the same.
        let sum = if half < 0.0 { root - half } else { -root - half };
        let on_cone = |t: &f64| *t >= from && (0.0..=1.0).contains(&self.nearest(w + *t * d));
        [sum / square, rest / sum].into_iter().filter(on_cone).reduce(f64::min)
    }
}

fn hit_ball(w: DVec3, d: DVec3, radius: f64, from: f64) -> Option<f64> {
    let half = w.dot(d);
    let root = (half * half - d.length_squared() * (w.length_squared() - radius * radius)).sqrt();
    let t = (-half - root) / d.length_squared();
    (t >= from).then_some(t)
}

impl RoundCone {
    fn hull(&self) -> Hull {
        let [a, b] = self.ends.map(Vec3::as_dvec3);
        let [radius, other] = self.radii_m.map(|radius_m| f64::from(radius_m.max(0.0)));
        let (l, dr) = (b - a, other - radius);
        Hull { a, l, radius, dr, k: l.length_squared() - dr * dr }
    }

    /// How far along a ray from `origin`, m, it is met first beyond `from_m`: `from_m` itself where that lies inside. `direction` has
    /// length 1.
    #[must_use]
    pub fn hit(&self, origin: Vec3, direction: Vec3, from_m: f32) -> Option<f32> {
        let hull = self.hull();
        let (w, d, from) = (origin.as_dvec3() - hull.a, direction.as_dvec3(), f64::from(from_m));
        if hull.is_inside(w + from * d) {
            return Some(from_m);
        }
        let balls = [(w, hull.radius), (w - hull.l, hull.radius + hull.dr)];
        let at_ends = balls.into_iter().filter_map(|(w, radius)| hit_ball(w, d, radius, from));
        let first = at_ends.chain(hull.hit_cone(w, d, from)).reduce(f64::min)?;
        first.is_finite().then_some(first as f32)
    }

    /// The place along it that is nearest to a point, 0 to 1, and the unit normal of its surface there.
    #[must_use]
    pub fn surface(&self, point: Vec3) -> (f32, Vec3) {
        let hull = self.hull();
        let w = point.as_dvec3() - hull.a;
        let h = hull.nearest(w).clamp(0.0, 1.0);
        let h = if h.is_finite() { h } else { 0.0 };
        (h as f32, (w - h * hull.l).try_normalize().unwrap_or(DVec3::Y).as_vec3())
    }

    /// Whether a ray passes within its bounding ball: quickly, for most do not.
    pub(super) fn may_be_hit(&self, origin: Vec3, direction: Vec3) -> bool {
        let [a, b] = self.ends;
        let reach_m = 0.5 * a.distance(b) + self.radii_m[0].max(self.radii_m[1]);
        let way = 0.5 * (a + b) - origin;
        way.length_squared() - way.dot(direction).powi(2) <= reach_m * reach_m * 1.001
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Inside one of many balls along it.
    fn is_within(cone: &RoundCone, point: DVec3, slack_m: f64) -> bool {
        let ([a, b], [from, to]) = (cone.ends.map(Vec3::as_dvec3), cone.radii_m.map(f64::from));
        (0..=400).any(|step| {
            let h = f64::from(step) / 400.0;
            point.distance(a.lerp(b, h)) <= from + (to - from) * h + slack_m
        })
    }

    proptest! {
        #[test]
        fn a_hit_is_where_a_walk_along_the_ray_enters(
            a in prop::array::uniform3(-2.0..2.0_f32), b in prop::array::uniform3(-2.0..2.0_f32),
            radii_m in prop::array::uniform2(0.02..1.0_f32),
            origin in prop::array::uniform3(-5.0..5.0_f32), target in prop::array::uniform3(-2.0..2.0_f32),
        ) {
            let cone = RoundCone { ends: [a.into(), b.into()], radii_m };
            let origin = Vec3::from(origin);
            let Some(direction) = (Vec3::from(target) - origin).try_normalize() else { return Ok(()) };
            let at = |t: f64| origin.as_dvec3() + t * direction.as_dvec3();
            let entered = (0..4000).map(|step| f64::from(step) * 4e-3).find(|t| is_within(&cone, at(*t), -8e-3));
            match cone.hit(origin, direction, 0.0) {
                Some(t) => {
                    let t = f64::from(t);
                    prop_assert!(is_within(&cone, at(t), 8e-3), "not on the surface at {t}");
                    prop_assert!(entered.is_none_or(|entered| t <= entered + 1e-5), "{t} after {entered:?}");
                    prop_assert!(cone.may_be_hit(origin, direction));
                }
                None => prop_assert!(entered.is_none(), "missed at {entered:?}"),
            }
        }
    }

    #[test]
    fn capsules_and_balls_are_hit_where_geometry_says() {
        let capsule = RoundCone { ends: [Vec3::ZERO, Vec3::Y * 4.0], radii_m: [0.5; 2] };
        assert_eq!(capsule.hit(Vec3::new(-3.0, 2.0, 0.0), Vec3::X, 0.0), Some(2.5));
        assert_eq!(capsule.hit(Vec3::new(0.0, 9.0, 0.0), Vec3::NEG_Y, 0.0), Some(4.5));
        assert_eq!(capsule.hit(Vec3::new(0.1, 2.0, 0.0), Vec3::X, 0.0), Some(0.0));
        assert_eq!(capsule.hit(Vec3::new(-3.0, 2.0, 0.0), Vec3::X, 2.75), Some(2.75));
        assert_eq!(capsule.hit(Vec3::new(-3.0, 2.0, 0.0), Vec3::X, 4.0), None);
        assert_eq!(capsule.surface(Vec3::new(-0.5, 1.0, 0.0)), (0.25, Vec3::NEG_X));
        let ball = RoundCone { ends: [Vec3::ZERO, Vec3::Y * 0.1], radii_m: [1.0, 0.2] };
        assert_eq!(ball.hit(Vec3::new(-3.0, 0.0, 0.0), Vec3::X, 0.0), Some(2.0));
    }

    #[test]
    fn what_is_no_number_is_not_hit_and_has_a_normal() {
        for bad in [f32::NAN, f32::INFINITY] {
            let cone = RoundCone { ends: [Vec3::splat(bad), Vec3::Y], radii_m: [1.0, bad] };
            assert_eq!(cone.hit(Vec3::new(-3.0, 0.5, 0.0), Vec3::X, 0.0), None);
            let (along, normal) = cone.surface(Vec3::ONE);
            assert!((0.0..=1.0).contains(&along) && normal.is_finite());
        }
    }
}
