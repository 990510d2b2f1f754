//! A round turbulent jet.
//!
//! The similarity solution of Schlichting (1933) with a constant eddy viscosity (Pope, *Turbulent Flows*, 2000, section 5.2):
//! at `x` along the axis from the virtual origin and `r` from the axis,
//!
//! ```text
//! u = u_0 / (1 + a e^2)^2,    v = u_0 e (1 - a e^2) / (2 (1 + a e^2)^2),    e = r/x,   a = (sqrt 2 - 1) / S^2
//! ```
//!
//! `S` is the tangent of the angle at which the speed is half of that on the axis; it is 0.094 in experiments, which the profile fits
//! up to there. `u_0` falls with 1/x. The virtual origin lies so far behind the nozzle that half the speed is at the nozzle's rim:
//! `x_0 = R / S`, for the `S` of experiments 10.6 radii, where they have 9 to 12. So the speed is that of the nozzle at first and
//! half of it five diameters ahead. There is no divergence anywhere. Behind the nozzle there is no wind.
//!
//! Numbers: speed at the nozzle, m/s; `x_0`, m; `S`.

use super::smoothstep::smoothstep;
use bevy::math::Vec3;

/// The numbers of a nozzle.
pub(super) fn numbers(speed_m_s: f32, nozzle_radius_m: f32, half_angle_deg: f32) -> [f32; 4] {
    let slope = half_angle_deg.to_radians().tan();
    [speed_m_s, nozzle_radius_m / slope, slope, 0.0]
}

pub(super) fn velocity(&[speed_m_s, origin_m, slope, _]: &[f32; 4], axis: Vec3, from: Vec3) -> Vec3 {
    let ahead_m = from.dot(axis);
    let from_origin_m = ahead_m + origin_m;
    let behind = smoothstep(-origin_m * slope, 0.0, ahead_m);
    if behind == 0.0 || from_origin_m <= 0.0 {
        return Vec3::ZERO;
    }
    let out = (from - axis * ahead_m) / from_origin_m;
    let a = (std::f32::consts::SQRT_2 - 1.0) / (slope * slope);
    let ae2 = a * out.length_squared();
    let along = behind * speed_m_s * origin_m / (from_origin_m * (1.0 + ae2) * (1.0 + ae2));
    (axis + out * (0.5 * (1.0 - ae2))) * along
}
