//! Render layers of meshes: those of their trees or forests.

use super::components::TreeMeshes;
use crate::render::capabilities::RenderCapabilities;
use bevy::{
    camera::visibility::{NoCpuCulling, RenderLayers},
    prelude::*,
};

/// Gives a mesh that is spawned the layers of its owner, and leaves its culling to the GPU, where that does it.
pub(crate) fn insert_layers_and_culling(
    mesh: &mut EntityCommands,
    layers: Option<&RenderLayers>,
    capabilities: RenderCapabilities,
) {
    if capabilities.culls_on_gpu {
        mesh.insert(NoCpuCulling);
    }
    if let Some(layers) = layers {
        mesh.insert(layers.clone());
    }
}

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
