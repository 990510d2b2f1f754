//! Registers meadows, without their drawing.

use super::grow::{GrassPatch, clear_patch, receive_meadows, sow_patches};
use crate::schedule::WindwoodSystems;
use bevy::prelude::*;

/// Lays out the blades of every [`GrassPatch`].
pub struct GrassPlugin;

impl Plugin for GrassPlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<GrassPatch>()
            .add_observer(clear_patch)
            .add_systems(Update, (sow_patches, receive_meadows).chain().in_set(WindwoodSystems::Grow));
    }
}
