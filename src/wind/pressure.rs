//! The pressure of moving air on a slender body (Setas et al., equation 15, for the velocity at each moment).
//!
//! ```text
//! u_n = u - (u . d) d             cross flow: air that moves along the body does not push it
//! F_D = 1/2 rho C_D D |u_n| u_n   drag per length, N/m
//! ```
//!
//! The paper puts the mean speed here. With the velocity at each moment gusts push by their square. The factors that do
//! not depend on the flow are part of each beam's gain (`tree::mechanics`).
//!
//! The paper's lift (equation 16) is left out: branches and leaves have no common direction in which it would act.

use bevy::math::Vec3;

/// `|u_n| u_n`, m^2/s^2: the load of air that moves at `velocity` (m/s) past a body along the unit vector `direction`,
/// without the factors that do not depend on the flow.
pub fn cross_flow_pressure(velocity: Vec3, direction: Vec3) -> Vec3 {
    let cross_flow = velocity.reject_from_normalized(direction);
    cross_flow.length() * cross_flow
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flow_along_the_body_does_not_push() {
        assert_eq!(cross_flow_pressure(9.0 * Vec3::Y, Vec3::Y), Vec3::ZERO);
    }

    #[test]
    fn pressure_on_an_upright_body_is_the_horizontal_speed_times_the_horizontal_velocity() {
        let velocity = Vec3::new(6.0, 1.0, -2.0);
        let horizontal = Vec3::new(6.0, 0.0, -2.0);
        // A few roundings of numbers of about 40.
        assert!(cross_flow_pressure(velocity, Vec3::Y).abs_diff_eq(horizontal * 40f32.sqrt(), 2e-5));
    }
}
