//! The modes of a cantilever: how a branch, clamped at one end and free at the other, may vibrate.
//!
//! With `s` from 0 (root) to 1 (tip) and `l_n = eta_n L` the n-th root of `cos l cosh l + 1 = 0`, the shape (18), (19)
//! scaled to 1 at the tip is
//!
//! ```text
//! phi_n(s) = (-1)^(n+1)/2 [ cosh(l s) - cos(l s) - sigma (sinh(l s) - sin(l s)) ],
//! sigma    = (sinh l - sin l) / (cosh l + cos l) = -1 / D_n
//! ```
//!
//! and the natural frequency (20), the generalised load (22) and the generalised mass (23) and stiffness are
//!
//! ```text
//! w_n = l_n^2 / L^2 sqrt(E I / (rho A)),           I = pi R^4 / 4 (the paper prints pi R^4)
//! P_n = int phi p dx,   M_n = int phi^2 rho A dx,   K_n = int E I (d^2 phi / dx^2)^2 dx,   w_n^2 = K_n / M_n
//! ```
//!
//! For a uniform beam `M_n = rho A L / 4`, and a uniform load gives `P_1 = 0.3915 p L`. For a tapered one the uniform
//! beam's shape serves as Rayleigh's assumed mode: its frequency is then an upper bound.
//!
//! All here is in f64, for use at bake time.

use std::f64::consts::PI;

/// Modes above this are not offered: beams that short-waved are no longer slender.
const HIGHEST_MODE: usize = 32;

/// A mode of a uniform cantilever.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CantileverMode {
    eta_l: f64,
    sigma: f64,
    /// `1 - sigma`, computed without cancellation: it falls as `e^-l`.
    sigma_defect: f64,
    /// Half of 1 or -1: scales the tip to 1.
    scale: f64,
}

impl CantileverMode {
    /// The `n`-th mode, from 1 (the fundamental). 0 counts as 1, and numbers above 32 as 32.
    pub fn nth(n: usize) -> Self {
        let n = n.clamp(1, HIGHEST_MODE);
        let l = characteristic_root(n);
        let denominator = l.cosh() + l.cos();
        Self {
            eta_l: l,
            sigma: (l.sinh() - l.sin()) / denominator,
            sigma_defect: ((-l).exp() + l.cos() + l.sin()) / denominator,
            scale: if n % 2 == 1 { 0.5 } else { -0.5 },
        }
    }

    /// `eta_n L`, the root of `cos l cosh l + 1 = 0`.
    pub fn eta_l(&self) -> f64 {
        self.eta_l
    }

    /// Deflection at `s`, 1 at the tip.
    pub fn shape(&self, s: f64) -> f64 {
        let z = self.eta_l * s;
        self.scale * (self.growing(z) + self.decaying(z) - z.cos() + self.sigma * z.sin())
    }

    /// First derivative of the shape by `s`.
    pub fn slope(&self, s: f64) -> f64 {
        let z = self.eta_l * s;
        self.scale * self.eta_l * (self.growing(z) - self.decaying(z) + z.sin() + self.sigma * z.cos())
    }

    /// Second derivative of the shape by `s`.
    pub fn curvature(&self, s: f64) -> f64 {
        let z = self.eta_l * s;
        self.scale * self.eta_l.powi(2) * (self.growing(z) + self.decaying(z) + z.cos() - self.sigma * z.sin())
    }

    /// `cosh z - sigma sinh z` is the sum of this and the decaying part; written so, the great terms do not cancel.
    fn growing(&self, z: f64) -> f64 {
        0.5 * self.sigma_defect * z.exp()
    }

    fn decaying(&self, z: f64) -> f64 {
        0.5 * (1.0 + self.sigma) * (-z).exp()
    }
}

/// The n-th root of `cos l + 1 / cosh l = 0`, by Newton's method from `(n - 1/2) pi`.
fn characteristic_root(n: usize) -> f64 {
    let mut l = if n == 1 { 1.875 } else { (n as f64 - 0.5) * PI };
    for _ in 0..8 {
        let value = l.cos() + l.cosh().recip();
        let derivative = -l.sin() - l.tanh() / l.cosh();
        l -= value / derivative;
    }
    l
}

/// Natural angular frequency in rad/s of a uniform beam (eq. 20): Young's modulus in Pa, second moment of the section in
/// m^4 ([`disc_second_moment_m4`] for a round one), density in kg/m^3, section in m^2, length in m.
pub fn natural_omega_rad_s(
    mode: &CantileverMode,
    young_modulus_pa: f64,
    second_moment_m4: f64,
    density_kg_m3: f64,
    area_m2: f64,
    length_m: f64,
) -> f64 {
    let wave_number = mode.eta_l / length_m;
    wave_number * wave_number * (young_modulus_pa * second_moment_m4 / (density_kg_m3 * area_m2)).sqrt()
}

/// Second moment of area of a solid round section, `pi R^4 / 4`, in m^4.
pub fn disc_second_moment_m4(radius_m: f64) -> f64 {
    0.25 * PI * radius_m.powi(4)
}

/// A round beam whose radius changes linearly from root to tip.
///
/// What rides on the beam is added by the caller: a mass `m` at `s` adds `phi(s)^2 m` to the generalised mass, and a force
/// `f` at `s` adds `phi(s) f` to the generalised load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TaperedBeam {
    /// Length in metres.
    pub length_m: f64,
    /// Radius at the root, in metres.
    pub base_radius_m: f64,
    /// Radius at the tip, in metres.
    pub tip_radius_m: f64,
    /// Young's modulus in Pa; green wood has some 5e9 to 12e9.
    pub young_modulus_pa: f64,
    /// Density in kg/m^3; green wood has some 600 to 1100.
    pub density_kg_m3: f64,
}

/// Why a beam cannot be used.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("{field} is {value}, but must be {allowed}")]
pub struct InvalidBeam {
    /// The field's name.
    pub field: &'static str,
    /// Its value.
    pub value: f64,
    /// What is allowed.
    pub allowed: &'static str,
}

impl TaperedBeam {
    /// This beam, if its length, radius at the root, modulus and density are positive and its tip's radius is not negative.
    pub fn validate(self) -> Result<Self, InvalidBeam> {
        let positive = [
            ("length_m", self.length_m),
            ("base_radius_m", self.base_radius_m),
            ("young_modulus_pa", self.young_modulus_pa),
            ("density_kg_m3", self.density_kg_m3),
        ];
        for (field, value) in positive {
            if !(value > 0.0 && value.is_finite()) {
                return Err(InvalidBeam { field, value, allowed: "positive and finite" });
            }
        }
        let value = self.tip_radius_m;
        if value >= 0.0 && value.is_finite() {
            Ok(self)
        } else {
            Err(InvalidBeam { field: "tip_radius_m", value, allowed: "at least 0 and finite" })
        }
    }

    /// Radius at `s`, in metres.
    pub fn radius_m(&self, s: f64) -> f64 {
        self.base_radius_m + (self.tip_radius_m - self.base_radius_m) * s
    }

    /// `M_n` in kg (eq. 23), without what the beam carries.
    pub fn generalised_mass(&self, mode: &CantileverMode) -> f64 {
        let mass_per_length = |s: f64| self.density_kg_m3 * PI * self.radius_m(s).powi(2);
        self.length_m * integrate(|s| mode.shape(s).powi(2) * mass_per_length(s))
    }

    /// `K_n` in N/m: the force at the tip that bends the beam by a metre in this shape.
    pub fn generalised_stiffness(&self, mode: &CantileverMode) -> f64 {
        let rigidity = |s: f64| self.young_modulus_pa * disc_second_moment_m4(self.radius_m(s));
        integrate(|s| rigidity(s) * mode.curvature(s).powi(2)) / self.length_m.powi(3)
    }

    /// `P_n` in N (eq. 22), for a load in N/m as a function of `s`.
    pub fn generalised_load(&self, mode: &CantileverMode, load_n_m: impl Fn(f64) -> f64) -> f64 {
        self.length_m * integrate(|s| mode.shape(s) * load_n_m(s))
    }

    /// `sqrt(K_n / M_n)` in rad/s, with a generalised mass in kg of what the beam carries (`sum phi(s)^2 m`).
    pub fn natural_omega_rad_s(&self, mode: &CantileverMode, carried_mass_kg: f64) -> f64 {
        (self.generalised_stiffness(mode) / (self.generalised_mass(mode) + carried_mass_kg)).sqrt()
    }
}

/// Integral over 0..1 by Gauss and Legendre's rule of five points (exact to the 9th degree) in sixteen panels.
fn integrate(integrand: impl Fn(f64) -> f64) -> f64 {
    // Abramowitz & Stegun, table 25.4.
    const NODES: [(f64, f64); 5] = [
        (-0.906_179_845_938_664, 0.236_926_885_056_189_1),
        (-0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
        (0.0, 0.568_888_888_888_888_9),
        (0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
        (0.906_179_845_938_664, 0.236_926_885_056_189_1),
    ];
    const PANELS: usize = 16;
    let half_panel = 0.5 / PANELS as f64;
    let panel = |index: usize| {
        let middle = (2 * index + 1) as f64 * half_panel;
        NODES.iter().map(|&(node, weight)| weight * integrand(middle + half_panel * node)).sum::<f64>()
    };
    half_panel * (0..PANELS).map(panel).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    const UNIFORM: TaperedBeam = TaperedBeam {
        length_m: 1.5,
        base_radius_m: 0.015,
        tip_radius_m: 0.015,
        young_modulus_pa: 8e9,
        density_kg_m3: 800.0,
    };

    fn modes() -> [CantileverMode; 4] {
        [1, 2, 3, 4].map(CantileverMode::nth)
    }

    #[test]
    fn roots_are_those_of_the_characteristic_equation() {
        let published = [1.875_104_069, 4.694_091_133, 7.854_757_438, 10.995_540_735];
        for (mode, root) in modes().iter().zip(published) {
            // The published digits end at the ninth decimal.
            assert!((mode.eta_l() - root).abs() < 1e-9, "{} is not {root}", mode.eta_l());
        }
    }

    #[test]
    fn shapes_are_the_papers() {
        for mode in modes() {
            let l = mode.eta_l();
            let d = (l.cos() + l.cosh()) / (l.sin() - l.sinh());
            let printed = |s: f64| (l * s).sin() - (l * s).sinh() + d * ((l * s).cos() - (l * s).cosh());
            for s in [0.1, 0.35, 0.6, 0.9, 1.0] {
                // Rounding, times the e^l that cancels in the printed form.
                assert!((mode.shape(s) - printed(s) / printed(1.0)).abs() < 1e-10);
            }
        }
        let first = CantileverMode::nth(1);
        // Nine decimals are published.
        assert!((-1.0 / first.sigma + 1.362_220_557).abs() < 1e-9);
    }

    #[test]
    fn root_is_clamped_and_tip_is_free() {
        for mode in (1..=HIGHEST_MODE).map(CantileverMode::nth) {
            let size = mode.eta_l().powi(2);
            assert!(mode.shape(0.0).abs() < 1e-14 && mode.slope(0.0).abs() < 1e-14 * size);
            // The curvature's terms are of the size of eta^2.
            assert!((mode.shape(1.0) - 1.0).abs() < 1e-12 && mode.curvature(1.0).abs() < 1e-11 * size);
        }
    }

    #[test]
    fn slope_and_curvature_are_the_derivatives() {
        let step = 1e-5;
        for mode in modes() {
            for s in [0.2, 0.5, 0.8] {
                let slope = (mode.shape(s + step) - mode.shape(s - step)) / (2.0 * step);
                let curvature = (mode.slope(s + step) - mode.slope(s - step)) / (2.0 * step);
                // Central differences are off by step^2 l^3 / 6, below 3e-8 relative.
                assert_relative_eq!(mode.slope(s), slope, max_relative = 1e-6, epsilon = 1e-6);
                assert_relative_eq!(mode.curvature(s), curvature, max_relative = 1e-6, epsilon = 1e-6);
            }
        }
    }

    #[test]
    fn uniform_beam_has_the_closed_forms() {
        let mass = 800.0 * PI * 0.015f64.powi(2) * 1.5;
        let load_shares = [0.391_496, -0.216_968, 0.127_213, -0.090_949];
        for (mode, share) in modes().iter().zip(load_shares) {
            assert_relative_eq!(UNIFORM.generalised_mass(mode), mass / 4.0, max_relative = 1e-9);
            // Six decimals are published.
            assert!((UNIFORM.generalised_load(mode, |_| 1.0) / 1.5 - share).abs() < 6e-7);
            let closed =
                natural_omega_rad_s(mode, 8e9, disc_second_moment_m4(0.015), 800.0, PI * 0.015f64.powi(2), 1.5);
            assert_relative_eq!(UNIFORM.natural_omega_rad_s(mode, 0.0), closed, max_relative = 1e-9);
        }
    }

    #[test]
    fn branch_of_a_metre_and_a_half_sways_at_six_hertz() {
        let frequency_hz = UNIFORM.natural_omega_rad_s(&CantileverMode::nth(1), 0.0) / (2.0 * PI);
        // 5.9 Hz to two digits, for wood of 800 kg/m^3.
        assert!((frequency_hz - 5.9).abs() < 0.05, "{frequency_hz} Hz");
    }

    #[test]
    fn taper_raises_the_fundamental_and_carried_mass_lowers_it() {
        let mode = CantileverMode::nth(1);
        let cone = TaperedBeam { tip_radius_m: 0.005, ..UNIFORM };
        assert!(cone.natural_omega_rad_s(&mode, 0.0) > UNIFORM.natural_omega_rad_s(&mode, 0.0));
        // Four times the mass halves the frequency.
        let mass = UNIFORM.generalised_mass(&mode);
        let loaded = UNIFORM.natural_omega_rad_s(&mode, 3.0 * mass);
        assert_relative_eq!(loaded, UNIFORM.natural_omega_rad_s(&mode, 0.0) / 2.0, max_relative = 1e-12);
    }

    #[test]
    fn bad_beams_are_named() {
        assert_eq!(UNIFORM.validate(), Ok(UNIFORM));
        let error = TaperedBeam { length_m: -1.0, ..UNIFORM }.validate().unwrap_err();
        assert_eq!(error.to_string(), "length_m is -1, but must be positive and finite");
        assert!(TaperedBeam { tip_radius_m: f64::NAN, ..UNIFORM }.validate().is_err());
    }
}
