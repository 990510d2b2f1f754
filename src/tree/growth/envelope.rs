//! The envelope of a crown: a solid of revolution about the trunk that branches do not leave.
//!
//! Reeves & Blau (1985, section 3.1) bound their trees by an ellipsoid or a cone. With `r` the radius and `h` half the
//! height about the centre `c`, a point `p` is in the ellipsoid where `|(p - c) / (r, h, r)| <= 1`; it is in the cone
//! with apex `a` and slope `k = r / (top - base)` where `x^2 + z^2 <= k^2 (a_y - y)^2` between base and apex.
//! The same distance from the surface shades the crown (their section 4): see [`Envelope::depth`].

use bevy::{math::Vec3, reflect::Reflect};
use serde::{Deserialize, Serialize};

use crate::tree::species::{SpeciesError, require};

/// What bounds a crown.
#[derive(Clone, Copy, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Envelope {
    /// Its shape.
    pub shape: EnvelopeShape,
    /// Height of its lower end above the ground, m: 0 to 100, below the top.
    pub base_m: f32,
    /// Height of its upper end, which is the tree's, m: 0.5 to 120.
    pub top_m: f32,
    /// Largest horizontal radius, m: 0.1 to 60.
    pub radius_m: f32,
}

/// Shapes of crowns.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Reflect, Serialize, Deserialize)]
pub enum EnvelopeShape {
    /// A broad-leaved tree's.
    #[default]
    Ellipsoid,
    /// A conifer's, its apex on top.
    Cone,
}

impl Default for Envelope {
    /// A pedunculate oak standing free.
    fn default() -> Self {
        Self { shape: EnvelopeShape::Ellipsoid, base_m: 2.2, top_m: 16.5, radius_m: 7.8 }
    }
}

impl Envelope {
    pub(super) fn validate(&self) -> Result<(), SpeciesError> {
        require("top_m", self.top_m, 0.5..=120.0)?;
        require("radius_m", self.radius_m, 0.1..=60.0)?;
        require("base_m", self.base_m, 0.0..=0.95 * self.top_m)
    }

    /// The same envelope `scale` times as large.
    #[must_use]
    pub fn scaled(self, scale: f32) -> Self {
        Self {
            shape: self.shape,
            base_m: self.base_m * scale,
            top_m: self.top_m * scale,
            radius_m: self.radius_m * scale,
        }
    }

    /// Distance along the unit vector `direction` from `from` to where the ray leaves the envelope for good, m;
    /// 0 where it never is inside.
    #[must_use]
    pub fn exit_distance_m(&self, from: Vec3, direction: Vec3) -> f32 {
        match self.shape {
            EnvelopeShape::Ellipsoid => self.ellipsoid_exit_m(from, direction),
            EnvelopeShape::Cone => self.cone_exit_m(from, direction),
        }
    }

    fn ellipsoid_exit_m(&self, from: Vec3, direction: Vec3) -> f32 {
        let p = (from - self.centre()) / self.semi_axes();
        let d = direction / self.semi_axes();
        let (a, b, c) = (d.length_squared(), p.dot(d), p.length_squared() - 1.0);
        let discriminant = b * b - a * c;
        if discriminant < 0.0 { 0.0 } else { ((discriminant.sqrt() - b) / a).max(0.0) }
    }

    fn cone_exit_m(&self, from: Vec3, direction: Vec3) -> f32 {
        let slope2 = self.slope() * self.slope();
        let below_apex = self.top_m - from.y;
        let a = direction.x * direction.x + direction.z * direction.z - slope2 * direction.y * direction.y;
        let b = from.x * direction.x + from.z * direction.z + slope2 * below_apex * direction.y;
        let c = from.x * from.x + from.z * from.z - slope2 * below_apex * below_apex;
        if below_apex < 0.0 || c > 0.0 {
            return 0.0;
        }
        let side = smallest_positive_root(a, b, c);
        let floor = if direction.y < 0.0 { ((self.base_m - from.y) / direction.y).max(0.0) } else { f32::INFINITY };
        let exit = side.min(floor).min(2.0 * self.top_m);
        if from.y + exit * direction.y < self.base_m - 1e-3 { 0.0 } else { exit }
    }

    /// How deep a point is in the crown: 0 at the surface and outside, 1 at the middle (of an ellipsoid) or on the
    /// axis (of a cone).
    #[must_use]
    pub fn depth(&self, point: Vec3) -> f32 {
        let outwards = match self.shape {
            EnvelopeShape::Ellipsoid => ((point - self.centre()) / self.semi_axes()).length(),
            EnvelopeShape::Cone => {
                let radius = (self.slope() * (self.top_m - point.y)).max(1e-3);
                if point.y < self.base_m { 1.0 } else { point.x.hypot(point.z) / radius }
            }
        };
        (1.0 - outwards).clamp(0.0, 1.0)
    }

    /// Unit vector out of the crown, towards the light.
    #[must_use]
    pub fn outward(&self, point: Vec3) -> Vec3 {
        let gradient = match self.shape {
            EnvelopeShape::Ellipsoid => (point - self.centre()) / (self.semi_axes() * self.semi_axes()),
            EnvelopeShape::Cone => {
                let radial = Vec3::new(point.x, 0.0, point.z).normalize_or_zero();
                radial + Vec3::Y * self.slope()
            }
        };
        gradient.try_normalize().unwrap_or(Vec3::Y)
    }

    /// Horizontal radius at a height, m: 0 above the top and below the base.
    #[must_use]
    pub fn girth_m(&self, height_m: f32) -> f32 {
        match self.shape {
            EnvelopeShape::Ellipsoid => {
                let share = (height_m - self.centre().y) / self.semi_axes().y;
                self.radius_m * (1.0 - share * share).max(0.0).sqrt()
            }
            EnvelopeShape::Cone if height_m < self.base_m => 0.0,
            EnvelopeShape::Cone => (self.slope() * (self.top_m - height_m)).max(0.0),
        }
    }

    /// Middle of the crown, m.
    #[must_use]
    pub fn centre(&self) -> Vec3 {
        Vec3::Y * (0.5 * (self.base_m + self.top_m))
    }

    fn semi_axes(&self) -> Vec3 {
        Vec3::new(self.radius_m, 0.5 * (self.top_m - self.base_m), self.radius_m)
    }

    fn slope(&self) -> f32 {
        self.radius_m / (self.top_m - self.base_m)
    }
}

/// Smallest positive `t` with `a t^2 + 2 b t + c = 0`, infinity where there is none.
fn smallest_positive_root(a: f32, b: f32, c: f32) -> f32 {
    let positive = |t: f32| if t > 0.0 { t } else { f32::INFINITY };
    if a.abs() < 1e-6 {
        return if b.abs() < 1e-9 { f32::INFINITY } else { positive(-c / (2.0 * b)) };
    }
    let discriminant = b * b - a * c;
    if discriminant < 0.0 {
        return f32::INFINITY;
    }
    let root = discriminant.sqrt();
    positive((-b - root) / a).min(positive((-b + root) / a))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// Slow oracle: walks along the ray and remembers the last place inside.
    fn marched_exit_m(envelope: &Envelope, from: Vec3, direction: Vec3, step_m: f32) -> f32 {
        let inside = |point: Vec3| match envelope.shape {
            EnvelopeShape::Ellipsoid => ((point - envelope.centre()) / envelope.semi_axes()).length() <= 1.0,
            EnvelopeShape::Cone => {
                (envelope.base_m..=envelope.top_m).contains(&point.y)
                    && point.x.hypot(point.z) <= envelope.girth_m(point.y)
            }
        };
        let farthest = (4.0 * envelope.top_m.max(envelope.radius_m) / step_m) as usize;
        let last = (0..farthest).rev().find(|&step| inside(from + direction * (step as f32 * step_m)));
        last.map_or(0.0, |step| step as f32 * step_m)
    }

    fn shapes() -> impl Strategy<Value = EnvelopeShape> {
        prop_oneof![Just(EnvelopeShape::Ellipsoid), Just(EnvelopeShape::Cone)]
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(200))]

        #[test]
        fn rays_from_the_trunk_leave_where_a_walker_leaves(
            shape in shapes(),
            height in 0.0_f32..0.95,
            azimuth in 0.0_f32..std::f32::consts::TAU,
            elevation in -1.2_f32..1.2,
        ) {
            let envelope = Envelope { shape, base_m: 2.0, top_m: 14.0, radius_m: 5.0 };
            let from = Vec3::Y * (height * envelope.top_m);
            let (sin, cos) = elevation.sin_cos();
            let direction = Vec3::new(cos * azimuth.cos(), sin, cos * azimuth.sin());
            let step_m = 0.01;
            let exit_m = envelope.exit_distance_m(from, direction);
            let marched_m = marched_exit_m(&envelope, from, direction, step_m);
            // The walker is late by up to a step, and may miss a corner cut by less than a step.
            prop_assert!((exit_m - marched_m).abs() <= 3.0 * step_m, "{exit_m} against {marched_m}");
        }
    }

    #[test]
    fn depth_runs_from_the_surface_to_the_middle() {
        let envelope = Envelope::default();
        let rim = envelope.centre() + Vec3::X * envelope.radius_m;
        assert!(envelope.depth(rim) < 1e-5);
        assert_eq!(envelope.depth(envelope.centre()), 1.0);
        assert_eq!(envelope.depth(rim * 3.0), 0.0);
        let cone = Envelope { shape: EnvelopeShape::Cone, ..envelope };
        assert_eq!(cone.depth(Vec3::Y * 5.0), 1.0);
        assert!(cone.depth(Vec3::new(cone.girth_m(5.0), 5.0, 0.0)) < 1e-5);
    }

    #[test]
    fn the_way_out_is_a_unit_vector_even_at_the_middle() {
        for shape in [EnvelopeShape::Ellipsoid, EnvelopeShape::Cone] {
            let envelope = Envelope { shape, ..Envelope::default() };
            for point in [envelope.centre(), Vec3::ZERO, Vec3::new(3.0, 7.0, -2.0)] {
                assert!((envelope.outward(point).length() - 1.0).abs() < 1e-5);
            }
        }
    }
}
