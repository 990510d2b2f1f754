//! The graphics processor bends blades as the processor does. Needs a Vulkan driver; Mesa's software one will do.

mod support;

use bevy::{
    core_pipeline::schedule::camera_driver,
    prelude::*,
    render::{
        RenderApp,
        extract_resource::{ExtractResource, ExtractResourcePlugin},
        gpu_readback::{Readback, ReadbackComplete},
        render_asset::RenderAssets,
        render_resource::{
            BindGroupEntries, BindGroupLayoutDescriptor, BindGroupLayoutEntries, CachedComputePipelineId,
            ComputePassDescriptor, ComputePipelineDescriptor, PipelineCache, ShaderStages,
            binding_types::{storage_buffer_read_only_sized, storage_buffer_sized},
        },
        renderer::{RenderContext, RenderDevice, RenderGraph},
        storage::{GpuShaderBuffer, ShaderBuffer},
    },
    shader::Shader,
};
use bevy_windwood::{
    grass::{
        blades::{Blade, lay_out},
        spine::{LINKS, tip_bend},
    },
    prelude::*,
};
use std::{
    sync::{Arc, Mutex},
    time::Duration,
};
use support::{headless_app, render_frame};

const HALF_BEND_SPEED_M_S: f32 = 10.0;

/// A blade is two rows: root and length; azimuth, lean, droop. Then comes the wind as (x, z).
const BEND_SHADER: &str = "
#import bevy_windwood::blade::{Blade, LINKS, joint_at, tip_bend}
@group(0) @binding(0) var<storage, read> blades: array<vec4<f32>>;
@group(0) @binding(1) var<storage, read_write> joints: array<vec4<f32>>;
@compute @workgroup_size(64)
fn bend(@builtin(global_invocation_id) id: vec3<u32>) {
    if (LINKS + 1u) * id.x >= arrayLength(&joints) {
        return;
    }
    let a = blades[3u * id.x];
    let b = blades[3u * id.x + 1u];
    let tip = tip_bend(blades[3u * id.x + 2u].xy, 10.0);
    for (var link = 0u; link <= LINKS; link += 1u) {
        let joint = joint_at(Blade(a.xyz, a.w, b.x, b.y, b.z), tip, link);
        joints[(LINKS + 1u) * id.x + link] = vec4(joint.position, 1.0);
    }
}
";

#[derive(Resource, ExtractResource, Clone)]
struct Probe {
    blades: Handle<ShaderBuffer>,
    joints: Handle<ShaderBuffer>,
    shader: Handle<Shader>,
    count: u32,
}

#[derive(Resource)]
struct BendPipeline(BindGroupLayoutDescriptor, CachedComputePipelineId);

#[test]
fn bent_blades_agree_on_both_processors() {
    let sward = Sward { width_m: 4.0, depth_m: 4.0, seed: 2, ..default() };
    let blades = lay_out(&sward, |at| 0.1 * at.x);
    let winds: Vec<Vec2> = (0..blades.len()).map(|k| Vec2::from_angle(k as f32) * (k % 40) as f32).collect();
    let mut app = headless_app(Duration::from_millis(16), None);
    app.add_plugins(ExtractResourcePlugin::<Probe>::default());
    if let Some(render_app) = app.get_sub_app_mut(RenderApp) {
        render_app.add_systems(RenderGraph, bend.before(camera_driver));
    }
    app.finish();
    app.cleanup();
    let read = install_probe(&mut app, &blades, &winds);
    let mut joints = Vec::new();
    for _ in 0..20 {
        render_frame(&mut app).expect("the frame is rendered");
        if let Some(bytes) = read.lock().expect("nobody panics with it").take() {
            joints = rows(&bytes);
        }
    }
    assert_eq!(joints.len(), blades.len() * (LINKS + 1));
    assert!(joints.iter().all(|joint| joint.w == 1.0), "every joint was written");
    let mut farthest = 0.0_f32;
    for ((blade, wind), joints) in blades.iter().zip(&winds).zip(joints.chunks_exact(LINKS + 1)) {
        let here = blade.spine(tip_bend(*wind, HALF_BEND_SPEED_M_S));
        for (here, there) in here.iter().zip(joints) {
            farthest = farthest.max(here.distance(there.truncate()) / blade.length_m);
        }
    }
    assert!(farthest < 1e-3, "the two differ by {farthest} of a blade's length");
}

fn install_probe(app: &mut App, blades: &[Blade], winds: &[Vec2]) -> Arc<Mutex<Option<Vec<u8>>>> {
    let inputs = blades.iter().zip(winds).flat_map(|(blade, wind)| {
        let turn = Vec4::new(blade.azimuth_rad, blade.lean_rad, blade.droop_rad, 0.0);
        [blade.root.extend(blade.length_m), turn, Vec4::new(wind.x, wind.y, 0.0, 0.0)]
    });
    let inputs: Vec<Vec4> = inputs.collect();
    let read: Arc<Mutex<Option<Vec<u8>>>> = Arc::default();
    let world = app.world_mut();
    let shader = world.resource_mut::<Assets<Shader>>().add(Shader::from_wgsl(BEND_SHADER, "bend.wgsl"));
    let mut buffers = world.resource_mut::<Assets<ShaderBuffer>>();
    let inputs = buffers.add(ShaderBuffer::from(inputs));
    let joints = buffers.add(ShaderBuffer::from(vec![Vec4::ZERO; blades.len() * (LINKS + 1)]));
    let filled = read.clone();
    world.spawn(Readback::buffer(joints.clone())).observe(move |complete: On<ReadbackComplete>| {
        *filled.lock().expect("nobody panics with it") = Some(complete.data.clone());
    });
    world.insert_resource(Probe { blades: inputs, joints, shader, count: blades.len() as u32 });
    read
}

fn rows(bytes: &[u8]) -> Vec<Vec4> {
    let floats: Vec<f32> = bytes.chunks_exact(4).map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect();
    floats.chunks_exact(4).map(Vec4::from_slice).collect()
}

fn bend(
    mut context: RenderContext,
    mut commands: Commands,
    probe: Option<Res<Probe>>,
    pipeline: Option<Res<BendPipeline>>,
    buffers: Res<RenderAssets<GpuShaderBuffer>>,
    device: Res<RenderDevice>,
    cache: Res<PipelineCache>,
) {
    let Some(probe) = probe else { return };
    let Some(pipeline) = pipeline else {
        commands.insert_resource(queue_pipeline(&probe, &cache));
        return;
    };
    let Some(compute) = cache.get_compute_pipeline(pipeline.1) else { return };
    let (Some(blades), Some(joints)) = (buffers.get(&probe.blades), buffers.get(&probe.joints)) else { return };
    let [blades, joints] = [blades, joints].map(|buffer| buffer.buffer.as_entire_buffer_binding());
    let layout = cache.get_bind_group_layout(&pipeline.0);
    let group = device.create_bind_group("bend", &layout, &BindGroupEntries::sequential((blades, joints)));
    let descriptor = ComputePassDescriptor { label: Some("bend"), timestamp_writes: None };
    let mut pass = context.command_encoder().begin_compute_pass(&descriptor);
    pass.set_pipeline(compute);
    pass.set_bind_group(0, &group, &[]);
    pass.dispatch_workgroups(probe.count.div_ceil(64), 1, 1);
}

fn queue_pipeline(probe: &Probe, cache: &PipelineCache) -> BendPipeline {
    let entries = (storage_buffer_read_only_sized(false, None), storage_buffer_sized(false, None));
    let layout =
        BindGroupLayoutDescriptor::new("bend", &BindGroupLayoutEntries::sequential(ShaderStages::COMPUTE, entries));
    let id = cache.queue_compute_pipeline(ComputePipelineDescriptor {
        label: Some("bend".into()),
        layout: vec![layout.clone()],
        shader: probe.shader.clone(),
        entry_point: Some("bend".into()),
        ..default()
    });
    BendPipeline(layout, id)
}
