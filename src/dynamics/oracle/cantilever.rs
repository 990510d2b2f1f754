//! The modes of a cantilever, clamped at one end and free at the other, in closed form and by integrals.
//!
//! The polynomials of `dynamics::pose` and the natural frequencies of `tree::mechanics` are checked against them. In f64.
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

use std::f64::consts::PI;

/// The highest mode here. For shorter waves a beam is no longer slender.
pub(super) const HIGHEST_MODE: usize = 32;

/// A mode of a uniform cantilever.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CantileverMode {
    eta_l: f64,
    pub(super) sigma: f64,
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

    /// `cosh z - sigma sinh z` is the sum of this and the decaying part; written so, the large terms do not cancel.
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
/// What the beam carries is added by the caller: a mass `m` at `s` adds `phi(s)^2 m` to the generalised mass, and a force
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

impl TaperedBeam {
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
