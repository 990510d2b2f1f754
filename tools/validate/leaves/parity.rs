//! Leaves turned by the shader module that draws them, in a compute shader, against the same in Rust.

use super::{FULLY_TURNING, angle_between_rad, axes, directions, winds};
use crate::support::{
    self,
    probe::{ProbePass, ProbeShader},
};
use bevy::{
    core_pipeline::schedule::camera_driver,
    prelude::*,
    render::{
        RenderApp,
        extract_resource::{ExtractResource, ExtractResourcePlugin},
        render_asset::RenderAssets,
        render_resource::{
            BindGroupEntries, BindGroupLayoutEntries, BufferUsages, ShaderStages,
            binding_types::{storage_buffer_read_only_sized, storage_buffer_sized, uniform_buffer_sized},
        },
        renderer::RenderGraph,
        storage::{GpuShaderBuffer, ShaderBuffer},
    },
    shader::Shader,
};
use bevy_windwood::{dynamics::RestingLeaf, sway::FLUTTER_PERIOD_S};
use std::{num::NonZeroU64, time::Duration};

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

#[derive(Resource, ExtractResource, Clone)]
#[extract_app(RenderApp)]
struct Probe {
    samples: Handle<ShaderBuffer>,
    rotations: Handle<ShaderBuffer>,
    response: Handle<ShaderBuffer>,
    shader: Handle<Shader>,
    count: u32,
}

/// The largest rotation between what the two compute, rad.
pub fn worst_difference_rad() -> Result<f64, String> {
    let samples = samples();
    let mut app = headless_app();
    let read = install_probe(&mut app, &samples);
    let there = read_back(&mut app, &read, samples.len())?;
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

fn headless_app() -> App {
    let mut app = support::headless_app(Duration::ZERO, None);
    app.add_plugins(ExtractResourcePlugin::<Probe>::default());
    if let Some(render_app) = app.get_sub_app_mut(RenderApp) {
        render_app.add_systems(RenderGraph, turn_leaves.before(camera_driver));
    }
    app.finish();
    app.cleanup();
    app
}

fn install_probe(app: &mut App, samples: &[Sample]) -> support::ReadBack {
    let rows = samples.iter().flat_map(|sample| {
        let Sample { leaf, carried, wind, time_s } = sample;
        [leaf.axis.extend(leaf.phase), Vec4::from(*carried), wind.extend(*time_s)]
    });
    let rows: Vec<Vec4> = rows.collect();
    // `LeafResponse` of the shader.
    let response = vec![
        FULLY_TURNING.turn,
        FULLY_TURNING.onset_speed_m_s,
        FULLY_TURNING.full_speed_m_s,
        FULLY_TURNING.flutter_angle_rad,
        FULLY_TURNING.flutter_frequency_hz,
        FLUTTER_PERIOD_S as f32,
        0.0,
        0.0,
    ];
    let mut response = ShaderBuffer::from(response);
    response.buffer_usage |= BufferUsages::UNIFORM;
    let world = app.world_mut();
    let shader = world.resource_mut::<Assets<Shader>>().add(Shader::from_wesl(TURN_SHADER, "turn_leaves.wesl"));
    let mut buffers = world.resource_mut::<Assets<ShaderBuffer>>();
    let response = buffers.add(response);
    let sampled = buffers.add(ShaderBuffer::from(rows));
    let rotations = buffers.add(ShaderBuffer::from(vec![Vec4::ZERO; samples.len()]));
    let count = samples.len() as u32;
    world.insert_resource(Probe { samples: sampled, rotations: rotations.clone(), response, shader, count });
    support::read_every_frame(world, rotations)
}

/// Renders frames until every rotation has been written.
fn read_back(app: &mut App, read: &support::ReadBack, count: usize) -> Result<Vec<Quat>, String> {
    const MOST_FRAMES: usize = 200;
    for _ in 0..MOST_FRAMES {
        support::render_frame(app)?;
        let Some(bytes) = read.lock().ok().and_then(|mut slot| slot.take()) else { continue };
        let rotations: Vec<Quat> = support::floats(&bytes).chunks_exact(4).map(Quat::from_slice).collect();
        // The buffer begins as zeros, which are no rotations.
        if rotations.len() == count && rotations.iter().all(|rotation| rotation.length() > 0.5) {
            return Ok(rotations);
        }
    }
    Err("the GPU did not write every rotation".into())
}

fn turn_leaves(mut pass: ProbePass, probe: Option<Res<Probe>>, buffers: Res<RenderAssets<GpuShaderBuffer>>) {
    let Some(probe) = probe else { return };
    let bound = [&probe.samples, &probe.rotations, &probe.response].map(|handle| buffers.get(handle));
    let [Some(samples), Some(rotations), Some(response)] = bound else { return };
    let [samples, rotations, response] =
        [samples, rotations, response].map(|buffer| buffer.buffer.as_entire_buffer_binding());
    let entries = (
        (0, storage_buffer_read_only_sized(false, None)),
        (1, storage_buffer_sized(false, None)),
        (104, uniform_buffer_sized(false, NonZeroU64::new(32))),
    );
    pass.run(
        ProbeShader { entry_point: "turn_leaves", shader: &probe.shader },
        &BindGroupLayoutEntries::with_indices(ShaderStages::COMPUTE, entries),
        &BindGroupEntries::with_indices(((0, samples), (1, rotations), (104, response))),
        [probe.count.div_ceil(64), 1],
    );
}
