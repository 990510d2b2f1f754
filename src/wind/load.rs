//! What the wind does to a slender body (Setas et al., equations 15 and 16, per unit length and for moving air).
//!
//! ```text
//! u_n = u - (u . d) d                       cross flow: what blows along the body does not push it
//! F_D = 1/2 rho C_D D |u_n| u_n             drag, N/m
//! F_L = 1/2 rho C_L D |u_n| (d x u_n)       lift, N/m, normal to the cross flow and to the body
//! ```
//!
//! The paper puts the mean speed here; the instantaneous velocity lets gusts push by their square.

use bevy::math::Vec3;

/// Density of dry air at sea level and 15 C, kg/m^3 (International Standard Atmosphere, ISO 2533:1975).
pub const AIR_DENSITY_KG_M3: f32 = 1.225;

/// `|u_n| u_n`, m^2/s^2: the load of air moving at `velocity` (m/s) past a body along the unit vector `direction`,
/// without the factors that do not depend on the flow.
pub fn cross_flow_pressure(velocity: Vec3, direction: Vec3) -> Vec3 {
    let cross_flow = velocity.reject_from_normalized(direction);
    cross_flow.length() * cross_flow
}

/// Drag per length of the body, N/m (equation 15).
///
/// `direction` is the body's unit vector, `diameter_m` its width, `drag_coefficient` about 1.2 for a long cylinder.
pub fn drag_per_length(
    air_density_kg_m3: f32,
    drag_coefficient: f32,
    diameter_m: f32,
    velocity: Vec3,
    direction: Vec3,
) -> Vec3 {
    0.5 * air_density_kg_m3 * drag_coefficient * diameter_m * cross_flow_pressure(velocity, direction)
}

/// Lift per length of the body, N/m (equation 16), towards direction x velocity for a positive coefficient.
pub fn lift_per_length(
    air_density_kg_m3: f32,
    lift_coefficient: f32,
    diameter_m: f32,
    velocity: Vec3,
    direction: Vec3,
) -> Vec3 {
    direction.cross(drag_per_length(air_density_kg_m3, lift_coefficient, diameter_m, velocity, direction))
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    const VELOCITY: Vec3 = Vec3::new(6.0, 1.0, -2.0);

    #[test]
    fn flow_along_the_body_does_not_push() {
        assert_eq!(cross_flow_pressure(9.0 * Vec3::Y, Vec3::Y), Vec3::ZERO);
        assert_eq!(lift_per_length(1.2, 1.0, 0.1, Vec3::ZERO, Vec3::Y), Vec3::ZERO);
    }

    #[test]
    fn pressure_on_an_upright_body_is_the_horizontal_speed_times_the_horizontal_velocity() {
        let horizontal = Vec3::new(6.0, 0.0, -2.0);
        // A few roundings of numbers of about 40.
        assert!(cross_flow_pressure(VELOCITY, Vec3::Y).abs_diff_eq(horizontal * 40f32.sqrt(), 2e-5));
    }

    #[test]
    fn drag_of_a_cylinder_is_the_dynamic_pressure_times_width_and_coefficient() {
        let drag = drag_per_length(AIR_DENSITY_KG_M3, 1.2, 0.05, 10.0 * Vec3::X, Vec3::Y);
        // A few roundings of numbers of about 4.
        assert!(drag.abs_diff_eq(Vec3::X * (0.5 * 1.225 * 100.0 * 0.05 * 1.2), 2e-6));
    }

    #[test]
    fn lift_is_normal_to_body_and_flow_and_as_large_as_drag_of_the_same_coefficient() {
        let direction = Vec3::new(1.0, 2.0, 0.5).normalize();
        let drag = drag_per_length(1.2, 0.8, 0.1, VELOCITY, direction);
        let lift = lift_per_length(1.2, 0.8, 0.1, VELOCITY, direction);
        // Products of f32 numbers of the order of 1.
        assert!(lift.dot(direction).abs() < 1e-6 && lift.dot(drag).abs() < 1e-5);
        assert_relative_eq!(lift.length(), drag.length(), max_relative = 1e-5);
    }
}
