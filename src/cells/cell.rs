//! What one cell holds.

use crate::{
    ground::Ground,
    scatter::{GREATEST_SIZE, Planted, Planter},
};
use bevy::math::{DVec2, IVec2};

/// The plants of one cell, packed. It can be made on any thread.
#[derive(Clone, Debug, PartialEq)]
pub struct Cell {
    records: Box<[[u32; 4]]>,
    /// (Species, number of plants), by species.
    counts: Box<[(u8, u32)]>,
    range: PlantRange,
}

/// How low, how high and how large plants are.
#[derive(Clone, Copy, Debug, PartialEq)]
struct PlantRange {
    lowest_m: f32,
    highest_m: f32,
    /// [`Planted::plan_size`] of the largest.
    largest: f32,
}

impl PlantRange {
    /// Of no plants: what is merged with it remains as it is.
    const NOTHING: Self = Self { lowest_m: f32::INFINITY, highest_m: f32::NEG_INFINITY, largest: 0.0 };

    fn merge(self, other: Self) -> Self {
        Self {
            lowest_m: self.lowest_m.min(other.lowest_m),
            highest_m: self.highest_m.max(other.highest_m),
            largest: self.largest.max(other.largest),
        }
    }

    fn is_nothing(self) -> bool {
        self.lowest_m > self.highest_m
    }
}

impl Cell {
    /// Packs plants, of which all stand in the cell with this least corner (x, z) and this side, m.
    pub fn pack(planted: &[Planted], corner_m: DVec2, cell_m: f32) -> Self {
        let mut counts: Vec<(u8, u32)> = Vec::new();
        let mut range = PlantRange::NOTHING;
        for plant in planted {
            match counts.binary_search_by_key(&plant.species, |(species, _)| *species) {
                Ok(found) => counts[found].1 += 1,
                Err(place) => counts.insert(place, (plant.species, 1)),
            }
            let height_m = plant.position.y;
            let largest = plant.plan_size.min(GREATEST_SIZE);
            range = range.merge(PlantRange { lowest_m: height_m, highest_m: height_m, largest });
        }
        Self {
            records: planted.iter().map(|plant| plant.pack(corner_m, cell_m)).collect(),
            counts: counts.into_boxed_slice(),
            range,
        }
    }

    /// Plants a cell of a forest; `buffer` is only room to work in.
    pub fn plant(planter: &Planter, cell: IVec2, ground: &impl Ground, buffer: &mut Vec<Planted>) -> Self {
        planter.plant(cell, ground, buffer);
        Self::pack(buffer, planter.corner_m(cell), planter.cell_m())
    }

    /// Its plants, packed.
    pub fn records(&self) -> &[[u32; 4]] {
        &self.records
    }

    /// Number of plants.
    pub fn len(&self) -> usize {
        self.records.len()
    }

    /// Whether nothing stands in it.
    pub fn is_empty(&self) -> bool {
        self.records.is_empty()
    }

    /// The species that stand in it and their numbers of plants, by species.
    pub fn counts(&self) -> &[(u8, u32)] {
        &self.counts
    }

    /// The least and the greatest height at which a plant leaves the ground, m; `None` where nothing stands.
    pub fn ground_m(&self) -> Option<[f32; 2]> {
        (!self.range.is_nothing()).then_some([self.range.lowest_m, self.range.highest_m])
    }

    /// [`Planted::plan_size`] of its largest plant; 0 where nothing stands.
    pub fn largest(&self) -> f32 {
        self.range.largest
    }

    /// What it has on the heap, bytes.
    pub(super) fn heap_bytes(&self) -> usize {
        size_of_val(&*self.records) + size_of_val(&*self.counts)
    }
}
