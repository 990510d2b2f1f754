//! Removes what a component of ours has made, when it goes.

use bevy::prelude::*;

/// An observer: when an `Owner` is removed, the children of its entity that are `Part`s are despawned, and `Made` is taken off it.
pub(crate) fn remove_made<Owner: Component, Part: Component, Made: Bundle>(
    removed: On<Remove<Owner>>,
    mut commands: Commands,
    children: Query<&Children>,
    parts: Query<(), With<Part>>,
) {
    for child in children.get(removed.entity).into_iter().flatten().filter(|child| parts.contains(**child)) {
        commands.entity(*child).try_despawn();
    }
    if let Ok(mut owner) = commands.get_entity(removed.entity) {
        owner.try_remove::<Made>();
    }
}
