//! Leaves in the wind: how far a small change turns one, and whether the GPU turns it as the CPU does.

mod continuity;
mod parity;

use crate::report::Report;
use bevy::math::{Quat, Vec3};
use bevy_windwood::dynamics::LeafResponse;
use std::f32::consts::PI;

/// Leaves that turn all the way into a full wind: the steepest answer that the settings allow.
const FULLY_TURNING: LeafResponse = LeafResponse {
    turn: 1.0,
    onset_speed_m_s: 3.2,
    full_speed_m_s: 12.0,
    flutter_angle_rad: 0.35,
    flutter_frequency_hz: 3.0,
};

pub fn run() -> Report {
    let mut report = Report::default();
    let worst = continuity::worst_turns_deg();
    let wind = "degrees that a leaf turns by at most if the wind swings by one";
    let branch = "the same if its branch, and so its axis, turns by one";
    report.at_most("turn_continuity_worst", worst.wind.max(worst.branch), 6.0, "the larger of the next two");
    report.record("turn_continuity_wind", worst.wind, wind);
    report.record("turn_continuity_branch", worst.branch, branch);
    let difference = parity::worst_difference_rad().unwrap_or_else(|error| {
        eprintln!("leaf_gpu_parity: {error}");
        f64::NAN
    });
    report.at_most("leaf_gpu_parity", difference, 1e-3, "largest rotation between GPU and CPU, rad");
    report
}

/// The angle of the rotation that leads from one to the other, rad; unlike that of the scalar product it is exact for small
/// angles too.
fn angle_between_rad(a: Quat, b: Quat) -> f64 {
    let chord = (a.as_dquat() - b.as_dquat()).length().min((a.as_dquat() + b.as_dquat()).length());
    4.0 * (0.5 * chord).min(1.0).asin()
}

/// Unit vectors all over the sphere, on a spiral that turns by the golden angle.
fn directions(count: usize) -> impl Iterator<Item = Vec3> + Clone {
    let golden_angle_rad = PI * (3.0 - 5f32.sqrt());
    (0..count).map(move |k| {
        let y = 1.0 - (2.0 * k as f32 + 1.0) / count as f32;
        let (sin, cos) = (golden_angle_rad * k as f32).sin_cos();
        let radius = (1.0 - y * y).sqrt();
        Vec3::new(radius * cos, y, radius * sin)
    })
}

/// Rotations by an angle about axes all over the sphere.
fn tilts(angle_rad: f32) -> impl Iterator<Item = Quat> + Clone {
    const AXES: usize = 14;
    directions(AXES).map(move |axis| Quat::from_axis_angle(axis, angle_rad))
}

/// Directions of a wind with all that is special for a leaf with that axis: all over the sphere, along the axis and against it,
/// and around both.
fn winds(axis: Vec3, count: usize) -> impl Iterator<Item = Vec3> + Clone {
    const OFF_RAD: [f32; 9] = [0.0, 1e-7, 1e-4, 0.003, 0.009, 0.03, 0.1, 0.3, 0.5];
    let around = OFF_RAD.into_iter().flat_map(move |off_rad| tilts(off_rad).map(move |tilt| tilt * axis));
    directions(count).chain(around.clone()).chain(around.map(|direction| -direction))
}

/// Axes of leaves: all over the sphere, along the coordinates, and where one coordinate is at 0.9.
fn axes(count: usize) -> impl Iterator<Item = Vec3> + Clone {
    let along = [Vec3::X, Vec3::Y, Vec3::Z].into_iter().flat_map(|axis| [axis, -axis]);
    let slanted = directions(count.div_ceil(4)).flat_map(|around| {
        let level = Vec3::new(around.x, 0.0, around.z).normalize_or(Vec3::X);
        [0.9, -0.9].map(|y: f32| Vec3::new(0.0, y, 0.0) + (1.0 - y * y).sqrt() * level)
    });
    directions(count).chain(along).chain(slanted)
}
