//! Registers what games ask of trees and wind.

use super::{
    components::{TreeColliderSettings, WindListener},
    ecs::{
        colliders::give_colliders,
        listen::tell_listeners,
        rays::{PosedTrees, forget_poses},
    },
};
use crate::{
    plugin_checks::require_plugin,
    schedule::{WindwoodSystems, configure_sets},
    sway::SwayPlugin,
    timing::timed,
    tree::track_trees,
    viewpoint::give_cameras_viewpoints,
};
use bevy::prelude::*;

/// Rays against trees, colliders, and the wind where a game asks for it. Needs [`SwayPlugin`].
pub struct TreeQueryPlugin;

impl Plugin for TreeQueryPlugin {
    fn build(&self, app: &mut App) {
        require_plugin::<Self, SwayPlugin>(app);
        configure_sets(app);
        give_cameras_viewpoints(app);
        app.register_type::<WindListener>()
            .register_type::<TreeColliderSettings>()
            .init_resource::<TreeColliderSettings>()
            .init_resource::<PosedTrees>();
        let query = timed!(app, forget_poses, tell_listeners);
        let give = timed!(app, give_colliders);
        app.add_systems(PreUpdate, forget_poses.after(WindwoodSystems::AdvanceWind))
            .add_systems(Update, give.in_set(WindwoodSystems::Stream))
            .add_systems(PostUpdate, query.chain().after(track_trees).in_set(WindwoodSystems::Query));
    }
}
