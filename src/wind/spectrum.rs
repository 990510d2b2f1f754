//! Spectra of the turbulence (Setas et al., equations 9) and how points share it (equations 11 and 12), corrected.
//!
//! ```text
//! S_u = u*^2 200  (nu/f) / (1 + 50 nu)^(5/3)          nu = f z / U(z)
//! S_v = u*^2 15   (nu/f) / (1 + 9.5 nu)^(5/3)
//! S_w = u*^2 3.36 (nu/f) / (1 + 10 nu^(5/3))          (the paper misplaces this exponent)
//!
//! S_12 = sqrt(S(z1) S(z2)) exp(-f^)                   exp(-f^) = root coherence, for u, v and w alike
//! f^   = f sqrt(Cz^2 dz^2 + Cy^2 dy^2) / ((U(z1) + U(z2)) / 2)
//! ```
//!
//! S is one-sided: its integral over f from 0 up is the variance. u*^2 is tau0/rho, not the variance of u: the
//! variances are 6.0000, 2.3684 and 1.6728 u*^2.
//!
//! Left out: the cross-spectrum of u and w. The components are independent here, while in a boundary layer `<u w> = -u*^2`, a
//! correlation of -0.32 at these variances.

use bevy::reflect::Reflect;
use std::f64::consts::PI;

/// A component of the turbulent velocity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum TurbulenceComponent {
    /// The paper's u, along the mean wind.
    Along,
    /// The paper's v, horizontal and across the mean wind.
    Across,
    /// The paper's w, vertical.
    Up,
}

impl TurbulenceComponent {
    /// All three, in the paper's order u, v, w.
    pub const ALL: [Self; 3] = [Self::Along, Self::Across, Self::Up];

    /// One-sided power spectral density S(f), m^2/s^2 per Hz (equations 9).
    ///
    /// `frequency_hz` > 0, `height_m` > 0 above the displacement plane, `mean_speed_m_s` > 0 at that height.
    pub fn power_spectral_density(
        self,
        frequency_hz: f64,
        height_m: f64,
        mean_speed_m_s: f64,
        friction_velocity_m_s: f64,
    ) -> f64 {
        let eddy_time_s = height_m / mean_speed_m_s;
        let nu = frequency_hz * eddy_time_s;
        let shape = match self {
            Self::Along => 200.0 / (1.0 + 50.0 * nu).powf(5.0 / 3.0),
            Self::Across => 15.0 / (1.0 + 9.5 * nu).powf(5.0 / 3.0),
            Self::Up => 3.36 / (1.0 + 10.0 * nu.powf(5.0 / 3.0)),
        };
        friction_velocity_m_s.powi(2) * eddy_time_s * shape
    }

    /// The variance over the friction velocity squared: the integral of S / u*^2 over all frequencies, in closed form.
    pub fn variance_factor(self) -> f64 {
        match self {
            // int A / (1 + B x)^(5/3) dx = 3 A / (2 B)
            Self::Along => 1.5 * 200.0 / 50.0,
            Self::Across => 1.5 * 15.0 / 9.5,
            // int A / (1 + B x^(5/3)) dx = A B^(-3/5) (3 pi/5) / sin(3 pi/5)
            Self::Up => 3.36 * 10f64.powf(-0.6) * (0.6 * PI) / (0.6 * PI).sin(),
        }
    }

    /// Index of the component in wind coordinates (along, up, across).
    pub(super) fn axis(self) -> usize {
        match self {
            Self::Along => 0,
            Self::Up => 1,
            Self::Across => 2,
        }
    }
}

/// How fast one component loses its coherence with distance: Cy and Cz of equation 12.
#[derive(Clone, Copy, Debug, PartialEq, Reflect)]
pub struct DecayCoefficients {
    /// Cy, for a distance across the wind. domain: \[0, 100\], usually 2 to 10.
    pub lateral: f32,
    /// Cz, for a distance in height. domain: \[0, 100\], usually 2 to 10.
    pub vertical: f32,
}

impl DecayCoefficients {
    /// exp(-f^), the correlation of the parts with frequency f of two points' velocities (equation 12).
    ///
    /// `mean_speed_m_s` > 0 is the mean of the mean speeds at the two points.
    #[cfg(any(test, feature = "editor"))]
    pub(super) fn root_coherence(self, frequency_hz: f64, lateral_m: f64, vertical_m: f64, mean_speed_m_s: f64) -> f64 {
        (-frequency_hz * self.decay_time_s(lateral_m, vertical_m, mean_speed_m_s)).exp()
    }

    /// f^ / f, s.
    pub(super) fn decay_time_s(self, lateral_m: f64, vertical_m: f64, mean_speed_m_s: f64) -> f64 {
        (f64::from(self.lateral) * lateral_m).hypot(f64::from(self.vertical) * vertical_m) / mean_speed_m_s
    }
}

impl Default for DecayCoefficients {
    fn default() -> Self {
        CoherenceDecay::default().along
    }
}

/// The decay coefficients of the three components.
#[derive(Clone, Copy, Debug, PartialEq, Reflect)]
pub struct CoherenceDecay {
    /// For u. Default: 10 and 10, the upper end of the paper's range.
    pub along: DecayCoefficients,
    /// For v. Default: 7 and 7, inside the paper's range of 2 to 10 (a choice: the paper gives none for v alone).
    pub across: DecayCoefficients,
    /// For w. Default: 8 and 8; equation 12c gives 8 laterally and nothing vertically.
    pub up: DecayCoefficients,
}

impl CoherenceDecay {
    /// The coefficients of one component.
    pub(super) fn of(&self, component: TurbulenceComponent) -> DecayCoefficients {
        match component {
            TurbulenceComponent::Along => self.along,
            TurbulenceComponent::Across => self.across,
            TurbulenceComponent::Up => self.up,
        }
    }
}

impl Default for CoherenceDecay {
    fn default() -> Self {
        let isotropic = |decay| DecayCoefficients { lateral: decay, vertical: decay };
        Self { along: isotropic(10.0), across: isotropic(7.0), up: isotropic(8.0) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    /// The integral of S over all frequencies by the trapezoidal rule in ln f.
    fn integrated_variance(component: TurbulenceComponent) -> f64 {
        let steps_per_e = 64;
        let range = -30 * steps_per_e..=60 * steps_per_e;
        let step = 1.0 / f64::from(steps_per_e);
        range
            .map(|index| (f64::from(index) * step).exp())
            .map(|frequency_hz| frequency_hz * component.power_spectral_density(frequency_hz, 12.0, 7.0, 1.0) * step)
            .sum()
    }

    #[test]
    fn spectra_integrate_to_the_known_variances() {
        for (component, variance) in TurbulenceComponent::ALL.into_iter().zip([6.0000, 2.3684, 1.6728]) {
            // The published figures have four decimals.
            assert_relative_eq!(integrated_variance(component), variance, epsilon = 1e-4);
            // Trapezoids on an analytic integrand that decays at both ends: as good as exact.
            assert_relative_eq!(integrated_variance(component), component.variance_factor(), max_relative = 1e-9);
        }
    }

    #[test]
    fn inertial_range_falls_by_the_five_thirds_law() {
        for (component, limit) in TurbulenceComponent::ALL.into_iter().zip([0.295, 0.352, 0.336]) {
            let nu: f64 = 1e6;
            let (height_m, speed_m_s, friction_m_s) = (5.0, 4.0, 0.7);
            let frequency_hz = nu * speed_m_s / height_m;
            let density = component.power_spectral_density(frequency_hz, height_m, speed_m_s, friction_m_s);
            let reduced = frequency_hz * density / (friction_m_s * friction_m_s) * nu.powf(2.0 / 3.0);
            // The published limits have three decimals.
            assert_relative_eq!(reduced, limit, epsilon = 5e-4);
        }
    }

    #[test]
    fn root_coherence_is_one_at_a_point_and_decays_with_frequency_and_distance() {
        let decay = DecayCoefficients { lateral: 8.0, vertical: 6.0 };
        assert_eq!(decay.root_coherence(2.0, 0.0, 0.0, 8.0), 1.0);
        // f^ = 0.1 sqrt((6 * 4)^2 + (8 * 4)^2) / 8 = 0.1 * 40 / 8
        assert_relative_eq!(decay.root_coherence(0.1, 4.0, 4.0, 8.0), (-0.5f64).exp(), max_relative = 1e-12);
    }
}
