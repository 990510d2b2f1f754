//! Registers the drawing of far trees.

use super::{
    blocks::stream_far,
    looks::{FarLooks, bake_far_looks},
    material::{FarExtension, FarMaterial},
    near::{NearCells, tell_near_cells},
};
use crate::{
    forest::{
        cells::plant_cells,
        cull::{ForestCulling, cull_cells, measure_species},
        diagnose::ForestGizmoPlugin,
    },
    schedule::WindwoodSystems,
    sway::{DrawPath, StandTables, TreeLights, relight},
    timing::timed,
};
use bevy::{camera::visibility::VisibilitySystems, pbr::MaterialPlugin, prelude::*, render::RenderApp};

/// Draws the trees of [`Forest`](crate::forest::Forest)s that are too far to be entities, and hides near ones that nobody
/// sees. Needs [`SwayDrawPlugin`](crate::sway::SwayDrawPlugin). Without a renderer it only culls.
pub struct ForestDrawPlugin;

impl Plugin for ForestDrawPlugin {
    fn build(&self, app: &mut App) {
        let cull = timed!(app, measure_species, cull_cells);
        app.add_plugins(ForestGizmoPlugin)
            .register_type::<ForestCulling>()
            .init_resource::<ForestCulling>()
            .add_systems(
                PostUpdate,
                cull.chain().after(VisibilitySystems::UpdateFrusta).before(VisibilitySystems::VisibilityPropagate),
            );
        if app.get_sub_app(RenderApp).is_none() {
            return;
        }
        let can_draw = resource_exists::<DrawPath>.and_then(resource_exists::<StandTables>);
        app.add_plugins(MaterialPlugin::<FarMaterial>::default())
            .init_resource::<NearCells>()
            .init_resource::<FarLooks>();
        let stream = timed!(app, bake_far_looks, stream_far);
        let tell = timed!(app, tell_near_cells);
        app.add_systems(Update, stream.chain().after(plant_cells).run_if(can_draw))
            .add_systems(Update, relight::<FarExtension>.run_if(resource_changed::<TreeLights>))
            .add_systems(PostUpdate, tell.before(WindwoodSystems::Upload));
    }
}
