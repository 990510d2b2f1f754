//! Registers meadows, without their drawing.

use super::{
    components::{GrassPatch, finish_meadow_layouts, remove_meadow, start_meadow_layouts},
    ecs::{GrassField, apply_grass_fields, move_grass_fields, remove_grass_field},
};
use crate::{
    schedule::{WindwoodSystems, configure_sets},
    viewpoint::give_cameras_viewpoints,
};
use bevy::prelude::*;

/// Lays out the blades of every [`GrassPatch`], and keeps patches of every [`GrassField`] about the viewers.
pub struct GrassPlugin;

impl Plugin for GrassPlugin {
    fn build(&self, app: &mut App) {
        configure_sets(app);
        give_cameras_viewpoints(app);
        app.register_type::<GrassPatch>()
            .register_type::<GrassField>()
            .add_observer(remove_meadow)
            .add_observer(remove_grass_field)
            .add_systems(
                Update,
                (apply_grass_fields, move_grass_fields, start_meadow_layouts, finish_meadow_layouts)
                    .chain()
                    .in_set(WindwoodSystems::Bake),
            );
    }
}
