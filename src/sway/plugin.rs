//! Registers the motion of trees, and their drawing where there is rendering.

use super::{
    active::{ActiveSway, finish_tables, follow_wind, is_windy, rebuild_tables},
    articulated::{articulate_trees, pose_beams, pose_trees, turn_leaves},
    components::InCanopy,
    live::{
        LiveSettings, Pusher, PusherShape, Pushers, TreeImpulse, gather_pushers, has_cause, rest_live_trees,
        step_live_trees, wake_trees,
    },
    response::SwaySettings,
};
use crate::{
    plugin_checks::require_plugin,
    schedule::{WindwoodSystems, configure_sets},
    timing::timed,
    tree::TreePlugin,
    wind::{ActiveWind, WindPlugin},
};
use bevy::prelude::*;

/// The motion of trees in the wind: the response tables, and the entities of [`Articulated`](crate::tree::Articulated) trees.
pub struct SwayPlugin;

impl Plugin for SwayPlugin {
    fn build(&self, app: &mut App) {
        require_plugin::<Self, WindPlugin>(app);
        require_plugin::<Self, TreePlugin>(app);
        configure_sets(app);
        app.register_type::<SwaySettings>()
            .register_type::<InCanopy>()
            .register_type::<LiveSettings>()
            .register_type::<Pusher>()
            .register_type::<PusherShape>()
            .init_resource::<SwaySettings>()
            .init_resource::<ActiveSway>()
            .init_resource::<LiveSettings>()
            .init_resource::<Pushers>()
            .add_message::<TreeImpulse>()
            .configure_sets(PostUpdate, WindwoodSystems::Pose.run_if(is_windy));
        // Each new wind waits for its tables, so that trees and whatever else is in the wind change together.
        app.world_mut().resource_mut::<ActiveWind>().hold_incoming();
        let tables = timed!(app, rebuild_tables, finish_tables, follow_wind);
        let articulate = timed!(app, articulate_trees);
        let gather = timed!(app, gather_pushers);
        let wake = timed!(app, wake_trees);
        let live = timed!(app, step_live_trees, rest_live_trees);
        let pose_trees = timed!(app, pose_trees);
        let pose_parts = timed!(app, pose_beams, turn_leaves);
        app.add_systems(PreUpdate, tables.chain().after(WindwoodSystems::AdvanceWind))
            .add_systems(Update, articulate.after(WindwoodSystems::Bake))
            .add_systems(
                PostUpdate,
                (gather, wake.run_if(has_cause), live.chain(), pose_trees, pose_parts)
                    .chain()
                    .in_set(WindwoodSystems::Pose),
            );
    }
}
