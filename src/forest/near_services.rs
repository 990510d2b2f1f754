//! What near cells have beside trees: a wind of their own, and trees whose parts are entities.

use super::{cells::ForestCells, components::ForestCell, reach::HYSTERESIS};
use crate::{
    tree::{Articulated, Tree},
    viewpoint::Viewpoints,
    wind::WindCell,
};
use bevy::prelude::*;

/// Height above ground of the wind of a cell, m: where meteorologists measure it.
const WIND_AT_M: f32 = 10.0;

/// Gives near cells that have come a [`WindCell`] in their middle, where the settings ask for it.
pub(super) fn spawn_wind_cells(
    mut commands: Commands,
    forests: Query<&ForestCells>,
    added: Query<(Entity, &ForestCell, &ChildOf), Added<ForestCell>>,
) {
    for (entity, ForestCell(cell), forest) in &added {
        let Ok(forest) = forests.get(forest.parent()) else { continue };
        let Some(ground_m) = forest.near.ground_m(*cell).filter(|_| forest.settings().wind_cells) else { continue };
        let middle = (cell.as_vec2() + 0.5) * forest.planter().cell_m();
        let place = Transform::from_xyz(middle.x, ground_m + WIND_AT_M, middle.y);
        commands.spawn((WindCell::above(ground_m), place, ChildOf(entity)));
    }
}

/// Articulates the trees of cells that viewers come near to, and no longer those of cells that they leave.
pub(super) fn articulate_near_trees(
    mut commands: Commands,
    viewpoints: Viewpoints,
    mut eyes: Local<Vec<Vec2>>,
    mut forests: Query<&mut ForestCells>,
    children: Query<&Children>,
    trees: Query<(), With<Tree>>,
) {
    eyes.clear();
    eyes.extend(viewpoints.iter().map(Vec3::xz));
    for mut forest in &mut forests {
        let to_m = forest.settings().articulated_to_m;
        if to_m <= 0.0 || eyes.is_empty() {
            continue;
        }
        forest.bypass_change_detection().near.articulate(&eyes, [to_m, HYSTERESIS * to_m], |cell, articulated| {
            for tree in children.get(cell).into_iter().flatten().filter(|tree| trees.contains(**tree)) {
                let mut tree = commands.entity(*tree);
                if articulated {
                    tree.insert(Articulated::default());
                } else {
                    tree.remove::<Articulated>();
                }
            }
        });
    }
}
