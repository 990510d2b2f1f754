//! Plants the cells of a tile: the plan's stems, as they are changed.

use super::{change_index::TileChanges, stem_id::StemId};
use crate::{
    cells::Cell,
    ground::Ground,
    scatter::{Planted, Planter},
};
use bevy::math::{IVec2, Vec3Swizzles};
use std::sync::Arc;

/// What the cells of one tile are planted from, on any thread.
#[derive(Clone)]
pub(super) struct CellPlanter {
    pub planter: Arc<Planter>,
    pub ground: Arc<dyn Ground>,
    /// The changes of the tile, if there are any.
    pub changes: Option<Arc<TileChanges>>,
}

impl CellPlanter {
    /// Fills `plants` with what stands in a cell of the tile, and `ids` with which stems these are.
    pub fn plant(&self, cell: IVec2, plants: &mut Vec<Planted>, ids: &mut Vec<StemId>) {
        ids.clear();
        self.planter.plant(cell, &self.ground, plants);
        match &self.changes {
            Some(changes) => changes.apply(cell, &self.planter, &self.ground, plants, ids),
            None => ids.extend(plants.iter().map(|plant| StemId::at(plant.position.xz()))),
        }
    }

    /// Packs the plants of a cell.
    pub fn pack(&self, cell: IVec2, plants: &[Planted]) -> Cell {
        Cell::pack(plants, self.planter.corner_m(cell), self.planter.cell_m())
    }

    /// What stands in a cell of the tile.
    pub fn plants(&self, cell: IVec2) -> Vec<(StemId, Planted)> {
        let (mut plants, mut ids) = (Vec::new(), Vec::new());
        self.plant(cell, &mut plants, &mut ids);
        ids.into_iter().zip(plants).collect()
    }
}
