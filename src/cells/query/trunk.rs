//! A trunk as a ray meets it: a cone that stands upright.

use crate::cells::bounds::clamped_length;
use bevy::math::DVec3;

/// Nothing that grows is larger, m.
const LARGEST_M: f32 = 1000.0;

/// The trunk of a full-grown tree of a species. Other trees have it in proportion to their
/// [`plan_size`](crate::scatter::Planted::plan_size).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Trunk {
    /// Radius at the ground, m.
    pub radius_m: f32,
    /// Radius at the top, at most that at the ground, m.
    pub top_radius_m: f32,
    /// Height, m.
    pub height_m: f32,
}

impl Trunk {
    /// Of a tree of a size, relative to a full-grown individual. What is no length is 0, and nothing that grows is larger
    /// than a kilometre.
    pub(super) fn of_size(self, size: f32) -> Self {
        let length = |length_m: f32| clamped_length(size * length_m, LARGEST_M);
        let radius_m = length(self.radius_m);
        Self { radius_m, top_radius_m: length(self.top_radius_m).min(radius_m), height_m: length(self.height_m) }
    }

    /// How far along a ray it is hit first; 0 within. `origin` is relative to the trunk's foot, `direction` has length 1.
    pub(super) fn hit(self, origin: DVec3, direction: DVec3) -> Option<f64> {
        let [at_side, at_top] = [self.hit_side(origin, direction), self.hit_top(origin, direction)];
        at_side.into_iter().chain(at_top).reduce(f64::min)
    }

    fn taper(self) -> f64 {
        let narrows_m = f64::from(self.radius_m - self.top_radius_m);
        if self.height_m > 0.0 { -narrows_m / f64::from(self.height_m) } else { 0.0 }
    }

    /// With p + t d, the radius r at the foot and the taper k: |p + t d|² on the map = (r + k (p + t d)·up)².
    fn hit_side(self, origin: DVec3, direction: DVec3) -> Option<f64> {
        let taper = self.taper();
        let height_m = f64::from(self.height_m);
        let (radius, widening) = (f64::from(self.radius_m) + taper * origin.y, taper * direction.y);
        let square = direction.x * direction.x + direction.z * direction.z - widening * widening;
        let half = origin.x * direction.x + origin.z * direction.z - radius * widening;
        let rest = origin.x * origin.x + origin.z * origin.z - radius * radius;
        let within_height = |t: f64| (0.0..=height_m).contains(&(origin.y + t * direction.y));
        // The mirrored cone above the tip has a negative radius.
        let on_trunk = |t: &f64| *t >= 0.0 && within_height(*t) && radius + widening * t >= 0.0;
        if rest <= 0.0 && on_trunk(&0.0) {
            return Some(0.0);
        }
        let root = (half * half - square * rest).sqrt();
        if root.is_nan() {
            return None;
        }
        // Both roots without the difference of numbers that are nearly the same.
        let sum = if half < 0.0 { root - half } else { -root - half };
        [sum / square, rest / sum].into_iter().filter(on_trunk).reduce(f64::min)
    }

    fn hit_top(self, origin: DVec3, direction: DVec3) -> Option<f64> {
        let t = (f64::from(self.height_m) - origin.y) / direction.y;
        let place = origin + t * direction;
        let on_top = t >= 0.0 && place.x.hypot(place.z) <= f64::from(self.top_radius_m);
        (on_top && self.height_m > 0.0).then_some(t)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use proptest::prelude::*;

    fn is_within(trunk: Trunk, point: DVec3, slack_m: f64) -> bool {
        let [foot_m, top_m, height_m] = [trunk.radius_m, trunk.top_radius_m, trunk.height_m].map(f64::from);
        let radius_m = foot_m + (top_m - foot_m) * (point.y / height_m).clamp(0.0, 1.0);
        let from_axis_m = point.x.hypot(point.z);
        point.y >= -slack_m && point.y <= height_m + slack_m && from_axis_m <= radius_m + slack_m
    }

    proptest! {
        #[test]
        fn a_hit_is_where_a_walk_along_the_ray_enters(
            origin in prop::array::uniform3(-8.0..8.0_f64),
            target in prop::array::uniform3(-1.0..1.0_f64),
            radius_m in 0.1..2.0_f32, taper in 0.0..=1.0_f32, height_m in 0.5..8.0_f32,
        ) {
            let trunk = Trunk { radius_m, top_radius_m: radius_m * taper, height_m };
            let origin = DVec3::from(origin) + 2.0 * DVec3::Y;
            let target = DVec3::from(target) * DVec3::new(2.0, f64::from(height_m), 2.0);
            let direction = (target - origin).try_normalize();
            prop_assume!(direction.is_some() && origin.y > 0.0);
            let direction = direction.unwrap();
            let walk = |slack_m: f64| (0..8000).map(|step| f64::from(step) * 4e-3)
                .find(|t| is_within(trunk, origin + *t * direction, slack_m));
            match (trunk.hit(origin, direction), walk(-5e-3)) {
                (Some(t), entered) => {
                    prop_assert!(is_within(trunk, origin + t * direction, 1e-3), "not on the trunk");
                    prop_assert!(entered.is_none_or(|entered| t <= entered + 1e-3), "{} after {:?}", t, entered);
                }
                // Through the foot, which is in the ground.
                (None, Some(t)) => prop_assert!((origin + t * direction).y < 0.1, "missed"),
                (None, None) => {}
            }
        }
    }

    #[test]
    fn trunks_are_hit_at_the_side_and_from_above_and_from_within() {
        let trunk = Trunk { radius_m: 0.5, top_radius_m: 0.25, height_m: 10.0 };
        let hit = |x, y, direction: DVec3| trunk.hit(DVec3::new(x, y, 0.0), direction);
        assert_relative_eq!(hit(-3.0, 5.0, DVec3::X).unwrap(), 3.0 - 0.375, epsilon = 1e-9);
        assert_eq!(hit(0.1, 15.0, DVec3::NEG_Y), Some(5.0));
        assert_eq!(hit(0.1, 5.0, DVec3::Z), Some(0.0));
        assert_eq!(hit(-3.0, 10.1, DVec3::X), None);
        assert_eq!(hit(-3.0, 5.0, DVec3::NEG_X), None);
        assert_eq!(trunk.of_size(f32::NAN).hit(DVec3::new(-3.0, 5.0, 0.0), DVec3::X), None);
    }
}
