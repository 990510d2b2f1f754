//! Registers the drawing of trees.

use super::{
    draw::{DrawPath, SpeciesDressed, Wardrobe, dress_trees},
    looks::{Tailoring, finish_tailoring, start_tailoring},
    material::SwayMaterial,
    upload::{WindBuffers, upload_frame, upload_tables},
};
use crate::{schedule::WindwoodSystems, tree::receive_models};
use bevy::{
    asset::embedded_asset,
    pbr::MaterialPlugin,
    prelude::*,
    render::{
        RenderApp,
        batching::gpu_preprocessing::{GpuPreprocessingMode, GpuPreprocessingSupport},
        renderer::RenderDevice,
    },
    shader::load_shader_library,
};

/// Draws [`Tree`](crate::tree::Tree)s, posed in the vertex shader. Without a renderer it does nothing but say so.
pub struct SwayDrawPlugin;

/// Storage buffers that the vertex stage needs: our four, and Bevy's own for meshes, instances and skins.
const STORAGE_BUFFERS_NEEDED: u32 = 8;

impl Plugin for SwayDrawPlugin {
    fn build(&self, app: &mut App) {
        if app.get_sub_app(RenderApp).is_none() {
            info!("windwood: there is no renderer; trees move but are not drawn");
            return;
        }
        load_shader_library!(app, "shaders/pose.wgsl");
        load_shader_library!(app, "shaders/leaf.wgsl");
        embedded_asset!(app, "shaders/sway.wgsl");
        app.add_plugins(MaterialPlugin::<SwayMaterial>::default())
            .init_resource::<WindBuffers>()
            .init_resource::<Tailoring>()
            .init_resource::<Wardrobe>()
            .add_message::<SpeciesDressed>()
            .configure_sets(PostUpdate, WindwoodSystems::Upload.after(WindwoodSystems::Pose))
            .add_systems(
                Update,
                (start_tailoring.after(receive_models), finish_tailoring, dress_trees)
                    .chain()
                    .in_set(WindwoodSystems::Grow)
                    .run_if(resource_exists::<DrawPath>),
            )
            .add_systems(PostUpdate, (upload_tables, upload_frame).chain().in_set(WindwoodSystems::Upload));
    }

    /// The renderer knows its device only now.
    fn finish(&self, app: &mut App) {
        let Some(render_app) = app.get_sub_app(RenderApp) else { return };
        let Some(device) = render_app.world().get_resource::<RenderDevice>() else { return };
        let storage_buffers = device.limits().max_storage_buffers_per_shader_stage;
        let sways = storage_buffers >= STORAGE_BUFFERS_NEEDED;
        if !sways {
            warn!(
                "windwood: this device has {storage_buffers} storage buffers a shader stage and swaying trees need \
                 {STORAGE_BUFFERS_NEEDED}; trees stand still"
            );
        }
        let culls_on_gpu = render_app
            .world()
            .get_resource::<GpuPreprocessingSupport>()
            .is_some_and(|support| support.max_supported_mode == GpuPreprocessingMode::Culling);
        app.insert_resource(DrawPath { sways, culls_on_gpu });
    }
}
