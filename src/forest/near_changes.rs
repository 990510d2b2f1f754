//! Changes among near trees: trees that are felled or others than they were, and what is told of all that come and go.

use super::{
    messages::{TreeEntered, TreeLeft},
    near::{CellTask, NearTrees, Planting},
    near_cell::{NearEvent, NearTree},
    planted_tile::PlantedTile,
    reach::tile_of,
    stem_id::StemId,
};
use crate::{scatter::Planted, tree::Species};
use bevy::prelude::*;
use std::sync::Arc;

impl NearTrees {
    /// Whether a cell stands here after the plan of now.
    pub fn has(&self, cell: IVec2) -> bool {
        self.cells.get(&cell).is_some_and(|there| !there.is_outdated)
    }

    /// Takes a tree that was felled out of its cell.
    pub fn fell(&mut self, cell: IVec2, id: StemId) -> Option<NearTree> {
        self.cells.get_mut(&cell)?.take(id)
    }

    /// Makes a cell that stands here what is planted there now. Trees that are the same stay.
    pub fn renew(&mut self, cell: IVec2, planted: Vec<(StemId, Planted)>, species: &[Handle<Species>]) {
        let Some(mut before) = self.cells.remove(&cell) else { return };
        let was_drawn = before.is_drawn;
        let canopies = before.canopies.take();
        let mut there = before.planted_anew(planted, species);
        // All of its trees but those that were changed are still drawn: no impostors have to stand for them.
        there.is_drawn |= was_drawn;
        there.canopies = canopies;
        if !there.planted.is_empty() && !self.unspawned.contains(&cell) {
            self.unspawned.push(cell);
        }
        self.cells.insert(cell, there);
        if !self.without_canopies.contains(&cell) {
            self.without_canopies.push(cell);
        }
        self.changes += 1;
        self.drawn_changes += 1;
    }

    /// Takes what is known of a tile for out of date: cells that are awaited from it, or from a task that has begun, are planted again.
    pub fn replant_awaited(&mut self, tile: IVec2, cell: IVec2, plant: impl Fn(IVec2) -> Option<CellTask>) {
        let had_tile = self.tiles.remove(&tile).is_some();
        for (other, source) in &mut self.planting {
            let is_out_of_date = match source {
                Planting::Alone(_) => *other == cell,
                // Its tile was there, and comes again only if it has to be planted again.
                Planting::Tile => had_tile && tile_of(*other, self.tile_cells) == tile,
            };
            if is_out_of_date {
                *source = plant(*other).map_or(Planting::Tile, Planting::Alone);
            }
        }
    }

    /// Takes cells of a tile that was planted again.
    pub fn renew_cells(&mut self, cells: &[IVec2], tile: &Arc<PlantedTile>, species: &[Handle<Species>]) {
        for cell in cells.iter().filter(|cell| self.has(**cell)).copied().collect::<Vec<_>>() {
            self.renew(cell, tile.stems(cell), species);
        }
    }

    /// Tells of trees that have come and gone.
    pub fn tell(
        &mut self,
        forest: Entity,
        entered: &mut MessageWriter<TreeEntered>,
        left: &mut MessageWriter<TreeLeft>,
    ) {
        for event in self.events.drain(..) {
            let (NearEvent::Entered(tree) | NearEvent::Left(tree)) = &event;
            let &NearTree { id, plant: Planted { position: place, .. }, species, entity: tree, .. } = tree;
            match event {
                NearEvent::Entered(_) => drop(entered.write(TreeEntered { forest, tree, id, place, species })),
                NearEvent::Left(_) => drop(left.write(TreeLeft { forest, tree, id, place, species })),
            }
        }
    }
}
