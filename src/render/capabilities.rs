//! What the device can do.

use crate::render::instances::rows::POSE_BYTES;
use bevy::{
    prelude::*,
    render::{
        RenderApp,
        batching::gpu_preprocessing::{GpuPreprocessingMode, GpuPreprocessingSupport},
        render_resource::WgpuLimits,
        renderer::{RenderAdapterInfo, RenderDevice},
        settings::WgpuFeatures,
    },
};
use wgpu_types::DeviceType;

/// How this machine can draw trees. It is found out once, when the app starts.
#[derive(Resource, Clone, Copy, Debug, PartialEq, Eq)]
pub struct RenderCapabilities {
    /// Whether vertex shaders can read the wind tables. If not, trees stand still in a standard material.
    pub sways: bool,
    /// Whether the GPU does the frustum culling, so that the CPU need not.
    pub culls_on_gpu: bool,
    /// Beams that can be posed at once, over all trees that are seen; trees beyond that stand still.
    pub max_poses: u32,
    /// Whether it is a software renderer. It runs every branch of a shader, so shaders are compiled for the lights that there are
    /// ([`TreeLighting`](super::TreeLighting)).
    pub is_software: bool,
    /// Whether textures are compressed in blocks (BC1 to BC5): where the device can read these. A software renderer can, but takes several
    /// times as long as for plain ones, and has no memory of its own to save.
    pub compresses_textures: bool,
    /// Size of the largest table that a shader can read, bytes.
    pub max_table_bytes: u64,
}

/// Storage buffers that a shader stage needs: eight for the pose pass; to draw, our four and Bevy's own for meshes, instances and
/// skins.
const STORAGE_BUFFERS_NEEDED: u32 = 8;

/// Whether the shaders of a device can read the tables of trees. Where they cannot, even the layout of a pipeline would be an error.
pub(crate) fn can_read_tables(limits: &WgpuLimits) -> bool {
    limits.max_storage_buffers_per_shader_stage >= STORAGE_BUFFERS_NEEDED
}

impl RenderCapabilities {
    /// Those of the app's device; none without a renderer.
    pub(crate) fn of(app: &App) -> Option<Self> {
        let render_world = app.get_sub_app(RenderApp)?.world();
        let limits = render_world.get_resource::<RenderDevice>()?.limits();
        let sways = can_read_tables(&limits);
        if !sways {
            warn!(
                "windwood: this device has {} storage buffers a shader stage and swaying trees need {STORAGE_BUFFERS_NEEDED}; \
                 trees stand still",
                limits.max_storage_buffers_per_shader_stage
            );
        }
        let culls_on_gpu = render_world
            .get_resource::<GpuPreprocessingSupport>()
            .is_some_and(|support| support.max_supported_mode == GpuPreprocessingMode::Culling);
        // Poses may have two halves, and their reserve ends where the device can bind no more.
        let max_table_bytes = limits.max_storage_buffer_binding_size.min(limits.max_buffer_size);
        let max_poses = u32::try_from(max_table_bytes / (2 * POSE_BYTES as u64)).unwrap_or(u32::MAX);
        let adapter = render_world.get_resource::<RenderAdapterInfo>();
        let is_software = adapter.is_some_and(|adapter| adapter.device_type == DeviceType::Cpu);
        let features = render_world.get_resource::<RenderDevice>()?.features();
        let compresses_textures = !is_software && features.contains(WgpuFeatures::TEXTURE_COMPRESSION_BC);
        Some(Self { sways, culls_on_gpu, max_poses, is_software, compresses_textures, max_table_bytes })
    }
}
