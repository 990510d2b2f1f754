//! Registers the drawing of trees.

use super::{
    compute,
    compute::{PoseJob, STORAGE_BUFFERS_NEEDED},
    detail::{CardRange, LevelOfDetail, Sight, look_about},
    draw::{DrawPath, choose_levels, fit_boxes},
    dress::dress_trees,
    exposure::{Exposure, find_exposure},
    lighting::{TreeLighting, TreeLights, find_lights, relight},
    looks::{StageDressed, Tailoring, Wardrobe, finish_tailoring, start_tailoring},
    material::{SwayExtension, SwayMaterial},
    mend,
    rouse::{Roused, recall_meshes, rouse_meshes},
    rows::POSE_BYTES,
    stand::{Stand, dismiss_tree, place_trees, see_trees},
    upload::{StandBuffers, StandTables, upload_frame, upload_winds},
    writes,
};
use crate::{
    render::load_shaders, schedule::WindwoodSystems, timing::timed, tree::receive_models,
    viewpoint::give_cameras_viewpoints,
};
use bevy::{
    camera::visibility::VisibilitySystems,
    pbr::MaterialPlugin,
    prelude::*,
    render::{
        RenderApp,
        batching::gpu_preprocessing::{GpuPreprocessingMode, GpuPreprocessingSupport},
        renderer::RenderDevice,
    },
};

/// Draws [`Tree`](crate::tree::Tree)s, posed in the vertex shader. Without a renderer it does nothing but say so.
pub struct SwayDrawPlugin;

impl Plugin for SwayDrawPlugin {
    fn build(&self, app: &mut App) {
        if app.get_sub_app(RenderApp).is_none() {
            info!("windwood: there is no renderer; trees move but are not drawn");
            return;
        }
        load_shaders(app);
        give_cameras_viewpoints(app);
        app.add_plugins((MaterialPlugin::<SwayMaterial>::default(), compute::plugin, writes::plugin, mend::plugin))
            .init_resource::<StandBuffers>()
            .init_resource::<StandTables>()
            .init_resource::<PoseJob>()
            .init_resource::<Stand>()
            .init_resource::<LevelOfDetail>()
            .init_resource::<Sight>()
            .insert_resource(CardRange { from_m: None })
            .init_resource::<Exposure>()
            .init_resource::<TreeLighting>()
            .init_resource::<TreeLights>()
            .register_type::<LevelOfDetail>()
            .register_type::<TreeLighting>()
            .init_resource::<Tailoring>()
            .init_resource::<Wardrobe>()
            .add_message::<StageDressed>()
            .add_observer(dismiss_tree)
            .configure_sets(PostUpdate, WindwoodSystems::Upload.after(TransformSystems::Propagate))
            .init_resource::<Roused>()
            .add_systems(
                PostUpdate,
                (
                    recall_meshes.before(VisibilitySystems::VisibilityPropagate),
                    rouse_meshes
                        .after(VisibilitySystems::VisibilityPropagate)
                        .before(VisibilitySystems::CheckVisibility),
                ),
            );
        let dress = timed!(
            app,
            look_about,
            find_exposure,
            start_tailoring,
            finish_tailoring,
            fit_boxes,
            choose_levels,
            dress_trees
        );
        let dress =
            dress.chain().after(receive_models).in_set(WindwoodSystems::Grow).run_if(resource_exists::<DrawPath>);
        let upload = timed!(app, upload_winds, place_trees, see_trees, upload_frame);
        let light = (find_lights, relight::<SwayExtension>.run_if(resource_changed::<TreeLights>)).chain();
        app.add_systems(Update, (dress, light)).add_systems(
            PostUpdate,
            upload
                .chain()
                .after(VisibilitySystems::VisibilityPropagate)
                .in_set(WindwoodSystems::Upload)
                .run_if(resource_exists::<DrawPath>),
        );
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
        // Poses have two halves, and half as many again are kept ready.
        let largest = device.limits().max_storage_buffer_binding_size.min(device.limits().max_buffer_size);
        let pose_limit = u32::try_from(largest / (3 * POSE_BYTES as u64)).unwrap_or(u32::MAX);
        app.insert_resource(Stand::new(pose_limit)).insert_resource(DrawPath {
            sways,
            culls_on_gpu,
            pose_limit,
            table_limit_bytes: largest,
        });
    }
}
