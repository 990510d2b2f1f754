//! The ground, as all that stands on it and draws it reads it.

use bevy::math::{DVec2, Vec3};
use std::sync::Arc;

/// Ground: an elevation above every place of the plane.
///
/// A place is (x, z) in a horizontal plane, m: +x is east, +z is south. It is in double precision, so that ground stays smooth far from
/// the origin. The same place always has the same ground. It is read on any thread, in any order.
///
/// A function of the place is ground, such as `|at: DVec2| 0.1 * at.x`.
pub trait Ground: Send + Sync {
    /// Elevation at a place, m. Where it is not a finite number there is no ground, and nothing grows.
    fn height_m(&self, place: DVec2) -> f64;

    /// Rise in metres per metre along x and along z: by default from elevations nearby.
    fn gradient(&self, place: DVec2) -> DVec2 {
        DVec2::new(rise_along(self, place, DVec2::X), rise_along(self, place, DVec2::Y))
    }

    /// Unit normal, upwards.
    fn normal(&self, place: DVec2) -> Vec3 {
        let gradient = self.gradient(place).as_vec2();
        Vec3::new(-gradient.x, 1.0, -gradient.y).normalize_or(Vec3::Y)
    }

    /// Steepness: rise over run along the steepest way, 0 on the level. It is the tangent of the angle of slope.
    fn slope(&self, place: DVec2) -> f64 {
        self.gradient(place).length()
    }
}

/// What grows on the ground, seen from afar.
pub trait Cover: Send + Sync {
    /// Share of the ground about a place that is under trees, 0 to 1.
    fn share(&self, place: DVec2) -> f32;
}

/// Elevations are compared over so much to each side, m. Chosen so that a function of single precision does well: at 1 km its places
/// are 0.06 mm apart.
const STEP_M: f64 = 0.1;

/// The central difference along a unit vector. At the border of the ground it is one-sided, and beyond it 0.
fn rise_along<G: Ground + ?Sized>(ground: &G, place: DVec2, way: DVec2) -> f64 {
    let height_m = |steps: f64| ground.height_m(place + steps * STEP_M * way);
    let (before_m, behind_m) = (height_m(-1.0), height_m(1.0));
    let rise_m = match (before_m.is_finite(), behind_m.is_finite()) {
        (true, true) => 0.5 * (behind_m - before_m),
        (true, false) => height_m(0.0) - before_m,
        (false, true) => behind_m - height_m(0.0),
        (false, false) => 0.0,
    };
    if rise_m.is_finite() { rise_m / STEP_M } else { 0.0 }
}

impl<F: Fn(DVec2) -> f64 + Send + Sync> Ground for F {
    fn height_m(&self, place: DVec2) -> f64 {
        self(place)
    }
}

impl<T: Ground + ?Sized> Ground for Arc<T> {
    fn height_m(&self, place: DVec2) -> f64 {
        (**self).height_m(place)
    }

    fn gradient(&self, place: DVec2) -> DVec2 {
        (**self).gradient(place)
    }

    fn normal(&self, place: DVec2) -> Vec3 {
        (**self).normal(place)
    }

    fn slope(&self, place: DVec2) -> f64 {
        (**self).slope(place)
    }
}

/// Level ground at a height, m.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LevelGround(pub f64);

impl Ground for LevelGround {
    fn height_m(&self, _: DVec2) -> f64 {
        self.0
    }

    fn gradient(&self, _: DVec2) -> DVec2 {
        DVec2::ZERO
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use std::f64::consts::FRAC_1_SQRT_2;

    #[test]
    fn normal_and_slope_follow_from_the_gradient() {
        let ramp = |at: DVec2| at.x;
        let normal = ramp.normal(DVec2::ZERO).as_dvec3();
        assert_relative_eq!(normal.x, -FRAC_1_SQRT_2, epsilon = 1e-6);
        assert_relative_eq!(normal.y, FRAC_1_SQRT_2, epsilon = 1e-6);
        assert_relative_eq!(ramp.slope(DVec2::new(3.0, -7.0)).atan().to_degrees(), 45.0, epsilon = 1e-9);
        assert_eq!((LevelGround(4.0).slope(DVec2::ONE), LevelGround(4.0).normal(DVec2::ONE)), (0.0, Vec3::Y));
    }

    #[test]
    fn gradient_of_a_function_is_its_derivative() {
        let wave = |at: DVec2| 2.0 * (at.x / 30.0).sin() + 0.1 * at.y * at.y;
        for step in 0..50_u32 {
            let at = DVec2::new(f64::from(step) * 17.3, f64::from(step) * -4.1);
            let exact = DVec2::new(2.0 / 30.0 * (at.x / 30.0).cos(), 0.2 * at.y);
            // The rest of Taylor's series: step^2/6 times the third derivative, at most 2/30^3.
            let rest = STEP_M * STEP_M / 6.0 * 2.0 / 30.0_f64.powi(3);
            assert!((wave.gradient(at) - exact).abs().max_element() < rest + 1e-9, "{at}");
        }
    }

    #[test]
    fn gradient_is_finite_at_the_border_of_the_ground_and_beyond() {
        let pond = |at: DVec2| if at.x > 0.0 { f64::NAN } else { 0.5 * at.x + 0.25 * at.y };
        assert_relative_eq!(pond.gradient(DVec2::new(-0.01, 0.0)).x, 0.5, epsilon = 1e-9);
        assert_relative_eq!(pond.gradient(DVec2::new(-0.01, 0.0)).y, 0.25, epsilon = 1e-9);
        assert_eq!(pond.gradient(DVec2::new(5.0, 0.0)), DVec2::ZERO);
        assert_eq!((|_: DVec2| f64::INFINITY).gradient(DVec2::ZERO), DVec2::ZERO);
    }
}
