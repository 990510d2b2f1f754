//! Registers fires, without their drawing.

use super::burn::{Fire, kindle_fires, put_out_fire};
use crate::schedule::WindwoodSystems;
use bevy::prelude::*;

/// Grows the flames of every [`Fire`].
pub struct FirePlugin;

impl Plugin for FirePlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<Fire>()
            .add_observer(put_out_fire)
            .add_systems(Update, kindle_fires.in_set(WindwoodSystems::Grow));
    }
}
