//! Gives meshes of trees the render layers of their trees.

use super::components::TreeMeshes;
use bevy::{camera::visibility::RenderLayers, prelude::*};

/// Copies render layers that were changed or removed.
pub(crate) fn copy_render_layers(
    mut commands: Commands,
    changed: Query<(&RenderLayers, &TreeMeshes), Changed<RenderLayers>>,
    mut removed: RemovedComponents<RenderLayers>,
    trees: Query<&TreeMeshes, Without<RenderLayers>>,
) {
    for (layers, meshes) in &changed {
        meshes.iter().for_each(|mesh| {
            commands.entity(mesh).insert(layers.clone());
        });
    }
    for meshes in removed.read().filter_map(|tree| trees.get(tree).ok()) {
        meshes.iter().for_each(|mesh| {
            commands.entity(mesh).remove::<RenderLayers>();
        });
    }
}
