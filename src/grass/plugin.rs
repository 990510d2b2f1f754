//! Registers meadows, without their drawing.

use super::components::{GrassPatch, finish_meadow_layouts, remove_meadow, start_meadow_layouts};
use crate::schedule::{WindwoodSystems, configure_sets};
use bevy::prelude::*;

/// Lays out the blades of every [`GrassPatch`].
pub struct GrassPlugin;

impl Plugin for GrassPlugin {
    fn build(&self, app: &mut App) {
        configure_sets(app);
        configure_sets(app);
        app.register_type::<GrassPatch>()
            .add_observer(remove_meadow)
            .add_systems(Update, (start_meadow_layouts, finish_meadow_layouts).chain().in_set(WindwoodSystems::Bake));
    }
}
