//! Removes the meshes of trees that go, and restores meshes that something else has despawned.

use super::{
    components::{DrawnTree, TreeMeshOf, TreeMeshes},
    growth::{FormerMeshes, FormerShape},
};
use crate::{
    render::{instances::components::TreeInstance, lod::thresholds::LodSelection},
    tree::Tree,
};
use bevy::prelude::*;

/// Trees that have lost meshes since the last frame.
#[derive(Resource, Default)]
pub(crate) struct LostMeshes(Vec<Entity>);

/// Removes all that rendering has put on a tree, when its [`Tree`] is removed.
pub(crate) fn remove_tree_meshes(removed: On<Remove<Tree>>, mut commands: Commands) {
    // Where the tree itself is despawned, its meshes are too.
    if let Ok(mut tree) = commands.get_entity(removed.entity) {
        tree.queue_silenced(remove_all_drawn);
    }
}

pub(crate) fn remove_all_drawn(mut tree: EntityWorldMut) {
    tree.despawn_related::<FormerMeshes>().despawn_related::<TreeMeshes>();
    tree.remove::<(FormerShape, TreeInstance, LodSelection, DrawnTree)>();
}

/// Notes trees that lose a mesh.
pub(crate) fn note_lost_mesh(
    removed: On<Discard<TreeMeshOf>>,
    meshes: Query<&TreeMeshOf>,
    mut lost: ResMut<LostMeshes>,
) {
    if let Ok(TreeMeshOf(tree)) = meshes.get(removed.entity) {
        lost.0.push(*tree);
    }
}

/// Has the meshes of trees made anew that have fewer than were made, as when a game despawns all children of a tree.
pub(crate) fn restore_lost_meshes(
    mut lost: ResMut<LostMeshes>,
    mut trees: Query<(&mut DrawnTree, Option<&TreeMeshes>)>,
) {
    for tree in lost.bypass_change_detection().0.drain(..) {
        let Ok((mut drawn, meshes)) = trees.get_mut(tree) else { continue };
        if drawn.selection.is_some() && meshes.map_or(0, TreeMeshes::len) < usize::from(drawn.mesh_count) {
            drawn.selection = None;
        }
    }
}
