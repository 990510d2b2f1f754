//! The changes of a forest by place: what cells are planted after, tile by tile.

use super::{
    changes::{ForestChanges, PlantedStem, StemChange},
    reach::tile_of,
    stem_id::StemId,
};
use crate::{
    ground::Ground,
    scatter::{Planted, Planter},
};
use bevy::{
    log::warn,
    math::{IVec2, Vec2, Vec3, Vec3Swizzles},
    platform::collections::{HashMap, HashSet},
};
use std::{collections::BTreeMap, sync::Arc};

/// The changes of a tile. A task in the background keeps those that it has begun with.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct TileChanges {
    /// Stems of the plan that are others.
    stems: BTreeMap<StemId, AlteredStem>,
    /// Stems beside the plan's, by row and column of their cell.
    added: BTreeMap<(i32, i32, StemId), AddedStem>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum AlteredStem {
    Felled,
    Altered { age_years: Option<f32>, species: Option<u8> },
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct AddedStem {
    place_m: Vec2,
    age_years: f32,
    species: u8,
}

impl TileChanges {
    /// Makes a cell's plants of the plan those that stand there, and tells their ids.
    pub fn apply(
        &self,
        cell: IVec2,
        planter: &Planter,
        ground: &impl Ground,
        plants: &mut Vec<Planted>,
        ids: &mut Vec<StemId>,
    ) {
        plants.retain_mut(|plant| match self.stems.get(&StemId::at(plant.position.xz())) {
            Some(AlteredStem::Felled) => false,
            Some(AlteredStem::Altered { age_years, species }) => {
                let (species, age_years) = (species.unwrap_or(plant.species), age_years.unwrap_or(plant.age_years));
                *plant = planter.altered(*plant, species, age_years);
                true
            }
            None => true,
        });
        ids.extend(plants.iter().map(|plant| StemId::at(plant.position.xz())));
        let here = (cell.y, cell.x, StemId::LEAST)..=(cell.y, cell.x, StemId::GREATEST);
        for ((.., id), added) in self.added.range(here) {
            let height_m = ground.height_m(added.place_m.as_dvec2()) as f32;
            let position = Vec3::new(added.place_m.x, height_m, added.place_m.y);
            let plant = planter.plant_one(position, added.species, added.age_years, id.to_bits());
            if let Some(plant) = plant.filter(|_| height_m.is_finite()) {
                plants.push(plant);
                ids.push(*id);
            }
        }
    }

    /// The cells in which stems of the plan are felled, and how many.
    pub fn felled_by_cell(&self, planter: &Planter) -> HashMap<IVec2, u32> {
        let mut cells = HashMap::default();
        let felled = self.stems.iter().filter(|(_, stem)| **stem == AlteredStem::Felled);
        for place_m in felled.filter_map(|(id, _)| id.place_m()) {
            *cells.entry(planter.cell_at(place_m)).or_default() += 1;
        }
        cells
    }

    /// Cell, number of the species and age in years of each stem that the game has planted.
    pub fn planted(&self) -> impl Iterator<Item = (IVec2, u8, f32)> {
        self.added.iter().map(|((row, column, _), stem)| (IVec2::new(*column, *row), stem.species, stem.age_years))
    }

    fn is_empty(&self) -> bool {
        self.stems.is_empty() && self.added.is_empty()
    }

    /// Visits the cells in which it differs from the changes of the same tile at another time, some of them more than once.
    fn visit_differences(&self, other: &Self, planter: &Planter, mut visit: impl FnMut(IVec2)) {
        for id in self.stems.keys().chain(other.stems.keys()).filter(|id| self.stems.get(id) != other.stems.get(id)) {
            visit(planter.cell_at(id.place_m().unwrap_or_default()));
        }
        for key in self.added.keys().chain(other.added.keys()) {
            if self.added.get(key) != other.added.get(key) {
                visit(IVec2::new(key.1, key.0));
            }
        }
    }

    fn set(&mut self, id: StemId, cell: IVec2, change: Change) {
        let place = (cell.y, cell.x, id);
        match change {
            Change::Altered(stem) => drop(self.stems.insert(id, stem)),
            Change::Added(stem) => drop(self.added.insert(place, stem)),
            Change::None => {
                self.stems.remove(&id);
                self.added.remove(&place);
            }
        }
    }
}

/// What is other with a stem.
enum Change {
    None,
    Altered(AlteredStem),
    Added(AddedStem),
}

/// The changes of a forest, by tile.
pub(super) struct ChangeIndex {
    /// Cells along a side of a tile.
    tile_cells: i32,
    tiles: HashMap<IVec2, Arc<TileChanges>>,
    /// Where the stems stand that the game has planted, m.
    planted_m: HashMap<StemId, Vec2>,
}

impl ChangeIndex {
    /// Of all changes there are. Species that the plan does not have are told.
    pub fn of(changes: &ForestChanges, planter: &Planter, tile_cells: i32) -> Self {
        let mut index = Self { tile_cells, tiles: HashMap::default(), planted_m: HashMap::default() };
        let mut unknown = HashSet::default();
        for (id, place_m) in changes.places() {
            index.update(id, place_m, changes, planter, &mut unknown);
        }
        index
    }

    /// The changes of a tile, if there are any.
    pub fn tile(&self, tile: IVec2) -> Option<Arc<TileChanges>> {
        self.tiles.get(&tile).cloned()
    }

    /// Where (x, z) a stem stands that the game has planted, m.
    pub fn planted_place_m(&self, id: StemId) -> Option<Vec2> {
        self.planted_m.get(&id).copied()
    }

    /// The changes of all tiles, in no order.
    pub fn tiles(&self) -> Vec<Arc<TileChanges>> {
        self.tiles.values().cloned().collect()
    }

    /// Whether nothing is changed.
    pub fn is_empty(&self) -> bool {
        self.tiles.is_empty()
    }

    /// Takes over what is other with a stem; it tells of species that the plan does not have, if they are not among those that are known
    /// to be unknown. Returns the stem's cell.
    pub fn update(
        &mut self,
        id: StemId,
        place_m: Vec2,
        changes: &ForestChanges,
        planter: &Planter,
        unknown: &mut HashSet<u8>,
    ) -> IVec2 {
        let cell = planter.cell_at(place_m);
        let mut number_of = |number: u8| {
            let name = changes.species_name(number)?;
            let found = planter.species().iter().position(|species| species == name);
            if found.is_none() && unknown.insert(number) {
                warn!("forest: the plan has no species `{name}` (see `more_species`): its stems stay as they were");
            }
            found.map(|number| number as u8)
        };
        let change = match (changes.of_stem(id), changes.planted_stem(id)) {
            (Some(StemChange::Felled), _) => Change::Altered(AlteredStem::Felled),
            (Some(StemChange::Altered(age_years, species)), _) => {
                Change::Altered(AlteredStem::Altered { age_years, species: species.and_then(number_of) })
            }
            (None, Some(PlantedStem(place_m, age_years, species))) => number_of(species)
                .map_or(Change::None, |species| {
                    Change::Added(AddedStem { place_m: place_m.into(), age_years, species })
                }),
            (None, None) => Change::None,
        };
        if id.is_planted() {
            match change {
                Change::Added(_) => self.planted_m.insert(id, place_m),
                _ => self.planted_m.remove(&id),
            };
        }
        let tile = tile_of(cell, self.tile_cells);
        let there = self.tiles.entry(tile).or_default();
        Arc::make_mut(there).set(id, cell, change);
        if there.is_empty() {
            self.tiles.remove(&tile);
        }
        cell
    }

    /// The cells in which it differs from another of the same tiles, row after row.
    pub fn cells_that_differ(&self, other: &Self, planter: &Planter) -> Vec<IVec2> {
        let mut cells: Vec<IVec2> = Vec::new();
        let nothing = Arc::default();
        let tiles = self.tiles.keys().chain(other.tiles.keys().filter(|tile| !self.tiles.contains_key(*tile)));
        for tile in tiles {
            let [ours, theirs] = [self, other].map(|index| index.tiles.get(tile).unwrap_or(&nothing));
            ours.visit_differences(theirs, planter, |cell| cells.push(cell));
        }
        cells.sort_unstable_by_key(|cell| (cell.y, cell.x));
        cells.dedup();
        cells
    }
}
