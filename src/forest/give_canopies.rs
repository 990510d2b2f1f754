//! Gives the trees of near cells the stand that they stand in.

use super::{cell_canopies::CellCanopies, cells::ForestCells};
use crate::sway::InCanopy;
use bevy::prelude::*;

/// Gives the trees of near cells their stand, when their forest's is ready.
pub(super) fn give_canopies(mut commands: Commands, mut forests: Query<&mut ForestCells>) {
    for mut forest in &mut forests {
        let Some(stands) = forest.stand.get().cloned() else { continue };
        let cell_m = forest.planter().cell_m();
        let ForestCells { near, stand, .. } = forest.bypass_change_detection();
        near.give_canopies(
            stand.generations(),
            |cell| CellCanopies::spawn(stands.clone(), stands.own.planter.corner_m(cell), cell_m),
            |tree, canopy| {
                commands.entity(tree).try_insert(InCanopy(canopy));
            },
        );
    }
}
