//! Registers the wind: the [`Wind`] settings, the clock, the field that is built in the background, the wind cells.

use super::{
    components::{WindCell, sample_wind_cells},
    ecs::{
        active::{ActiveWind, Wind, fade_fields, finish_field_build, start_field_build},
        clock::{WindClock, advance_clock, note_jumps},
        sources::{WindSource, WindSources, advance_sources},
    },
};
use crate::{
    plugin_checks::{require_bevy_basics, require_once},
    schedule::{WindwoodSystems, configure_sets},
    timing::timed,
};
use bevy::prelude::*;

/// The wind, without trees: [`Wind`], [`WindClock`], [`ActiveWind`], [`WindSource`]s and [`WindCell`]s.
///
/// It needs the task pools and the time of Bevy's `MinimalPlugins`.
pub struct WindPlugin;

impl Plugin for WindPlugin {
    fn build(&self, app: &mut App) {
        require_once::<Self>(app);
        configure_sets(app);
        app.register_type::<Wind>()
            .register_type::<WindCell>()
            .register_type::<WindSource>()
            .register_type::<WindClock>()
            .init_resource::<Wind>()
            .init_resource::<WindClock>()
            .init_resource::<ActiveWind>()
            .init_resource::<WindSources>();
        let advance = timed!(
            app,
            advance_clock,
            start_field_build,
            finish_field_build,
            fade_fields,
            advance_sources,
            sample_wind_cells
        );
        let jumps = timed!(app, note_jumps);
        app.add_systems(PreUpdate, advance.chain().in_set(WindwoodSystems::AdvanceWind))
            .add_systems(PostUpdate, jumps.before(WindwoodSystems::Pose));
    }

    fn finish(&self, app: &mut App) {
        require_bevy_basics::<Self>(app);
    }

    /// This plugin is the first of both groups. A second one is refused in `build`, with a message that names the groups.
    fn is_unique(&self) -> bool {
        false
    }
}
