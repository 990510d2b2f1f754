//! Registers fires, without their drawing.

use super::components::{Fire, generate_flames, remove_flames};
use crate::schedule::{WindwoodSystems, configure_sets};
use bevy::prelude::*;

/// Grows the flames of every [`Fire`].
pub struct FirePlugin;

impl Plugin for FirePlugin {
    fn build(&self, app: &mut App) {
        configure_sets(app);
        configure_sets(app);
        app.register_type::<Fire>()
            .add_observer(remove_flames)
            .add_systems(Update, generate_flames.in_set(WindwoodSystems::Bake));
    }
}
