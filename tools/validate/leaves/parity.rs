//! Leaves turned by the shader module that draws them, in a compute shader, against the same in Rust.

use super::{FULLY_TURNING, angle_between_rad, axes, directions, winds};
use crate::support::{
    self,
    probe::{self, ProbeSource},
};
use bevy::prelude::*;
use bevy_windwood::{
    dynamics::{LeafResponse, RestingLeaf},
    sway::FLUTTER_PERIOD_S,
};
use std::time::Duration;

const TURN_SHADER: &str = "
import bevy_windwood::render::shaders::leaf::leaf_rotation;
@group(0) @binding(0) var<storage, read> samples: array<vec4<f32>>;
@group(0) @binding(1) var<storage, read_write> rotations: array<vec4<f32>>;
// A sample is three rows: axis at rest and phase; rotation of the branch; wind and time.
@compute @workgroup_size(64)
fn turn_leaves(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&rotations) {
        return;
    }
    let leaf = samples[3u * id.x];
    let wind = samples[3u * id.x + 2u];
    rotations[id.x] = leaf_rotation(leaf.xyz, leaf.w, samples[3u * id.x + 1u], wind.xyz, wind.w);
}
";
/// Speeds of the wind, m/s.
const SPEEDS_M_S: [f32; 7] = [0.0, 1.0, 3.0, 5.5, 9.0, 15.0, 50.0];
const AXES: usize = 40;
const WINDS: usize = 60;

/// A leaf in the wind.
struct Sample {
    leaf: RestingLeaf,
    carried: Quat,
    wind: Vec3,
    time_s: f32,
}

/// The largest rotation between what the two compute, rad.
pub fn worst_difference_rad() -> Result<f64, String> {
    let samples = samples();
    let there = on_gpu(&samples)?;
    let differences = samples.iter().zip(there).map(|(sample, there)| {
        let Sample { leaf, carried, wind, time_s } = sample;
        let here = FULLY_TURNING.rotation(leaf, *carried, *wind, *time_s, FLUTTER_PERIOD_S as f32);
        angle_between_rad(here, there)
    });
    Ok(differences.fold(0.0, f64::max))
}

fn samples() -> Vec<Sample> {
    let leaves = axes(AXES).zip(directions(AXES).cycle()).enumerate();
    let samples = leaves.flat_map(|(k, (axis, about))| {
        let carried = Quat::from_axis_angle(about, 0.07 * (k % 40) as f32);
        let leaf = RestingLeaf { axis, phase: (0.618 * k as f32).fract() };
        winds(carried * axis, WINDS).enumerate().map(move |(number, direction)| {
            let speed = SPEEDS_M_S[(number + k) % SPEEDS_M_S.len()];
            let time_s = (1.7 * number as f32 + 0.31 * k as f32) % FLUTTER_PERIOD_S as f32;
            Sample { leaf, carried, wind: speed * direction, time_s }
        })
    });
    samples.collect()
}

/// The rotations that the shader computes.
fn on_gpu(samples: &[Sample]) -> Result<Vec<Quat>, String> {
    let mut app = support::headless_app(Duration::ZERO, None);
    app.add_plugins(probe::plugin);
    app.finish();
    app.cleanup();
    let rows = samples.iter().flat_map(|sample| {
        let Sample { leaf, carried, wind, time_s } = sample;
        [leaf.axis.extend(leaf.phase), Vec4::from(*carried), wind.extend(*time_s)]
    });
    // `LeafResponse` of the shader.
    let LeafResponse { turn, onset_speed_m_s, full_speed_m_s, flutter_angle_rad, flutter_frequency_hz } = FULLY_TURNING;
    let response = vec![
        Vec4::new(turn, onset_speed_m_s, full_speed_m_s, flutter_angle_rad),
        Vec4::new(flutter_frequency_hz, FLUTTER_PERIOD_S as f32, 0.0, 0.0),
    ];
    let world = app.world_mut();
    let response = probe::uniform(world, response);
    let shader = ProbeSource { entry_point: "turn_leaves", wesl: TURN_SHADER };
    let read = probe::install(world, shader, rows.collect(), [samples.len(), 1], [(104, response)]);
    // Zeros are no rotation.
    let rows = probe::read_all(&mut app, &read, |rotation| rotation.length() > 0.5)?;
    Ok(rows.into_iter().map(Quat::from_vec4).collect())
}
