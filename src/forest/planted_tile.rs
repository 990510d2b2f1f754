//! Tiles of a forest: squares of cells, each planted once, in one go, for all that need its plants.
//!
//! A full plant has 44 bytes. The store of stems packs it into 16, and its impostor has 76; to keep the full plants of a million trees, too,
//! would cost half as much again. So a planted tile is shared by those who need it when it comes, and goes when they have what they need:
//! the stems in the store, the meshes of impostors (which wait for the atlases of their species), and the near trees. Only where a viewer
//! comes near to a tile long after it was planted are cells planted again, one by one, for the near trees: that is one cell in a hundred
//! of those that are known.

use super::{cell_planter::CellPlanter, stem_id::StemId};
use crate::scatter::Planted;
use bevy::{math::IVec2, platform::hash::FixedState};
use std::{
    hash::{BuildHasher, Hasher},
    ops::Range,
};

/// Cells along a side of a tile, at least.
const MIN_CELLS: i32 = 4;
const MAX_CELLS: i32 = 64;
/// No more tiles than this from a viewer to the border: a wide view has larger tiles, not more draws.
const TILES_TO_BORDER: f32 = 20.0;

/// Cells along a side of a tile, a power of two, where cells with that side, m, are known so far, m.
pub(super) fn cells_of_tile(known_m: f32, cell_m: f32) -> i32 {
    let mut cells = MIN_CELLS;
    while known_m > TILES_TO_BORDER * cells as f32 * cell_m && cells < MAX_CELLS {
        cells *= 2;
    }
    cells
}

/// The plants of a tile.
pub(super) struct PlantedTile {
    /// The tile's first cell, and how many there are along a side.
    first: IVec2,
    side: i32,
    /// Cell after cell, row after row.
    plants: Vec<Planted>,
    /// Which stem each is.
    ids: Vec<StemId>,
    /// Where the plants of each cell end.
    ends: Box<[u32]>,
    fingerprint: u64,
}

impl PlantedTile {
    /// Plants a tile of `side` cells along a side.
    pub fn plant(planter: &CellPlanter, tile: IVec2, side: i32) -> Self {
        let first = tile * side;
        let (mut plants, mut ids, mut planted, mut ids_of_cell) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        let mut ends = Vec::with_capacity((side * side) as usize);
        for cell in 0..side * side {
            planter.plant(first + IVec2::new(cell % side, cell / side), &mut planted, &mut ids_of_cell);
            plants.append(&mut planted);
            ids.append(&mut ids_of_cell);
            ends.push(plants.len() as u32);
        }
        plants.shrink_to_fit();
        ids.shrink_to_fit();
        let fingerprint = fingerprint(&plants, &ends);
        Self { first, side, plants, ids, ends: ends.into(), fingerprint }
    }

    /// A tile in which nothing stands.
    pub fn bare(tile: IVec2, side: i32) -> Self {
        let ends = vec![0; (side * side) as usize];
        let fingerprint = fingerprint(&[], &ends);
        Self { first: tile * side, side, plants: Vec::new(), ids: Vec::new(), ends: ends.into(), fingerprint }
    }

    /// All of its plants.
    #[cfg(any(feature = "render", test))]
    pub fn plants(&self) -> &[Planted] {
        &self.plants
    }

    /// Its cells, and the plants of each.
    pub fn cells(&self) -> impl Iterator<Item = (IVec2, &[Planted])> {
        (0..self.side * self.side).map(|number| {
            let cell = self.first + IVec2::new(number % self.side, number / self.side);
            (cell, self.cell(cell))
        })
    }

    /// The plants of one of its cells.
    pub fn cell(&self, cell: IVec2) -> &[Planted] {
        &self.plants[self.range(cell)]
    }

    /// The plants of one of its cells, and which stems they are.
    pub fn stems(&self, cell: IVec2) -> Vec<(StemId, Planted)> {
        let range = self.range(cell);
        self.ids[range.clone()].iter().copied().zip(self.plants[range].iter().copied()).collect()
    }

    fn range(&self, cell: IVec2) -> Range<usize> {
        let at = cell - self.first;
        let number = (at.y * self.side + at.x) as usize;
        let begin = number.checked_sub(1).map_or(0, |before| self.ends[before]);
        begin as usize..self.ends[number] as usize
    }

    /// The same for tiles with the same plants; with others the same once in 2^64.
    pub fn fingerprint(&self) -> u64 {
        self.fingerprint
    }
}

fn fingerprint(plants: &[Planted], ends: &[u32]) -> u64 {
    let mut hasher = FixedState::default().build_hasher();
    ends.iter().for_each(|end| hasher.write_u32(*end));
    for plant in plants {
        let Planted { position, turn_rad, plan_size, vigour, age_years, season_days, tint, species, seed } = *plant;
        let [x, y, z] = position.to_array();
        for value in [x, y, z, turn_rad, plan_size, vigour, age_years, season_days, tint] {
            hasher.write_u32(value.to_bits());
        }
        hasher.write_u32(seed);
        hasher.write_u8(species);
    }
    hasher.finish()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        ground::LevelGround,
        scatter::{
            ForestPlan, Planter,
            plan::{Area, Stock},
        },
        tree::growth::age::Age,
    };
    use std::sync::Arc;

    fn planter(area: Area) -> CellPlanter {
        let planter = Planter::new(&ForestPlan { areas: vec![area], ..ForestPlan::default() }).expect("a valid plan");
        CellPlanter { planter: Arc::new(planter), ground: Arc::new(LevelGround::default()), changes: None }
    }

    fn wood(density_per_ha: f32) -> CellPlanter {
        planter(Area { density_per_ha, ..Area::default() })
    }

    #[test]
    fn a_tile_holds_what_its_cells_hold_when_they_are_planted_alone() {
        let wood = wood(300.0);
        for tile in [IVec2::ZERO, IVec2::new(-1, 0), IVec2::new(-1, -1)] {
            let planted = PlantedTile::plant(&wood, tile, 4);
            let mut count = 0;
            for (cell, plants) in planted.cells() {
                assert_eq!(planted.stems(cell), wood.plants(cell));
                assert!(planted.stems(cell).iter().map(|(_, plant)| plant).eq(plants));
                assert_eq!(cell.div_euclid(IVec2::splat(4)), tile);
                count += plants.len();
            }
            assert!(count == planted.plants().len());
        }
    }

    #[test]
    fn a_plant_has_the_size_that_is_reckoned_with() {
        assert_eq!(size_of::<Planted>(), 44);
    }

    #[test]
    fn fingerprints_tell_tiles_apart() {
        let of = |density_per_ha, tile| PlantedTile::plant(&wood(density_per_ha), tile, 4).fingerprint();
        let here = of(300.0, IVec2::ZERO);
        assert_eq!(here, of(300.0, IVec2::ZERO));
        assert_ne!(here, of(310.0, IVec2::ZERO));
        assert_ne!(here, of(300.0, IVec2::new(-1, 0)));
    }

    /// What [`Planted`] says of its two sizes.
    #[test]
    fn a_plan_and_a_species_give_a_tree_nearly_the_same_height() {
        let age = Age::default();
        let (k, p) = (age.height_rate_per_year, age.height_shape);
        let full_grown_years = -(1.0 - 0.95_f32.powf(p.recip())).ln() / k;
        // The species has its heights relative to that when mature.
        let greatest = (1.0 - (-k * age.mature_years).exp()).powf(-p);
        for age_years in [5.0, 10.0, 20.0, 40.0, 80.0, 120.0, 200.0, 400.0] {
            let stock =
                Stock { age_years, age_spread_years: 0.0, size_spread: 0.0, full_grown_years, ..Stock::default() };
            let wood = planter(Area { stock: vec![stock], ..Area::default() });
            let tile = PlantedTile::plant(&wood, IVec2::ZERO, 4);
            let plan_size = tile.plants()[0].plan_size;
            let height = age.stage(age_years).height / greatest;
            assert!((plan_size - height).abs() < 0.08, "{age_years} years: {plan_size} and {height}");
        }
    }

    #[test]
    fn wide_views_have_larger_tiles() {
        assert_eq!([2500.0, 5120.0, 10_000.0, 50_000.0].map(|known_m| cells_of_tile(known_m, 64.0)), [4, 4, 8, 64]);
        assert_eq!(cells_of_tile(5e4, 1024.0), 4);
    }
}
