//! What impostors need of the cells of a forest.

use super::{
    cells::ForestCells, known_tiles::KnownTile, planted_tile::PlantedTile, reach::tile_stream,
    tree_impostors::TreeImpostors,
};
use crate::render::impostors::near_mask::MaskRange;
use bevy::math::IVec2;
use std::sync::Arc;

impl ForestCells {
    /// What tells its trees of their impostors; none where there are no impostors.
    pub(super) fn impostors(&self) -> Option<TreeImpostors> {
        let from_m = self.impostors_from_m;
        (self.settings.far_to_m > 0.0).then(|| TreeImpostors { from_m, sizes: self.impostor_sizes.clone() })
    }

    /// The distances of its impostors.
    pub(super) fn mask_range(&self) -> MaskRange {
        let (cell_m, far_to_m) = (self.planter.cell_m(), self.settings.far_to_m);
        MaskRange { cell_m, far_to_m, from_m: self.impostors_from_m }
    }

    /// The generation since which tiles and numbers of species are the same.
    pub(super) fn tiles_since(&self) -> u64 {
        self.tiles_since
    }

    /// Tiles that were dropped in this frame.
    pub(super) fn dropped_tiles(&self) -> &[IVec2] {
        &self.orders.drop
    }

    /// Whether a tile is planted, be it after the plan before.
    pub(super) fn has_tile(&self, tile: IVec2) -> bool {
        self.tiles.contains_key(&tile)
    }

    /// Keeps every tile from now on until impostors are made of it, or keeps none any more.
    pub(super) fn keep_tiles_for_impostors(&mut self, keeps: bool) {
        if keeps != self.for_impostors.is_some() {
            self.for_impostors = keeps.then(Vec::new);
        }
    }

    /// Whether there are tiles that impostors have still to be made of.
    pub(super) fn has_tiles_for_impostors(&self) -> bool {
        self.for_impostors.as_ref().is_some_and(|tiles| !tiles.is_empty())
    }

    /// Takes so many of the tiles that impostors have still to be made of, the first ones.
    pub(super) fn take_tiles_for_impostors(&mut self, most: usize) -> Vec<(IVec2, Arc<PlantedTile>)> {
        let Some(tiles) = &mut self.for_impostors else { return Vec::new() };
        tiles.drain(..most.min(tiles.len())).collect()
    }

    /// Where not all tiles are kept that impostors have to be made of, all are planted again.
    pub(super) fn replant_lost_tiles(&mut self) {
        if self.for_impostors.as_ref().is_none_or(|kept| kept.len() < self.tiles.len()) {
            self.replant();
        }
    }

    /// Has all tiles planted again, and takes them for others than they were.
    pub(super) fn replant(&mut self) {
        if let Ok(stream) = tile_stream(&self.planter, &self.settings, self.tile_cells) {
            self.stream = stream;
            self.planting.clear();
            self.replanting.clear();
            self.outdated = self.tiles.len();
            self.tiles.values_mut().for_each(|tile| *tile = KnownTile { fingerprint: None, is_outdated: true });
        }
    }
}
