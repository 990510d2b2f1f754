use super::*;
use crate::scatter::Planted;
use bevy::math::Vec3;
use proptest::prelude::*;
use rand::{Rng, RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};

pub(in crate::cells) const CELL_M: f32 = 64.0;

/// So many plants of two species in a cell, on ground between `-relief_m` and `relief_m`.
pub(in crate::cells) fn cell_of(cell: IVec2, plants: usize, relief_m: f32, seed: u64) -> Cell {
    let place = u64::from(cell.x.cast_unsigned()) << 32 | u64::from(cell.y.cast_unsigned());
    let mut random = Xoshiro256PlusPlus::seed_from_u64(seed ^ place.wrapping_mul(0x9e37_79b9_7f4a_7c15));
    let corner_m = cell.as_dvec2() * f64::from(CELL_M);
    let mut planted = Vec::new();
    for _ in 0..plants {
        let [x, z] =
            [corner_m.x, corner_m.y].map(|edge_m| (edge_m + random.random_range(0.0..f64::from(CELL_M))) as f32);
        planted.push(Planted {
            position: Vec3::new(x, relief_m * random.random_range(-1.0..=1.0_f32), z),
            turn_rad: random.random_range(0.0..std::f32::consts::TAU),
            plan_size: random.random_range(0.2..1.4),
            vigour: 1.0,
            age_years: 80.0,
            season_days: random.random_range(-9.0..9.0),
            tint: random.random_range(-1.0..1.0),
            species: random.random_range(0..2),
            seed: random.next_u32(),
        });
    }
    Cell::pack(&planted, corner_m, CELL_M)
}

/// A square of cells about the origin, most of them with some plants, some with none, some not there at all.
pub(in crate::cells) fn forest(half: i32, most_plants: usize, relief_m: f32, seed: u64) -> CellStore {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
    let mut store = CellStore::new(CELL_M).unwrap();
    for y in -half..half {
        for x in -half..half {
            let plants = random.random_range(0..=most_plants);
            if random.random_bool(0.9) {
                store.insert(IVec2::new(x, y), cell_of(IVec2::new(x, y), plants, relief_m, seed));
            }
        }
    }
    store
}

/// What is in a store, to compare stores.
pub(in crate::cells) fn contents(store: &CellStore) -> Vec<(IVec2, Cell)> {
    store.iter().map(|(cell, content)| (cell, content.clone())).collect()
}

#[test]
fn a_cell_sums_up_its_plants() {
    let cell = cell_of(IVec2::new(3, -2), 500, 10.0, 1);
    let corner_m = DVec2::new(192.0, -128.0);
    let stems: Vec<Stem> = cell.records().iter().map(|&record| Stem::unpack(record, corner_m, CELL_M)).collect();
    let count = |species| stems.iter().filter(|stem| stem.species == species).count() as u32;
    assert_eq!(cell.counts(), [(0, count(0)), (1, count(1))]);
    let heights = || stems.iter().map(|stem| stem.position.y);
    let [lowest_m, highest_m] = cell.ground_m().unwrap();
    assert_eq!((lowest_m, highest_m), (heights().fold(99.0, f32::min), heights().fold(-99.0, f32::max)));
    let largest = stems.iter().map(|stem| stem.plan_size).fold(0.0, f32::max);
    assert!((cell.largest() - largest).abs() < 1e-4);
    assert_eq!(Cell::pack(&[], corner_m, CELL_M).ground_m(), None);
}

#[test]
fn cells_are_inserted_and_removed_whole() {
    let mut store = forest(20, 5, 3.0, 2);
    let empty = CellStore::new(CELL_M).unwrap();
    let (plants, bytes) = (store.plants(), store.bytes());
    assert_eq!(plants, store.iter().map(|(_, cell)| cell.len()).sum::<usize>());
    assert_eq!(store.len(), store.iter().count());
    let cell = IVec2::new(7, -9);
    let before = store.insert(cell, cell_of(cell, 50, 3.0, 7)).map_or(0, |cell| cell.len());
    assert_eq!(store.plants(), plants - before + 50);
    assert_eq!(store.stems(cell).count(), 50);
    assert_eq!(store.stem(cell, 49), store.stems(cell).last());
    assert_eq!(store.stem(cell, 50), None);
    assert!(store.bytes() > bytes);
    for (cell, content) in contents(&store) {
        assert!(store.contains(cell));
        assert_eq!(store.remove(cell), Some(content));
        assert_eq!(store.remove(cell), None);
    }
    assert_eq!((store.len(), store.plants(), store.bytes()), (0, 0, empty.bytes()));
}

#[test]
fn a_million_trees_take_twenty_bytes_each() {
    let mut store = CellStore::new(CELL_M).unwrap();
    let content = cell_of(IVec2::ZERO, 41, 0.0, 1);
    for y in 0..157 {
        for x in 0..157 {
            store.insert(IVec2::new(x, y), content.clone());
        }
    }
    assert!(store.plants() > 1_000_000);
    assert!(store.bytes() < 20 * store.plants(), "{} bytes", store.bytes());
}

proptest! {
    #[test]
    fn the_order_of_planting_does_not_show(cells in prop::collection::vec((-99..99_i32, -99..99_i32), 1..60)) {
        let (mut forth, mut back) = (CellStore::new(CELL_M).unwrap(), CellStore::new(CELL_M).unwrap());
        for (store, reversed) in [(&mut forth, false), (&mut back, true)] {
            let mut order: Vec<IVec2> = cells.iter().map(|&(x, y)| IVec2::new(x, y)).collect();
            if reversed {
                order.reverse();
            }
            for cell in order {
                store.insert(cell, cell_of(cell, 2, 1.0, 0));
            }
        }
        prop_assert_eq!(contents(&forth), contents(&back));
    }

    #[test]
    fn the_blocks_of_a_square_are_visited_once(
        cells in prop::collection::vec((-500..500_i32, -500..500_i32), 1..80),
        x in -40..40_i32, y in -40..40_i32, width in -1..30_i32, depth in -1..30_i32,
    ) {
        let mut store = CellStore::new(CELL_M).unwrap();
        for &(x, y) in &cells {
            store.insert(IVec2::new(x, y), Cell::pack(&[], DVec2::ZERO, CELL_M));
        }
        let (min, max) = (IVec2::new(x, y), IVec2::new(x + width, y + depth));
        let mut visited = Vec::new();
        store.visit_blocks([min, max], |block, _| visited.push((block.y, block.x)));
        let inside = |block: &IVec2| block.cmpge(min).all() && block.cmple(max).all();
        let mut all: Vec<_> = cells.iter().map(|&(x, y)| block_of(IVec2::new(x, y))).filter(inside).collect();
        all.sort_by_key(|block| (block.y, block.x));
        all.dedup();
        prop_assert_eq!(visited, all.iter().map(|block| (block.y, block.x)).collect::<Vec<_>>());
    }
}

#[test]
fn cells_with_extreme_indices_are_harmless() {
    let mut store = CellStore::new(CELL_M).unwrap();
    for cell in [IVec2::MIN, IVec2::MAX, IVec2::ZERO] {
        store.insert(cell, cell_of(IVec2::ZERO, 1, 1.0, 0));
        assert!(store.contains(cell));
    }
    let mut visited = 0;
    store.visit_blocks([IVec2::MIN, IVec2::MAX], |_, _| visited += 1);
    assert_eq!(visited, 3);
    assert!(CellStore::new(f32::NAN).is_err());
}
