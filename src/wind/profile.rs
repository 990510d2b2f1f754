//! The mean wind over height: the logarithmic law (Setas et al., equation 10, with a displacement height).
//!
//! ```text
//! U(z) = (u* / kappa) ln((z - d) / z0)        for z - d > z0, else 0
//! ```
//!
//! u* = friction velocity [m/s], kappa = 0.4, z0 = roughness length [m] (0.01 low grass to 1 pine forest, after the
//! paper), d = displacement height [m]: the effective ground of the flow above a dense canopy.

use crate::constants::REFERENCE_HEIGHT_M;
use std::f32::consts::E;

/// The von Karman constant of the logarithmic law (Setas et al., equation 10).
pub(crate) const VON_KARMAN: f32 = 0.4;

/// Far above the atmosphere. The law does not hold there, but stays finite.
const GREATEST_HEIGHT_M: f32 = 1e6;

/// Turbulence keeps the scales of this many roughness lengths above the displacement plane where a point is lower:
/// the law says U = u*/kappa there, and its scales mean nothing closer to the obstacles.
const LOWEST_ROUGHNESS_LENGTHS: f32 = E;

/// Mean wind speed as a function of height above ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LogProfile {
    /// u*, m/s. Its square is the shear stress at the ground over the density of air.
    pub friction_velocity_m_s: f32,
    /// z0, m.
    pub roughness_m: f32,
    /// d, m.
    pub displacement_m: f32,
}

impl LogProfile {
    /// The profile that has `speed_m_s` at [`REFERENCE_HEIGHT_M`].
    ///
    /// That height must lie at least e roughness lengths above the displacement plane, as validated
    /// [`FieldSettings`](super::FieldSettings) guarantee; nearer than that the friction velocity is held at 0.4 times
    /// the speed, so that it stays finite.
    pub fn from_reference(speed_m_s: f32, roughness_m: f32, displacement_m: f32) -> Self {
        let roughness_lengths = (REFERENCE_HEIGHT_M - displacement_m) / roughness_m;
        let friction_velocity_m_s = VON_KARMAN * speed_m_s / roughness_lengths.max(LOWEST_ROUGHNESS_LENGTHS).ln();
        Self { friction_velocity_m_s, roughness_m, displacement_m }
    }

    /// U(z), m/s, at any height above ground; 0 at and below d + z0.
    pub fn speed_at(&self, height_m: f32) -> f32 {
        let height_m = height_m - self.displacement_m;
        if height_m > self.roughness_m { self.speed_above_displacement(height_m.min(GREATEST_HEIGHT_M)) } else { 0.0 }
    }

    /// The height above the displacement plane, m, that sets the scales of the turbulence at `height_m` above ground,
    /// and the mean speed there, m/s. In and below the roughness layer: those of e z0, so that both stay positive.
    pub(super) fn turbulence_scales(&self, height_m: f32) -> (f32, f32) {
        let lowest_m = LOWEST_ROUGHNESS_LENGTHS * self.roughness_m;
        let height_m = (height_m - self.displacement_m).max(lowest_m);
        (height_m, self.speed_above_displacement(height_m))
    }

    fn speed_above_displacement(&self, height_m: f32) -> f32 {
        self.friction_velocity_m_s / VON_KARMAN * (height_m / self.roughness_m).ln()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn reference_speed_comes_back_at_ten_metres() {
        for (roughness, displacement) in [(0.01, 0.0), (0.1, 0.0), (1.0, 4.0)] {
            let profile = LogProfile::from_reference(8.0, roughness, displacement);
            // One logarithm, one division and one product of f32.
            assert_relative_eq!(profile.speed_at(10.0), 8.0, max_relative = 1e-6);
        }
    }

    #[test]
    fn speed_gains_the_same_for_each_doubling_of_height() {
        let profile = LogProfile::from_reference(8.0, 0.1, 0.0);
        let gain = profile.friction_velocity_m_s / 0.4 * 2f32.ln();
        for height in [1.0, 5.0, 20.0, 80.0] {
            assert_relative_eq!(profile.speed_at(2.0 * height) - profile.speed_at(height), gain, max_relative = 1e-5);
        }
    }

    #[test]
    fn speed_is_zero_at_and_below_the_roughness_and_never_infinite() {
        let profile = LogProfile::from_reference(8.0, 0.5, 2.0);
        for height in [f32::NEG_INFINITY, -3.0, 0.0, 2.0, 2.5, f32::NAN] {
            assert_eq!(profile.speed_at(height), 0.0);
        }
        assert!(profile.speed_at(2.51) > 0.0);
        assert!(profile.speed_at(f32::INFINITY).is_finite());
    }

    #[test]
    fn friction_velocity_is_finite_when_the_reference_height_is_inside_the_canopy() {
        let profile = LogProfile::from_reference(8.0, 1.0, 12.0);
        assert_relative_eq!(profile.friction_velocity_m_s, 3.2, max_relative = 1e-6);
    }
}
