//! At which angle a falling stem comes to rest on the ground.

use std::f64::consts::FRAC_PI_2;

/// Places along the stem at which it is compared with the ground.
const PLACES: u32 = 32;
/// No ground holds a stem up that has not leaned so far, or lets it hang down farther, rad.
const LEAST_RAD: f64 = 0.2;
const GREATEST_RAD: f64 = 2.6;

/// The angle from upright, rad, at which a stem of that length and radius first touches the ground. `rise_m` tells how high the ground is
/// above the hinge at a distance from it in the direction of the fall; where it is no number there is no ground.
pub(super) fn resting_rad(length_m: f64, radius_m: f64, rise_m: impl Fn(f64) -> f64) -> f64 {
    let step_m = length_m / f64::from(PLACES);
    let elevation_rad = |place: u32| {
        let away_m = f64::from(place) * step_m;
        (rise_m(away_m) + radius_m).atan2(away_m)
    };
    // Over a cliff a stem hangs down.
    let highest_rad = (1..=PLACES).map(elevation_rad).filter(|angle| angle.is_finite()).fold(-FRAC_PI_2, f64::max);
    (FRAC_PI_2 - highest_rad).clamp(LEAST_RAD, GREATEST_RAD)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn on_a_slope_it_rests_along_the_slope() {
        for slope in [-0.5_f64, 0.0, 0.7] {
            let angle_rad = resting_rad(20.0, 0.0, |away_m| slope * away_m);
            assert_relative_eq!(angle_rad, FRAC_PI_2 - slope.atan(), epsilon = 1e-12);
        }
    }

    #[test]
    fn a_bank_holds_it_up_and_a_high_cut_lets_it_down() {
        let bank = |away_m: f64| if away_m > 9.9 { 2.0 } else { -0.3 };
        assert_relative_eq!(resting_rad(20.0, 0.0, bank), FRAC_PI_2 - 0.2_f64.atan(), epsilon = 0.005);
        // Level ground 0.3 m below the hinge, a stem of 20 m: its tip touches first.
        assert_relative_eq!(resting_rad(20.0, 0.0, |_| -0.3), FRAC_PI_2 + (0.3_f64 / 20.0).atan(), epsilon = 1e-12);
        assert_relative_eq!(resting_rad(20.0, 0.3, |_| -0.3), FRAC_PI_2, epsilon = 1e-12);
    }

    #[test]
    fn whatever_the_ground_is_it_comes_to_rest() {
        for rise_m in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e9, -1e9] {
            for length_m in [0.0, 20.0, f64::NAN] {
                let angle_rad = resting_rad(length_m, 0.1, |_| rise_m);
                assert!((LEAST_RAD..=GREATEST_RAD).contains(&angle_rad), "{rise_m} m: {angle_rad}");
            }
        }
    }
}
