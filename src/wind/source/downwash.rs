//! The wake of a rotor over level ground.
//!
//! Momentum theory gives the speed far below the disc of radius `R` under the thrust `T`: `w = 2 sqrt(T / (2 rho pi R^2))`. A wake
//! with a normal profile of that speed and the same momentum has the width `R`: `T = rho pi R^2 w^2 / 2`. Its flow is that of
//! the stream function (`r` from the axis, `y` above ground, `x = r / R`)
//!
//! ```text
//! psi = -w R^2/2 (1 - exp(-x^2)) f(y)                 f(0) = 0
//! u_y = -w exp(-x^2) f(y)
//! u_r = w R (1 - exp(-x^2)) / (2x) f'(y)
//! ```
//!
//! so it has no divergence. Over the ground `f = 1 - exp(-y / b)`. The air that has come down runs out in a layer of that
//! thickness, and ever slower, with 1/r (in wall jets with the power -1.1: Poreh, Tsuei & Cermak 1967, J. Appl. Mech. 34, 457).
//! The pressure far below the rotor and far out on the ground is the same, so the air is as fast there (Bernoulli): of that follows
//! `b = 0.319 R`. In one radius above the disc `f` falls to 0: there air is drawn in from all sides.
//!
//! A wake is a jet: from six of its diameters on it widens, and slows down, with its momentum kept. That is taken as it is at the ground.
//! Left out: the layer of a few centimetres in which the ground holds the air, and the blades' own gusts.
//!
//! Numbers: `w`, m/s; `R`, m; height of the rotor above ground, m.

use super::smoothstep::smoothstep;
use crate::constants::AIR_DENSITY_KG_M3;
use bevy::math::{Vec3, Vec3Swizzles};
use std::f32::consts::PI;

/// Greatest value of `(1 - exp(-x^2)) / (2x)`, at x = 1.121.
const LAYER_SHARE: f32 = 0.319_1;
/// Where that is.
const STRONGEST_X: f32 = 1.121;
/// Diameters of the wake over which its core is not yet mixed (Pope 2000, section 5.1).
const CORE_DIAMETERS: f32 = 6.0;

/// The numbers of a rotor at a height above ground.
pub(super) fn numbers(rotor_radius_m: f32, thrust_n: f32, height_m: f32, strength: f32) -> [f32; 4] {
    let disc_m2 = PI * rotor_radius_m * rotor_radius_m;
    let wake_m_s = 2.0 * (thrust_n / (2.0 * AIR_DENSITY_KG_M3 as f32 * disc_m2)).sqrt();
    let height_m = height_m.max(0.1 * rotor_radius_m);
    let slowed = (CORE_DIAMETERS * 2.0 * rotor_radius_m / height_m).min(1.0);
    [strength * wake_m_s * slowed, rotor_radius_m / slowed, height_m, 0.0]
}

pub(super) fn velocity(&[wake_m_s, radius_m, height_m, _]: &[f32; 4], from: Vec3) -> Vec3 {
    let layer_m = LAYER_SHARE * radius_m;
    let out = from.xz() / radius_m;
    let x2 = out.length_squared();
    let core = (-x2).exp();
    // (1 - exp(-x^2)) / x^2.
    let share = if x2 > 1e-4 { (1.0 - core) / x2 } else { 1.0 - 0.5 * x2 };
    let y_m = from.y.max(0.0);
    let near = (-y_m / layer_m).exp();
    let t = ((y_m - height_m) / radius_m).clamp(0.0, 1.0);
    let below = 1.0 - smoothstep(0.0, 1.0, t);
    let f = (1.0 - near) * below;
    let slope = near / layer_m * below - (1.0 - near) * 6.0 * t * (1.0 - t) / radius_m;
    let radial = out * (0.5 * wake_m_s * radius_m * share * slope);
    Vec3::new(radial.x, -wake_m_s * core * f, radial.y)
}

/// The place on the ground, from the source, at which the outwash towards a place is strongest.
pub(super) fn strongest_near(&[_, radius_m, ..]: &[f32; 4], from: Vec3) -> Vec3 {
    let out = from.xz().clamp_length_max(STRONGEST_X * radius_m);
    Vec3::new(out.x, 0.0, out.y)
}
