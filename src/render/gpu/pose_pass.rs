//! The pose pass: poses all visible trees on the GPU, once a frame, before anything is drawn.
//!
//! Why not in the vertex shader alone: a vertex moves with a chain of up to ten beams, and each beam's response to the wind
//! is a dozen fetches from the tables. A tree has some twenty times as many vertices as beams, and each vertex is run in
//! every pass. Measured on software Vulkan, 60 trees at 640x400 with four samples: with the whole chain in the vertex
//! shader no picture was there after two minutes, this way one (of two or three frames) after 19 s.

use crate::{
    dynamics::{frequency_classes::FrequencyClasses, oscillator_grid::row_count},
    render::{
        buffers::sway_buffers::SwayBuffers,
        capabilities::can_read_tables,
        instances::{
            tag::{ROW_BITS, ROW_BITS_CONSTANT},
            workgroups::WORKGROUP_SIZE,
        },
    },
};
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

/// Workgroups in the first dimension; a device may allow no more than 65535.
const WORKGROUPS_ACROSS: u32 = 256;

/// The name of the poses among Bevy's render diagnostics.
pub const POSES_SPAN: &str = "tree_poses";

const POSE_SHADER: &str = "embedded://bevy_windwood/render/shaders/pose_pass.wesl";

/// What the pose pass does this frame.
#[derive(Resource, ExtractResource, Clone)]
#[extract_app(RenderApp)]
pub(crate) struct PoseDispatch {
    pub buffers: PoseBuffers,
    /// Workgroups: see [`PoseWorkgroups`](crate::render::instances::workgroups::PoseWorkgroups).
    pub workgroups: u32,
    /// Whether the poses of the frame before have to be computed as well, because they are not those that were last computed.
    pub is_previous_due: bool,
}

/// The tables of the pose pass.
#[derive(Clone)]
pub(crate) struct PoseBuffers {
    pub shared: SwayBuffers,
    /// `array<u32>`, one entry a workgroup.
    pub workgroups: Handle<ShaderBuffer>,
    /// `array<vec4<f32>>`: see [`LiveUploads`](super::live_upload::LiveUploads).
    pub live: Handle<ShaderBuffer>,
}

pub(crate) fn plugin(app: &mut App) {
    app.add_plugins(ExtractResourcePlugin::<PoseDispatch>::default());
    let Some(render_app) = app.get_sub_app_mut(RenderApp) else { return };
    render_app
        .add_systems(RenderStartup, queue_pipelines.run_if(can_pose))
        .add_systems(Render, bind_tables.in_set(RenderSystems::PrepareBindGroups))
        .add_systems(RenderGraph, pose_trees.in_set(RenderGraphSystems::Render).before(camera_driver));
}

/// Where the device cannot read the tables, trees stand still.
fn can_pose(device: Res<RenderDevice>) -> bool {
    can_read_tables(&device.limits())
}

#[derive(Resource)]
struct PosePipelines {
    layout: BindGroupLayoutDescriptor,
    find_tip_angles: CachedComputePipelineId,
    add_parent_motion: CachedComputePipelineId,
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
                (109, table()),
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
                ShaderDefVal::UInt(ROW_BITS_CONSTANT.into(), ROW_BITS),
                ShaderDefVal::UInt("POSE_WORKGROUP_SIZE".into(), WORKGROUP_SIZE),
                ShaderDefVal::UInt("POSE_WORKGROUPS_ACROSS".into(), WORKGROUPS_ACROSS),
                ShaderDefVal::UInt("TABLE_ROWS".into(), row_count(&FrequencyClasses::default()) as u32),
            ],
            entry_point: Some(entry_point.into()),
            ..default()
        })
    };
    let (find_tip_angles, add_parent_motion) = (pipeline("find_tip_angles"), pipeline("add_parent_motion"));
    commands.insert_resource(PosePipelines { layout, find_tip_angles, add_parent_motion });
}

/// Binds anew each frame: any of the buffers may have been replaced by a larger one.
fn bind_tables(
    mut commands: Commands,
    dispatch: Option<Res<PoseDispatch>>,
    pipelines: Option<Res<PosePipelines>>,
    buffers: Res<RenderAssets<GpuShaderBuffer>>,
    device: Res<RenderDevice>,
    cache: Res<PipelineCache>,
) {
    commands.remove_resource::<PoseBindings>();
    let (Some(dispatch), Some(pipelines)) = (dispatch, pipelines) else { return };
    let PoseBuffers { shared, workgroups, live } = &dispatch.buffers;
    let [wind_a, wind_b] = &shared.winds;
    let buffer = |handle| Some(buffers.get(handle)?.buffer.as_entire_buffer_binding());
    let entries = || {
        Some(BindGroupEntries::with_indices((
            (100, buffer(&shared.poses)?),
            (101, buffer(&shared.beams)?),
            (102, buffer(&shared.trees)?),
            (103, buffer(&shared.frame)?),
            (104, buffer(workgroups)?),
            (105, buffer(wind_a)?),
            (106, buffer(wind_b)?),
            (109, buffer(live)?),
        )))
    };
    let Some(entries) = entries() else { return };
    let layout = cache.get_bind_group_layout(&pipelines.layout);
    let group = device.create_bind_group("tree poses", &layout, &entries);
    commands.insert_resource(PoseBindings(group));
}

fn pose_trees(
    mut context: RenderContext,
    dispatch: Option<Res<PoseDispatch>>,
    bindings: Option<Res<PoseBindings>>,
    pipelines: Option<Res<PosePipelines>>,
    cache: Res<PipelineCache>,
) {
    let (Some(dispatch), Some(bindings), Some(pipelines)) = (dispatch, bindings, pipelines) else { return };
    let ready = |id| cache.get_compute_pipeline(id);
    let Some(find_tip_angles) = ready(pipelines.find_tip_angles) else { return };
    let Some(add_parent_motion) = ready(pipelines.add_parent_motion) else { return };
    if dispatch.workgroups == 0 {
        return;
    }
    let recorder = context.diagnostic_recorder();
    let recorder = recorder.as_deref();
    let descriptor = ComputePassDescriptor { label: Some("tree poses"), timestamp_writes: None };
    let mut pass = context.command_encoder().begin_compute_pass(&descriptor);
    let span = recorder.pass_span(&mut pass, POSES_SPAN);
    pass.set_bind_group(0, &bindings.0, &[]);
    let (across, down) = (dispatch.workgroups.min(WORKGROUPS_ACROSS), dispatch.workgroups.div_ceil(WORKGROUPS_ACROSS));
    for pipeline in [find_tip_angles, add_parent_motion] {
        pass.set_pipeline(pipeline);
        pass.dispatch_workgroups(across, down, if dispatch.is_previous_due { 2 } else { 1 });
    }
    span.end(&mut pass);
}
