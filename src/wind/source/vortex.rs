//! A Lamb-Oseen vortex: a line vortex that viscosity has spread.
//!
//! ```text
//! v = v_m (1 + 1/(2 a)) (r_m / r) (1 - exp(-a r^2 / r_m^2)),   a = 1.25643
//! r_m^2 = r_0^2 + 4 a nu t,   v_m r_m = const
//! ```
//!
//! `v_m` is the greatest speed, at `r_m` from the axis (Devenport, Rife, Liapis & Follin 1996, J. Fluid Mech. 312, 67). The air only
//! turns about the axis: so there is no divergence, nor where the vortex ends along its axis.
//!
//! Numbers: `v_m`, m/s; `r_m`, m; half its length, m.

use super::smoothstep::smoothstep;
use bevy::math::Vec3;

/// The root of `exp(a) = 1 + 2a`.
const PEAK: f32 = 1.256_431_2;

/// From this share of half its length on it ends.
const ENDS_FROM: f32 = 0.8;

/// The numbers of a vortex of which the core has grown for some time, s.
pub(super) fn numbers(speed_m_s: f32, first_core_m: f32, length_m: f32, viscosity_m2_s: f32, age_s: f32) -> [f32; 4] {
    let core_m = (first_core_m * first_core_m + 4.0 * PEAK * viscosity_m2_s * age_s.max(0.0)).sqrt();
    [speed_m_s * first_core_m / core_m, core_m, 0.5 * length_m, 0.0]
}

pub(super) fn velocity(&[speed_m_s, core_m, half_length_m, _]: &[f32; 4], axis: Vec3, from: Vec3) -> Vec3 {
    let along_m = from.dot(axis);
    let out = (from - axis * along_m) / core_m;
    let x2 = PEAK * out.length_squared();
    // (1 - exp(-x2)) / x2.
    let share = if x2 > 1e-4 { (1.0 - (-x2).exp()) / x2 } else { 1.0 - 0.5 * x2 };
    let within = 1.0 - smoothstep(ENDS_FROM, 1.0, along_m.abs() / half_length_m);
    axis.cross(out) * (speed_m_s * (PEAK + 0.5) * share * within)
}

/// The place, from the source, of its greatest speed on the side of a place.
pub(super) fn strongest_near(&[_, core_m, half_length_m, _]: &[f32; 4], axis: Vec3, from: Vec3) -> Vec3 {
    let along_m = from.dot(axis);
    let out = from - axis * along_m;
    axis * along_m.clamp(-0.5 * half_length_m, 0.5 * half_length_m) + out.clamp_length(core_m.min(out.length()), core_m)
}
