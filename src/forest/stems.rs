//! Which stem stands where.

use super::{cells::ForestCells, reach::tile_of, stem_id::StemId};
use crate::scatter::{Planted, Stem};
use bevy::prelude::*;

/// A stem of a forest that stands, as it is after all changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StandingStem {
    /// Which one it is.
    pub id: StemId,
    /// What it is. Its species is a number of [`ForestCells::species`].
    pub plant: Planted,
}

/// The store packs stems too tightly to hold their ids. So each of these plants a cell or some of them, in some ten microseconds a cell.
impl ForestCells {
    /// The stem with an id, if it stands, be it near or far; changes of this frame do not count yet.
    #[must_use]
    pub fn stem(&self, id: StemId) -> Option<StandingStem> {
        let place_m = id.place_m().or_else(|| self.changes.as_ref()?.planted_place_m(id))?;
        self.stems_of(self.store.cell_at(place_m)).find(|stem| stem.id == id)
    }

    /// The stem that is nearest to a place (x, z), within a radius, m, of those about the viewers.
    #[must_use]
    pub fn nearest_stem(&self, place_m: Vec2, radius_m: f32) -> Option<StandingStem> {
        let found = self.store.nearest(place_m, radius_m)?;
        let distance_m = |stem: &StandingStem| stem.plant.position.xz().distance(place_m);
        self.stems_of(found.cell).min_by(|a, b| distance_m(a).total_cmp(&distance_m(b)))
    }

    /// Visits the stems within a radius of a place (x, z), m, of those about the viewers.
    pub fn stems_within(&self, place_m: Vec2, radius_m: f32, mut visit: impl FnMut(StandingStem)) {
        let mut cells: Vec<IVec2> = Vec::new();
        // What is packed is rounded: a stem at the border may seem to be beyond it.
        self.store.within(place_m, radius_m + self.rounding_m(place_m), |found| {
            if cells.last() != Some(&found.cell) {
                cells.push(found.cell);
            }
        });
        let is_within = |stem: &StandingStem| stem.plant.position.xz().distance(place_m) <= radius_m;
        cells.into_iter().flat_map(|cell| self.stems_of(cell)).filter(is_within).for_each(&mut visit);
    }

    /// Which stem it is that was found in a cell of the [`store`](Self::store), by a ray for instance.
    #[must_use]
    pub fn identify(&self, cell: IVec2, stem: &Stem) -> Option<StemId> {
        let place_m = stem.position.xz();
        let is_it = |stem: &StandingStem| stem.plant.position.xz().distance(place_m) <= self.rounding_m(place_m);
        self.stems_of(cell).find(is_it).map(|stem| stem.id)
    }

    /// Whether the plan grows a stem at exactly that place (x, z), m, felled or not.
    pub(super) fn plan_grows(&self, place_m: Vec2) -> bool {
        let mut plants = Vec::new();
        self.planter.plant(self.store.cell_at(place_m), &self.ground, &mut plants);
        plants.iter().any(|plant| plant.position.xz() == place_m)
    }

    fn stems_of(&self, cell: IVec2) -> impl Iterator<Item = StandingStem> {
        let planter = self.cell_planter(tile_of(cell, self.tile_cells()));
        planter.plants(cell).into_iter().map(|(id, plant)| StandingStem { id, plant })
    }
}
