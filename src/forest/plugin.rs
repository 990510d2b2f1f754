//! Registers forests.

use super::{
    cells::{begin_forests, plant_cells},
    components::{Forest, ForestSettings},
    loader::ForestLoader,
    near::raise_trees,
    serve::{articulate_near, give_winds},
};
use crate::{
    scatter::ForestPlan, schedule::WindwoodSystems, timing::timed, tree::TreePlugin, viewpoint::give_cameras_viewpoints,
};
use bevy::prelude::*;

/// Forests that grow from plans, with or without drawing. Needs [`TreePlugin`].
pub struct ForestPlugin;

impl Plugin for ForestPlugin {
    fn build(&self, app: &mut App) {
        debug_assert!(app.is_plugin_added::<TreePlugin>(), "forests are made of trees");
        give_cameras_viewpoints(app);
        app.init_asset::<ForestPlan>()
            .init_asset_loader::<ForestLoader>()
            .register_asset_reflect::<ForestPlan>()
            .register_type::<Forest>()
            .register_type::<ForestSettings>();
        let stream = timed!(app, begin_forests, plant_cells, raise_trees, give_winds, articulate_near);
        app.add_systems(Update, stream.chain().before(WindwoodSystems::Grow));
    }
}
