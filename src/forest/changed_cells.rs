//! The cells of a forest take its changes over: near ones at once, the others when their tile has been planted again in the background.

use super::{
    cells::{ForestCells, Replanting},
    change_index::ChangeIndex,
    changes::ForestChanges,
    journal::{ChangedStem, Journal},
    near_cell::NearTree,
    reach::tile_of,
};
use crate::{background::take_finished, scatter::Stem, tree::Species};
use bevy::{platform::collections::HashSet, prelude::*};

/// Tiles that are planted again at once, at most.
const MOST_REPLANTED: usize = 4;
/// A stem in the store is within so many steps of its rounding from where it stands.
const ROUNDING_STEPS: f32 = 2.0;

/// A stem that was felled.
pub(super) struct FelledStem {
    pub stem: ChangedStem,
    pub place: Vec3,
    pub species: AssetId<Species>,
    /// The tree, if it stood as an entity.
    pub tree: Option<NearTree>,
}

impl ForestCells {
    /// Takes changes over. Returns the stems that were felled, of those that are known.
    pub(super) fn apply(&mut self, changes: &ForestChanges, journal: Journal) -> Vec<FelledStem> {
        let (mut felled, tile_cells) = (Vec::new(), self.tile_cells());
        let cells = match (journal, &mut self.changes) {
            (Journal::Stems(stems), Some(index)) => {
                let mut unknown = HashSet::default();
                let planter = &self.planter;
                let mut update =
                    |stem: &ChangedStem| index.update(stem.id, stem.place_m, changes, planter, &mut unknown);
                let mut cells: Vec<IVec2> = stems.iter().map(&mut update).collect();
                let was_felled = stems.into_iter().zip(&cells).filter(|(stem, _)| stem.was_felled);
                let was_felled: Vec<(ChangedStem, IVec2)> = was_felled.map(|(stem, cell)| (stem, *cell)).collect();
                felled.extend(was_felled.into_iter().filter_map(|(stem, cell)| self.fell(stem, cell)));
                cells.sort_unstable_by_key(|cell| (cell.y, cell.x));
                cells.dedup();
                cells
            }
            (_, before) => {
                let index = ChangeIndex::of(changes, &self.planter, tile_cells);
                let cells = before.as_ref().map(|before| index.cells_that_differ(before, &self.planter));
                if !index.is_empty() {
                    self.stand.note_changes();
                }
                *before = Some(index);
                // Where there were none, nothing has been planted yet, or all is planted anew after the plan has changed.
                cells.unwrap_or_default()
            }
        };
        self.stand.note_changed_cells(&cells);
        let mut at_once = self.settings.cells_at_once;
        for cell in cells {
            self.change_cell(cell, &mut at_once);
        }
        felled
    }

    /// Has a cell that was changed planted again: `at_once` if it is near and so many are left.
    fn change_cell(&mut self, cell: IVec2, at_once: &mut u32) {
        let tile = tile_of(cell, self.tile_cells());
        let is_done = *at_once > 0 && self.near.has(cell);
        if is_done {
            *at_once -= 1;
            let planter = self.cell_planter(tile);
            let plants = planter.plants(cell);
            if self.store.contains(cell) {
                let planted: Vec<_> = plants.iter().map(|(_, plant)| *plant).collect();
                self.store.insert(cell, planter.pack(cell, &planted));
            }
            self.near.renew(cell, plants, &self.species);
        }
        if let Some(known) = self.tiles.get_mut(&tile) {
            known.fingerprint = None;
        }
        let (near, _, _, plant) = self.parts();
        near.replant_awaited(tile, cell, plant);
        // What is under way is as it was before.
        let under_way = self.replanting.iter_mut().filter(|(other, _)| other.tile == tile);
        under_way.for_each(|(other, _)| other.cells.retain(|other| *other != cell));
        let is_under_way = self.is_being_planted(tile);
        if !is_done || is_under_way || self.has_impostors() {
            let cells = self.changed_tiles.entry((tile.y, tile.x)).or_default();
            if (!is_done || is_under_way) && !cells.contains(&cell) {
                cells.push(cell);
            }
        }
    }

    /// Takes a stem that was felled out of the near trees. None if it is not known.
    fn fell(&mut self, stem: ChangedStem, cell: IVec2) -> Option<FelledStem> {
        if let Some(tree) = self.near.fell(cell, stem.id) {
            return Some(FelledStem { stem, place: tree.plant.position, species: tree.species, tree: Some(tree) });
        }
        let known = self.known_stem(cell, stem.place_m)?;
        let species = self.species.get(usize::from(known.species))?.id();
        let place = Vec3::new(stem.place_m.x, known.position.y, stem.place_m.y);
        Some(FelledStem { stem, place, species, tree: None })
    }

    /// The stem of the store that stands at a place of a cell.
    fn known_stem(&self, cell: IVec2, place_m: Vec2) -> Option<Stem> {
        let rounding_m = self.rounding_m(place_m);
        self.store.stems(cell).find(|stem| stem.position.xz().distance(place_m) <= rounding_m)
    }

    /// So far a stem of the store may be from where it stands, m.
    pub(super) fn rounding_m(&self, place_m: Vec2) -> f32 {
        ROUNDING_STEPS * self.store.cell_m() / f32::from(u16::MAX) + place_m.abs().max_element() * f32::EPSILON
    }

    /// Whether impostors are made of its tiles.
    fn has_impostors(&self) -> bool {
        #[cfg(feature = "render")]
        let has_impostors = self.for_impostors.is_some();
        #[cfg(not(feature = "render"))]
        let has_impostors = false;
        has_impostors
    }

    /// Whether a tile is being planted, perhaps as it was before its last change.
    fn is_being_planted(&self, tile: IVec2) -> bool {
        self.planting.iter().any(|(other, _)| *other == tile)
            || self.replanting.iter().any(|(other, _)| other.tile == tile)
    }

    /// Takes over changed tiles that were planted again, and has the next ones planted.
    pub(super) fn replant_changed_tiles(&mut self) {
        for (Replanting { tile, cells }, packed) in take_finished(&mut self.replanting) {
            let packed = match packed {
                Ok(packed) => packed,
                Err(panic) => {
                    self.tell(&panic);
                    continue;
                }
            };
            if self.tiles.get(&tile).is_some_and(|known| !known.is_outdated) {
                let stems = packed.0.clone();
                self.take_tile(tile, packed);
                self.near.renew_cells(&cells, &stems, &self.species);
            }
        }
        let mut next = self.changed_tiles.keys().next().copied();
        while let Some(key) = next.filter(|_| self.replanting.len() < MOST_REPLANTED) {
            next = self.changed_tiles.range((key.0, key.1.saturating_add(1))..).map(|(key, _)| *key).next();
            let tile = IVec2::new(key.1, key.0);
            if self.is_being_planted(tile) {
                continue;
            }
            // One that is not known, or is of the plan before, will be planted with its changes.
            let is_known = self.tiles.get(&tile).is_some_and(|known| !known.is_outdated);
            let cells = self.changed_tiles.remove(&key).unwrap_or_default();
            if is_known {
                let task = self.plant_tile(tile);
                self.replanting.push((Replanting { tile, cells }, task));
            }
        }
    }

    /// Whether all changes that were taken over show everywhere, near and far, and the wind among the trees has followed them: not before
    /// that wind is known, for which the species have to be loaded and measured.
    #[must_use]
    pub fn is_up_to_date(&self) -> bool {
        let is_planted = self.changed_tiles.is_empty() && self.replanting.is_empty();
        is_planted && self.stand.get().is_some() && !self.stand.is_due() && self.near.has_canopies()
    }
}
