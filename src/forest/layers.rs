//! Render layers of a forest: its trees and its impostors have them too.

use super::{cells::ForestCells, impostors::ForestImpostors};
use bevy::{camera::visibility::RenderLayers, prelude::*};

/// What a forest has of its own that its layers go to.
type Parts = (&'static ForestCells, Option<&'static ForestImpostors>);

/// Copies render layers that were changed on a forest, or removed, to all of its trees and impostors. Those that come later have them from
/// the start.
pub(super) fn copy_forest_layers(
    mut commands: Commands,
    changed: Query<(&RenderLayers, Parts), Changed<RenderLayers>>,
    mut removed: RemovedComponents<RenderLayers>,
    without: Query<Parts, Without<RenderLayers>>,
) {
    for (layers, (cells, impostors)) in &changed {
        for part in parts(cells, impostors) {
            commands.entity(part).try_insert(layers.clone());
        }
    }
    for (cells, impostors) in removed.read().filter_map(|forest| without.get(forest).ok()) {
        for part in parts(cells, impostors) {
            commands.entity(part).try_remove::<RenderLayers>();
        }
    }
}

fn parts(cells: &ForestCells, impostors: Option<&ForestImpostors>) -> impl Iterator<Item = Entity> {
    cells.near.trees().map(|tree| tree.entity).chain(impostors.into_iter().flat_map(ForestImpostors::meshes))
}
