//! Registers the drawing of forests.

use super::{
    forget::forget_impostors,
    near_mask::{free_near_masks, update_near_masks},
    species::{ImpostorSpeciesLibrary, bake_impostor_species},
    tiles::{ForestImpostors, ImpostorTile, stream_impostor_tiles},
};
use crate::{
    forest::{
        Forest,
        cull::{ForestCulling, cull_cells, measure_species},
        diagnose::ForestGizmoPlugin,
        falling::draw_stumps,
        layers::copy_forest_layers,
    },
    plugin_checks::{has_renderer, require_renderer_before},
    removal::remove_made,
    render::{
        RenderCapabilities,
        impostors::{
            material::{ImpostorExtension, ImpostorMaterial},
            near_mask::NearMasks,
        },
        lighting::{TreeLights, find_lights, update_material_lights},
        new_device::device_is_new,
    },
    schedule::WindwoodSystems,
    timing::timed,
};
use bevy::{pbr::MaterialPlugin, prelude::*};

/// Draws the trees of [`Forest`](crate::forest::Forest)s that are too far to be entities, and hides near cells that nobody sees. Needs
/// [`TreeRenderPlugin`](crate::render::TreeRenderPlugin). Without a renderer it only culls.
pub struct ForestRenderPlugin;

impl Plugin for ForestRenderPlugin {
    fn build(&self, app: &mut App) {
        let cull = timed!(app, measure_species, cull_cells);
        app.add_plugins(ForestGizmoPlugin)
            .register_type::<ForestCulling>()
            .init_resource::<ForestCulling>()
            .add_systems(Update, copy_forest_layers.after(WindwoodSystems::Stream).before(WindwoodSystems::Bake))
            .add_systems(PostUpdate, cull.chain().in_set(WindwoodSystems::Cull));
        if !has_renderer(app) {
            return;
        }
        let can_draw = resource_exists::<RenderCapabilities>;
        app.add_plugins(MaterialPlugin::<ImpostorMaterial>::default())
            .add_observer(remove_made::<Forest, ImpostorTile, ForestImpostors>)
            .add_observer(free_near_masks)
            .init_resource::<NearMasks>()
            .init_resource::<ImpostorSpeciesLibrary>();
        let stream = timed!(app, bake_impostor_species, stream_impostor_tiles);
        let mask = timed!(app, update_near_masks);
        let light = update_material_lights::<ImpostorExtension>;
        let stream = stream.chain().after(copy_forest_layers).before(WindwoodSystems::Bake);
        let forget = forget_impostors.after(copy_forest_layers).before(bake_impostor_species);
        app.add_systems(Update, forget.run_if(device_is_new))
            .add_systems(Update, stream.run_if(can_draw))
            .add_systems(Update, draw_stumps.after(WindwoodSystems::Stream))
            .add_systems(Update, light.after(find_lights).run_if(resource_changed::<TreeLights>))
            .add_systems(PostUpdate, mask.after(WindwoodSystems::Cull).before(WindwoodSystems::Upload));
    }

    fn finish(&self, app: &mut App) {
        require_renderer_before::<Self>(app, app.world().contains_resource::<NearMasks>());
    }
}
