//! Colliders for `avian3d`.

use crate::query::components::TreeColliders;
use avian3d::prelude::{Collider, RigidBody};
use bevy::prelude::*;

/// Makes every tree with [`TreeColliders`] a static body of `avian3d`. Its own plugins are the game's to add.
pub struct TreeAvianPlugin;

impl Plugin for TreeAvianPlugin {
    fn build(&self, app: &mut App) {
        app.add_observer(build_collider).add_observer(take_collider);
    }
}

fn build_collider(given: On<Insert<TreeColliders>>, mut commands: Commands, trees: Query<&TreeColliders>) {
    let Ok(TreeColliders { capsules }) = trees.get(given.entity) else { return };
    let part = |capsule: &crate::tree::body::TreeCapsule| {
        (Vec3::ZERO, Quat::IDENTITY, Collider::capsule_endpoints(capsule.radius_m, capsule.a, capsule.b))
    };
    let parts: Vec<_> = capsules.iter().map(part).collect();
    let Ok(mut tree) = commands.get_entity(given.entity) else { return };
    if parts.is_empty() {
        tree.try_remove::<Collider>();
    } else {
        tree.insert_if_new(RigidBody::Static).try_insert(Collider::compound(parts));
    }
}

fn take_collider(taken: On<Remove<TreeColliders>>, mut commands: Commands) {
    if let Ok(mut tree) = commands.get_entity(taken.entity) {
        tree.try_remove::<(RigidBody, Collider)>();
    }
}
