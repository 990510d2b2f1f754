//! Runs the poses of all trees on the graphics processor, once a frame, before anything is drawn.
//!
//! Why not in the vertex shader alone: a vertex rides on a chain of up to ten beams, and each beam's answer to the wind
//! is a dozen fetches from the tables. A tree has some twenty times as many vertices as beams, and each vertex is run in
//! every pass. Measured on software Vulkan, 60 trees at 640x400 with four samples: with the whole chain in the vertex
//! shader no picture was there after two minutes, this way one (of two or three frames) after 19 s.

use super::rows::CHUNK;
use bevy::{
    core_pipeline::schedule::camera_driver,
    prelude::*,
    render::{
        Render, RenderApp, RenderStartup, RenderSystems,
        diagnostic::RecordDiagnostics,
        extract_resource::{ExtractResource, ExtractResourcePlugin},
        render_asset::RenderAssets,
        render_resource::{
            BindGroup, BindGroupEntries, BindGroupLayoutDescriptor, BindGroupLayoutEntries, CachedComputePipelineId,
            ComputePassDescriptor, ComputePipelineDescriptor, PipelineCache, ShaderStages,
            binding_types::{storage_buffer_read_only_sized, storage_buffer_sized},
        },
        renderer::{RenderContext, RenderDevice, RenderGraph, RenderGraphSystems},
        storage::{GpuShaderBuffer, ShaderBuffer},
    },
    shader::ShaderDefVal,
};

/// Workgroups in the first dimension, of which a device may allow but 65535; `ACROSS` of the shader.
const ACROSS: u32 = 256;

/// The name of the poses among Bevy's render diagnostics.
pub const POSES_SPAN: &str = "tree_poses";

const POSE_SHADER: &str = "embedded://bevy_windwood/render/shaders/pose_pass.wesl";

/// What is to be posed this frame.
#[derive(Resource, ExtractResource, Clone)]
#[extract_app(RenderApp)]
pub(super) struct PoseJob {
    /// Slot A, slot B, beams, trees, chunks, frame, poses.
    pub buffers: [Handle<ShaderBuffer>; 7],
    /// Chunks of beams that are posed.
    pub chunks: u32,
    /// Whether the poses of the frame before have to be found as well, because they are not those that were last found.
    pub both: bool,
}

pub(super) fn plugin(app: &mut App) {
    app.add_plugins(ExtractResourcePlugin::<PoseJob>::default());
    let Some(render_app) = app.get_sub_app_mut(RenderApp) else { return };
    render_app
        .add_systems(RenderStartup, queue_pipelines.run_if(can_pose))
        .add_systems(Render, bind_tables.in_set(RenderSystems::PrepareBindGroups))
        .add_systems(RenderGraph, pose_trees.in_set(RenderGraphSystems::Render).before(camera_driver));
}

/// Storage buffers that a stage needs: seven to pose; to draw, our four and Bevy's own for meshes, instances and skins.
pub(super) const STORAGE_BUFFERS_NEEDED: u32 = 8;

/// Where there are too few buffers, trees stand still and even a pipeline's layout would be an error.
fn can_pose(device: Res<RenderDevice>) -> bool {
    device.limits().max_storage_buffers_per_shader_stage >= STORAGE_BUFFERS_NEEDED
}

#[derive(Resource)]
struct PosePipelines {
    layout: BindGroupLayoutDescriptor,
    find_tip_angles: CachedComputePipelineId,
    ride: CachedComputePipelineId,
}

#[derive(Resource)]
struct PoseBindings(BindGroup);

fn queue_pipelines(mut commands: Commands, assets: Res<AssetServer>, cache: Res<PipelineCache>) {
    let table = || storage_buffer_read_only_sized(false, None);
    let layout = BindGroupLayoutDescriptor::new(
        "tree poses",
        &BindGroupLayoutEntries::with_indices(
            ShaderStages::COMPUTE,
            (
                (100, storage_buffer_sized(false, None)),
                (101, table()),
                (102, table()),
                (103, table()),
                (104, table()),
                (105, table()),
                (106, table()),
            ),
        ),
    );
    let pipeline = |entry_point: &'static str| {
        cache.queue_compute_pipeline(ComputePipelineDescriptor {
            label: Some(entry_point.into()),
            layout: vec![layout.clone()],
            shader: assets.load(POSE_SHADER),
            // Materials and this shader import the same tables; here they are in the only group.
            shader_defs: vec![
                ShaderDefVal::UInt("MATERIAL_BIND_GROUP".into(), 0),
                ShaderDefVal::UInt("POSE_WORKGROUP_SIZE".into(), CHUNK),
                ShaderDefVal::UInt("POSE_WORKGROUPS_ACROSS".into(), ACROSS),
            ],
            entry_point: Some(entry_point.into()),
            ..default()
        })
    };
    let (find_tip_angles, ride) = (pipeline("find_tip_angles"), pipeline("add_parent_motion"));
    commands.insert_resource(PosePipelines { layout, find_tip_angles, ride });
}

/// Binds anew each frame: any of the buffers may have been replaced by a larger one.
fn bind_tables(
    mut commands: Commands,
    job: Option<Res<PoseJob>>,
    pipelines: Option<Res<PosePipelines>>,
    buffers: Res<RenderAssets<GpuShaderBuffer>>,
    device: Res<RenderDevice>,
    cache: Res<PipelineCache>,
) {
    commands.remove_resource::<PoseBindings>();
    let (Some(job), Some(pipelines)) = (job, pipelines) else { return };
    let bound = job.buffers.each_ref().map(|handle| buffers.get(handle));
    let [Some(a), Some(b), Some(beams), Some(trees), Some(chunks), Some(frame), Some(poses)] = bound else { return };
    let entries = [a, b, beams, trees, chunks, frame, poses].map(|buffer| buffer.buffer.as_entire_buffer_binding());
    let [a, b, beams, trees, chunks, frame, poses] = entries;
    let layout = cache.get_bind_group_layout(&pipelines.layout);
    let group = device.create_bind_group(
        "tree poses",
        &layout,
        &BindGroupEntries::with_indices((
            (100, poses),
            (101, beams),
            (102, trees),
            (103, frame),
            (104, chunks),
            (105, a),
            (106, b),
        )),
    );
    commands.insert_resource(PoseBindings(group));
}

fn pose_trees(
    mut context: RenderContext,
    job: Option<Res<PoseJob>>,
    bindings: Option<Res<PoseBindings>>,
    pipelines: Option<Res<PosePipelines>>,
    cache: Res<PipelineCache>,
) {
    let (Some(job), Some(bindings), Some(pipelines)) = (job, bindings, pipelines) else { return };
    let ready = |id| cache.get_compute_pipeline(id);
    let (Some(find_tip_angles), Some(ride)) = (ready(pipelines.find_tip_angles), ready(pipelines.ride)) else { return };
    if job.chunks == 0 {
        return;
    }
    let recorder = context.diagnostic_recorder();
    let recorder = recorder.as_deref();
    let descriptor = ComputePassDescriptor { label: Some("tree poses"), timestamp_writes: None };
    let mut pass = context.command_encoder().begin_compute_pass(&descriptor);
    let span = recorder.pass_span(&mut pass, POSES_SPAN);
    pass.set_bind_group(0, &bindings.0, &[]);
    let (across, down) = (job.chunks.min(ACROSS), job.chunks.div_ceil(ACROSS));
    for pipeline in [find_tip_angles, ride] {
        pass.set_pipeline(pipeline);
        pass.dispatch_workgroups(across, down, if job.both { 2 } else { 1 });
    }
    span.end(&mut pass);
}
