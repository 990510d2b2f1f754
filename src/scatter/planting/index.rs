//! An index of rectangles by place.
//!
//! Rectangles are kept in square tiles as large as they are (to the next power of two), so that each lies in at most four
//! of them. A query looks into the few tiles of each size that occurs. Its cost does not depend on how many rectangles
//! lie elsewhere, nor on their sizes.

use bevy::math::{DVec2, IVec2};

/// Smaller rectangles share tiles of this side, m.
const LEAST_TILE_M: f64 = 32.0;

/// A tile: its size as a power of two, and its place.
type Tile = (u32, i32, i32);

/// Rectangles by place.
#[derive(Clone, Debug, Default)]
pub(super) struct BoxIndex {
    /// (Tile, number of the rectangle), sorted.
    entries: Vec<(Tile, u32)>,
    /// The sizes that occur, sorted.
    sizes: Vec<u32>,
}

impl BoxIndex {
    /// Of rectangles (least, greatest corner).
    pub(super) fn new(boxes: impl IntoIterator<Item = [DVec2; 2]>) -> Self {
        let mut index = Self::default();
        for (number, [min, max]) in boxes.into_iter().enumerate() {
            let size = ((max - min).max_element() / LEAST_TILE_M).max(1.0);
            let size = libm::log2(size).ceil() as u32;
            index.entries.extend(tiles(size, min, max).map(|tile| (tile, number as u32)));
            index.sizes.push(size);
        }
        index.entries.sort_unstable();
        index.sizes.sort_unstable();
        index.sizes.dedup();
        index
    }

    /// Numbers of the rectangles that may reach into a rectangle, in order. Some may not: they only share a tile.
    pub(super) fn near(&self, min: DVec2, max: DVec2, found: &mut Vec<u32>) {
        found.clear();
        for &size in &self.sizes {
            for tile in tiles(size, min, max) {
                let first = self.entries.partition_point(|(other, _)| *other < tile);
                let here = self.entries[first..].iter().take_while(|(other, _)| *other == tile);
                found.extend(here.map(|(_, number)| number));
            }
        }
        found.sort_unstable();
        found.dedup();
    }
}

fn tiles(size: u32, min: DVec2, max: DVec2) -> impl Iterator<Item = Tile> {
    let side = LEAST_TILE_M * libm::exp2(f64::from(size));
    let tile = |place: DVec2| -> IVec2 { (place / side).floor().as_ivec2() };
    let (first, last) = (tile(min), tile(max));
    (first.y..=last.y).flat_map(move |row| (first.x..=last.x).map(move |column| (size, column, row)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn boxes() -> impl Strategy<Value = Vec<[DVec2; 2]>> {
        let side = || prop_oneof![0.0..10.0, 0.0..5000.0];
        let one = (-3000.0..3000.0, -3000.0..3000.0, side(), side())
            .prop_map(|(x, z, width, depth)| [DVec2::new(x, z), DVec2::new(x + width, z + depth)]);
        prop::collection::vec(one, 0..60)
    }

    proptest! {
        #[test]
        fn every_overlapping_rectangle_is_found(boxes in boxes(), x in -3000.0..3000.0, z in -3000.0..3000.0) {
            let index = BoxIndex::new(boxes.clone());
            let (min, max) = (DVec2::new(x, z), DVec2::new(x + 70.0, z + 70.0));
            let mut found = vec![9];
            index.near(min, max, &mut found);
            prop_assert!(found.is_sorted());
            for (number, other) in boxes.iter().enumerate() {
                let apart = other[1].cmplt(min).any() || other[0].cmpgt(max).any();
                prop_assert!(apart || found.contains(&(number as u32)));
            }
        }
    }

    #[test]
    fn far_rectangles_are_not_found() {
        let houses = (0..10_000).map(|i| {
            let at = DVec2::new(f64::from(i % 100), f64::from(i / 100)) * 100.0;
            [at, at + 10.0]
        });
        let mut found = Vec::new();
        BoxIndex::new(houses).near(DVec2::splat(1000.0), DVec2::splat(1064.0), &mut found);
        assert_eq!(found, [1010]);
    }
}
