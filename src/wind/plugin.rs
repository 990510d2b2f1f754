//! Registers the wind: the [`Wind`] settings, the clock, the field that is rebuilt in the background, the wind cells.

use super::{
    cells::{WindCell, sample_wind_cells},
    clock::{WindClock, advance_clock},
    current::{ActiveWind, Wind, fade_field, rebuild_field, receive_field},
};
use crate::{schedule::WindwoodSystems, timing::timed};
use bevy::prelude::*;

/// The wind, without trees: [`Wind`], [`WindClock`], [`ActiveWind`] and [`WindCell`]s.
pub struct WindPlugin;

impl Plugin for WindPlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<Wind>()
            .register_type::<WindCell>()
            .register_type::<WindClock>()
            .init_resource::<Wind>()
            .init_resource::<WindClock>()
            .insert_resource(ActiveWind::calm());
        let advance = timed!(app, advance_clock, rebuild_field, receive_field, fade_field, sample_wind_cells);
        app.add_systems(PreUpdate, advance.chain().in_set(WindwoodSystems::AdvanceWind));
    }
}
