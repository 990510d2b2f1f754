//! Registers the drawing of trees.

use super::{
    buffers::{buffer_writes, sway_buffers::SwayBuffers},
    capabilities::RenderCapabilities,
    draw::{
        bare::redraw_bare_trees,
        bounds::{fit_live_bounds, fit_tree_bounds},
        components::DrawnTree,
        forget::forget_prepared_species,
        growth::{FormerShape, fade_former_shapes, free_former_row, keep_former_shape},
        layers::copy_render_layers,
        mesh_entities::update_tree_meshes,
        removal::{LostMeshes, note_lost_mesh, remove_tree_meshes, restore_lost_meshes},
        waiting::{WaitingTrees, redraw_waiting_trees},
    },
    gpu::{
        live_upload::{LiveUploads, upload_live_trees},
        pose_pass::{self, PoseDispatch},
        upload::{PackedWind, UploadState, forget_uploads, pack_incoming_wind, upload_frame, upload_winds},
    },
    instances::{
        assign::{assign_instances, free_row, remove_models},
        components::TreeInstance,
        rows::BeamRow,
        tables::InstanceTables,
        track::{update_posed_trees, write_tree_rows},
    },
    lighting::{TreeLighting, TreeLights, find_lights, update_material_lights},
    lod::{
        select::select_lods,
        thresholds::LodSelection,
        viewers::{LodViewers, update_lod_viewers},
        want_parts::want_parts,
    },
    new_device::device_is_new,
    settings::{ActiveLevelOfDetail, LevelOfDetail, apply_level_of_detail},
    shader_files::load_shaders,
    species::{
        library::{SpeciesLibrary, SpeciesPrepared, VariantRemoved},
        load_parts::{PartLoads, finish_loading_parts, start_loading_parts},
        mesh_copies::{MeshCopies, drop_mesh_copies},
        prepare::{PreparationQueue, finish_preparing_species, remove_prepared_species, start_preparing_species},
        tree_material::{SwayExtension, SwayMaterial},
    },
    wind_exposure::{WindExposure, update_wind_exposure},
};
use crate::{
    plugin_checks::{has_renderer, require_renderer_before},
    schedule::{WindwoodSystems, configure_sets},
    sway::ActiveSway,
    timing::timed,
    tree::regrow_trees,
    viewpoint::give_cameras_viewpoints,
};
use bevy::{camera::visibility::VisibilitySystems, pbr::MaterialPlugin, prelude::*};

/// Draws [`Tree`](crate::tree::Tree)s, posed on the GPU. Without a renderer it only says so.
pub struct TreeRenderPlugin;

impl Plugin for TreeRenderPlugin {
    fn build(&self, app: &mut App) {
        if !has_renderer(app) {
            info!("windwood: there is no renderer; trees move but are not drawn");
            return;
        }
        load_shaders(app);
        give_cameras_viewpoints(app);
        app.add_plugins((MaterialPlugin::<SwayMaterial>::default(), pose_pass::plugin, buffer_writes::plugin))
            .register_type::<LevelOfDetail>()
            .register_type::<TreeLighting>()
            .register_required_components::<TreeInstance, LodSelection>()
            .register_required_components::<TreeInstance, DrawnTree>()
            .init_resource::<LevelOfDetail>()
            .init_resource::<ActiveLevelOfDetail>()
            .init_resource::<LodViewers>()
            .init_resource::<WindExposure>()
            .init_resource::<TreeLighting>()
            .init_resource::<TreeLights>()
            .init_resource::<SpeciesLibrary>()
            .init_resource::<PreparationQueue>()
            .init_resource::<PartLoads>()
            .init_resource::<MeshCopies>()
            .init_resource::<InstanceTables>()
            .init_resource::<LostMeshes>()
            .init_resource::<WaitingTrees>()
            .init_resource::<SwayBuffers>()
            .init_resource::<UploadState>()
            .init_resource::<PackedWind>()
            .init_resource::<LiveUploads>()
            .init_resource::<PoseDispatch>()
            .add_message::<SpeciesPrepared>()
            .add_message::<VariantRemoved>()
            .add_observer(free_row)
            .add_observer(keep_former_shape)
            .add_observer(free_former_row)
            .add_observer(remove_tree_meshes)
            .add_observer(note_lost_mesh);
        app.world_mut().resource_mut::<ActiveSway>().hold_incoming();

        let prepare = timed!(
            app,
            drop_mesh_copies,
            start_preparing_species,
            remove_prepared_species,
            finish_preparing_species,
            finish_loading_parts,
            update_wind_exposure
        );
        let draw = timed!(
            app,
            fit_tree_bounds,
            fit_live_bounds,
            remove_models,
            assign_instances,
            apply_level_of_detail,
            update_lod_viewers,
            select_lods,
            want_parts,
            redraw_waiting_trees,
            start_loading_parts,
            restore_lost_meshes,
            redraw_bare_trees,
            update_tree_meshes,
            copy_render_layers
        );
        let pack = timed!(app, pack_incoming_wind);
        let grow = timed!(app, fade_former_shapes);
        let rows = timed!(app, upload_winds, write_tree_rows);
        let upload = timed!(app, update_posed_trees, upload_live_trees, upload_frame);
        let light =
            (find_lights, update_material_lights::<SwayExtension>.run_if(resource_changed::<TreeLights>)).chain();
        let can_draw = resource_exists::<RenderCapabilities>;
        let forget = forget_prepared_species.before(drop_mesh_copies).in_set(WindwoodSystems::Bake);
        configure_sets(app);
        app.add_systems(
            Update,
            (
                forget.after(regrow_trees).run_if(device_is_new),
                prepare.chain().after(regrow_trees).in_set(WindwoodSystems::Bake).run_if(can_draw),
                draw.chain().in_set(WindwoodSystems::SelectLod).run_if(can_draw),
                light.after(WindwoodSystems::Bake),
                pack.after(update_wind_exposure).before(WindwoodSystems::SelectLod),
            ),
        )
        .add_systems(
            PostUpdate,
            forget_uploads.in_set(WindwoodSystems::Upload).before(upload_winds).run_if(device_is_new),
        )
        .add_systems(
            PostUpdate,
            (rows.chain(), grow.run_if(any_with_component::<FormerShape>), upload.chain())
                .chain()
                .after(VisibilitySystems::VisibilityPropagate)
                .in_set(WindwoodSystems::Upload)
                .run_if(can_draw),
        );
    }

    /// The renderer knows its device only now.
    fn finish(&self, app: &mut App) {
        require_renderer_before::<Self>(app, app.world().contains_resource::<SwayBuffers>());
        let Some(capabilities) = RenderCapabilities::of(app) else { return };
        let max_beams = u32::try_from(capabilities.max_table_bytes / size_of::<BeamRow>() as u64).unwrap_or(u32::MAX);
        app.insert_resource(InstanceTables::new(capabilities.max_poses, max_beams)).insert_resource(capabilities);
    }
}
