//! What all ground has: a height, a normal and a slope anywhere.

use bevy::math::{DVec2, Vec3};
use std::sync::Arc;

/// Ground: an elevation above every place of the plane.
///
/// A place is (x, z) in the world's horizontal plane, in metres, +x east and +z south; in double precision, so that
/// ground stays smooth far from the origin. A coordinate that is not finite counts as 0, one beyond 10^12 m as that.
/// Reading allocates nothing, and the same place always has the same ground, so that chunks can be filled in any order
/// on any threads.
pub trait Heightfield: Send + Sync {
    /// Elevation at a place, m.
    fn height_m(&self, place: DVec2) -> f64;

    /// Rise in metres per metre along x and along z.
    fn gradient(&self, place: DVec2) -> DVec2;

    /// Unit normal of the ground, upwards.
    fn normal(&self, place: DVec2) -> Vec3 {
        let gradient = self.gradient(place).as_vec2();
        Vec3::new(-gradient.x, 1.0, -gradient.y).normalize_or(Vec3::Y)
    }

    /// Angle between the ground and the horizontal, radians, 0 to pi/2.
    fn slope(&self, place: DVec2) -> f32 {
        self.gradient(place).length().atan() as f32
    }
}

impl<T: Heightfield + ?Sized> Heightfield for Arc<T> {
    fn height_m(&self, place: DVec2) -> f64 {
        (**self).height_m(place)
    }

    fn gradient(&self, place: DVec2) -> DVec2 {
        (**self).gradient(place)
    }
}

/// What grows on the ground, seen from afar.
pub trait Cover: Send + Sync {
    /// Share of the ground about a place that is under trees, 0 to 1.
    fn share(&self, place: DVec2) -> f32;
}

/// The sum of several grounds, such as hills formed by hand with random detail; empty, the plane at elevation 0.
#[derive(Clone, Default)]
pub struct Layers(pub Vec<Arc<dyn Heightfield>>);

impl Heightfield for Layers {
    fn height_m(&self, place: DVec2) -> f64 {
        self.0.iter().map(|layer| layer.height_m(place)).sum()
    }

    fn gradient(&self, place: DVec2) -> DVec2 {
        self.0.iter().map(|layer| layer.gradient(place)).sum()
    }
}

/// Beyond, double precision knows no tenths of a millimetre.
const FARTHEST_M: f64 = 1e12;

/// The place itself, with 0 for a coordinate that is not finite, and the farthest for one that is farther.
#[inline]
pub(super) fn finite(place: DVec2) -> DVec2 {
    let within = |value: f64| if value.is_finite() { value.clamp(-FARTHEST_M, FARTHEST_M) } else { 0.0 };
    DVec2::new(within(place.x), within(place.y))
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    /// Elevation = x * slope.
    struct Ramp(f64);

    impl Heightfield for Ramp {
        fn height_m(&self, place: DVec2) -> f64 {
            self.0 * place.x
        }

        fn gradient(&self, _place: DVec2) -> DVec2 {
            DVec2::new(self.0, 0.0)
        }
    }

    #[test]
    fn normals_and_slopes_follow_from_the_gradient() {
        let ramp = Ramp(1.0);
        let normal = ramp.normal(DVec2::ZERO);
        assert_relative_eq!(normal.x, -(0.5f32.sqrt()), epsilon = 1e-6);
        assert_relative_eq!(normal.y, 0.5f32.sqrt(), epsilon = 1e-6);
        assert_relative_eq!(ramp.slope(DVec2::ZERO).to_degrees(), 45.0, epsilon = 1e-4);
    }

    #[test]
    fn layers_add_up() {
        let layers = Layers(vec![Arc::new(Ramp(0.5)), Arc::new(Ramp(-0.2))]);
        assert_relative_eq!(layers.height_m(DVec2::new(10.0, 3.0)), 3.0, epsilon = 1e-12);
        assert_relative_eq!(layers.gradient(DVec2::ZERO).x, 0.3, epsilon = 1e-12);
        assert_eq!(Layers::default().normal(DVec2::ONE), Vec3::Y);
    }
}
