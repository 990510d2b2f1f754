//! Registers the motion of trees, and their drawing where there is rendering.

use super::{
    active::{ActiveSway, fade_tables, is_windy, rebuild_tables},
    articulated::{articulate_trees, pose_beams, pose_trees, turn_leaves},
    response::SwaySettings,
};
use crate::schedule::WindwoodSystems;
use bevy::prelude::*;

/// The motion of trees in the wind: the response tables, and the entities of [`Articulated`](crate::tree::Articulated) trees.
pub struct SwayPlugin;

impl Plugin for SwayPlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<SwaySettings>()
            .init_resource::<SwaySettings>()
            .init_resource::<ActiveSway>()
            .configure_sets(PostUpdate, WindwoodSystems::Pose.before(TransformSystems::Propagate))
            .add_systems(PreUpdate, (rebuild_tables, fade_tables).chain().after(WindwoodSystems::AdvanceWind))
            .add_systems(Update, articulate_trees.after(WindwoodSystems::Grow))
            .add_systems(
                PostUpdate,
                (pose_trees, (pose_beams, turn_leaves)).chain().in_set(WindwoodSystems::Pose).run_if(is_windy),
            );
    }
}
