//! The graphics processor feels the wind and bends blades as the processor does. Needs a Vulkan driver; Mesa's software one
//! will do.

mod support;

use bevy::{
    core_pipeline::schedule::camera_driver,
    prelude::*,
    render::{
        RenderApp,
        extract_resource::{ExtractResource, ExtractResourcePlugin},
        render_asset::RenderAssets,
        render_resource::{
            BindGroupEntries, BindGroupLayoutDescriptor, BindGroupLayoutEntries, CachedComputePipelineId,
            ComputePassDescriptor, ComputePipelineDescriptor, PipelineCache, ShaderStages,
            binding_types::{storage_buffer_read_only_sized, storage_buffer_sized},
        },
        renderer::{RenderContext, RenderDevice, RenderGraph},
        storage::{GpuShaderBuffer, ShaderBuffer},
    },
    shader::{Shader, ShaderDefVal},
};
use bevy_windwood::{
    grass::{
        blades::{Blade, lay_out},
        spine::{LINKS, tip_bend},
    },
    prelude::*,
    sway::StandTables,
};
use std::time::Duration;
use support::{ReadBack, floats, headless_app, read_every_frame, render_frame, update_until};

const HALF_BEND_SPEED_M_S: f32 = 10.0;

/// A moment that is nothing special.
const MOMENT_S: f64 = 37.3;
/// The height of the wind tables, m.
const TABLE_HEIGHT_M: f32 = 10.0;

/// A blade is three rows: root and length; azimuth, lean, droop; a wind that bends it and a place where the tables' wind is
/// asked for, both as (x, z). What is written is its joints, and that wind.
const BEND_SHADER: &str = "
import bevy_windwood::{grass::shaders::blade::{Blade, LINKS, joint_at, tip_bend}, render::shaders::wind::velocity_at};
@group(0) @binding(0) var<storage, read> blades: array<vec4<f32>>;
@group(0) @binding(1) var<storage, read_write> results: array<vec4<f32>>;
@compute @workgroup_size(64)
fn bend(@builtin(global_invocation_id) id: vec3<u32>) {
    let first = (LINKS + 2u) * id.x;
    if first >= arrayLength(&results) {
        return;
    }
    let a = blades[3u * id.x];
    let b = blades[3u * id.x + 1u];
    let c = blades[3u * id.x + 2u];
    let tip = tip_bend(c.xy, 10.0);
    for (var link = 0u; link <= LINKS; link += 1u) {
        let joint = joint_at(Blade(a.xyz, a.w, b.x, b.y, b.z), tip, link);
        results[first + link] = vec4(joint.position, 1.0);
    }
    results[first + LINKS + 1u] = vec4(velocity_at(vec3(c.z, 0.0, c.w), 0u), 1.0);
}
";

#[derive(Resource, ExtractResource, Clone)]
#[extract_app(RenderApp)]
struct Probe {
    blades: Handle<ShaderBuffer>,
    results: Handle<ShaderBuffer>,
    tables: StandTables,
    shader: Handle<Shader>,
    count: u32,
}

#[derive(Resource)]
struct BendPipeline(BindGroupLayoutDescriptor, CachedComputePipelineId);

#[test]
fn winds_and_bent_blades_agree_on_both_processors() {
    let sward = Sward { width_m: 4.0, depth_m: 4.0, seed: 2, ..default() };
    let blades = lay_out(&sward, |at| 0.1 * at.x);
    let winds: Vec<Vec2> = (0..blades.len()).map(|k| Vec2::from_angle(k as f32) * (k % 40) as f32).collect();
    // The wind blows along x; between its columns, 8 m apart in z, the two interpolate differently.
    let places: Vec<Vec2> =
        (0..blades.len()).map(|k| Vec2::new(1.7 * k as f32 - 900.0, 8.0 * (k % 37) as f32 - 96.0)).collect();
    let mut app = headless_app(Duration::ZERO, None);
    app.add_plugins(ExtractResourcePlugin::<Probe>::default());
    if let Some(render_app) = app.get_sub_app_mut(RenderApp) {
        render_app.add_systems(RenderGraph, bend.before(camera_driver));
    }
    app.finish();
    app.cleanup();
    assert!(update_until(&mut app, |world| world.resource::<ActiveSway>().is_settled()), "no wind");
    *app.world_mut().resource_mut::<WindClock>() = WindClock { time_s: MOMENT_S, previous_s: MOMENT_S };
    let read = install_probe(&mut app, &blades, &winds, &places);
    let mut results = Vec::new();
    for _ in 0..20 {
        render_frame(&mut app).expect("the frame is rendered");
        if let Some(bytes) = read.lock().expect("nobody panics with it").take() {
            results = rows(&bytes);
        }
    }
    assert_eq!(results.len(), blades.len() * (LINKS + 2));
    assert!(results.iter().all(|row| row.w == 1.0), "every row was written");
    let active = app.world().resource::<ActiveWind>();
    let (mut bend_error, mut wind_error) = (0.0_f32, 0.0_f32);
    for (number, there) in results.chunks_exact(LINKS + 2).enumerate() {
        let (blade, place) = (&blades[number], places[number]);
        for (here, there) in blade.spine(tip_bend(winds[number], HALF_BEND_SPEED_M_S)).iter().zip(there) {
            bend_error = bend_error.max(here.distance(there.truncate()) / blade.length_m);
        }
        let felt = active.sample(Vec3::new(place.x, TABLE_HEIGHT_M, place.y), MOMENT_S);
        wind_error = wind_error.max(felt.distance(there[LINKS + 1].truncate()));
    }
    assert!(bend_error < 1e-3, "the two bend differently by {bend_error} of a blade's length");
    // The shader works out the time in 32 bits, to some 1e-4 s, in which gusts change by less than this.
    assert!(wind_error < 1e-2, "the two winds differ by {wind_error} m/s");
}

fn install_probe(app: &mut App, blades: &[Blade], winds: &[Vec2], places: &[Vec2]) -> ReadBack {
    let inputs = blades.iter().zip(winds).zip(places).flat_map(|((blade, wind), place)| {
        let turn = Vec4::new(blade.azimuth_rad, blade.lean_rad, blade.droop_rad, 0.0);
        [blade.root.extend(blade.length_m), turn, Vec4::new(wind.x, wind.y, place.x, place.y)]
    });
    let inputs: Vec<Vec4> = inputs.collect();
    let world = app.world_mut();
    let tables = world.resource::<StandTables>().clone();
    let shader = world.resource_mut::<Assets<Shader>>().add(Shader::from_wesl(BEND_SHADER, "bend.wesl"));
    let mut buffers = world.resource_mut::<Assets<ShaderBuffer>>();
    let inputs = buffers.add(ShaderBuffer::from(inputs));
    let results = buffers.add(ShaderBuffer::from(vec![Vec4::ZERO; blades.len() * (LINKS + 2)]));
    world.insert_resource(Probe {
        blades: inputs,
        results: results.clone(),
        tables,
        shader,
        count: blades.len() as u32,
    });
    read_every_frame(world, results)
}

fn rows(bytes: &[u8]) -> Vec<Vec4> {
    floats(bytes).chunks_exact(4).map(Vec4::from_slice).collect()
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
    let [wind_a, wind_b] = &probe.tables.winds;
    let bound = [&probe.blades, &probe.results, &probe.tables.frame, wind_a, wind_b].map(|handle| buffers.get(handle));
    let [Some(a), Some(b), Some(c), Some(d), Some(e)] = bound else { return };
    let [a, b, c, d, e] = [a, b, c, d, e].map(|buffer| buffer.buffer.as_entire_buffer_binding());
    let entries = BindGroupEntries::with_indices(((0, a), (1, b), (103, c), (105, d), (106, e)));
    let group = device.create_bind_group("bend", &cache.get_bind_group_layout(&pipeline.0), &entries);
    let descriptor = ComputePassDescriptor { label: Some("bend"), timestamp_writes: None };
    let mut pass = context.command_encoder().begin_compute_pass(&descriptor);
    pass.set_pipeline(compute);
    pass.set_bind_group(0, &group, &[]);
    pass.dispatch_workgroups(probe.count.div_ceil(64), 1, 1);
}

fn queue_pipeline(probe: &Probe, cache: &PipelineCache) -> BendPipeline {
    let table = || storage_buffer_read_only_sized(false, None);
    let entries =
        ((0, table()), (1, storage_buffer_sized(false, None)), (103, table()), (105, table()), (106, table()));
    let layout =
        BindGroupLayoutDescriptor::new("bend", &BindGroupLayoutEntries::with_indices(ShaderStages::COMPUTE, entries));
    let id = cache.queue_compute_pipeline(ComputePipelineDescriptor {
        label: Some("bend".into()),
        layout: vec![layout.clone()],
        shader: probe.shader.clone(),
        shader_defs: vec![ShaderDefVal::UInt("MATERIAL_BIND_GROUP".into(), 0)],
        entry_point: Some("bend".into()),
        ..default()
    });
    BendPipeline(layout, id)
}
