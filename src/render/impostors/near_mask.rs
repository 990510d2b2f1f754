//! Which cells' trees are entities, and in what stands they stand, as the shader of impostors reads it: for each tile a bit a cell, then the
//! canopies of its blocks.

use crate::{
    render::{
        buffers::{dirty_table::DirtyTable, sway_buffers::empty_buffer, table_uploads::TableUploads},
        instances::rows::NO_IMPOSTOR_M,
    },
    wind::{Canopy, PackedCanopy},
};
use bevy::{mesh::MeshTag, prelude::*, render::storage::ShaderBuffer};

/// Words of a mask before its bits: those of [`MaskRange`], and the cells along a side.
pub(crate) const HEADER: u32 = 4;

/// Blocks along a side of a tile whose trees have one canopy: each at least as large as a cell, for far trees show little of a difference.
pub(crate) const CANOPY_BLOCKS: u32 = 4;

/// The distances of a forest's impostors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MaskRange {
    /// Side of a cell, m.
    pub cell_m: f32,
    /// Impostors are drawn as far as this, m.
    pub far_to_m: f32,
    /// In near cells none stands nearer than this, m; none stands there at all before it is set.
    pub from_m: Option<f32>,
}

/// The mask of one tile: where it lies among all. Give it back to [`NearMasks::remove`].
#[derive(Debug, Default, PartialEq, Eq)]
pub(crate) struct NearMask {
    first: u32,
    /// Cells along a side of the tile.
    cells: u32,
}

/// The masks of all tiles of all forests.
#[derive(Resource)]
pub(crate) struct NearMasks {
    pub buffer: Handle<ShaderBuffer>,
    words: DirtyTable<u32>,
    /// Masks that were given back.
    free: Vec<NearMask>,
}

impl FromWorld for NearMasks {
    fn from_world(world: &mut World) -> Self {
        let buffer = empty_buffer(&mut world.resource_mut::<Assets<ShaderBuffer>>());
        Self { buffer, words: DirtyTable::default(), free: Vec::new() }
    }
}

impl NearMask {
    /// The tag of the tile's meshes.
    pub fn tag(&self) -> MeshTag {
        MeshTag::new(self.first)
    }

    fn words(&self) -> u32 {
        self.first_canopy() + 2 * CANOPY_BLOCKS * CANOPY_BLOCKS
    }

    /// The first word of its canopies, counted from its own first word.
    fn first_canopy(&self) -> u32 {
        HEADER + (self.cells * self.cells).div_ceil(u32::BITS)
    }
}

impl NearMasks {
    /// A mask for a tile of so many cells along a side, none of which is near, in the open.
    pub fn add(&mut self, cells: u32, range: MaskRange) -> NearMask {
        let free = self.free.iter().position(|mask| mask.cells == cells);
        let mask =
            free.map_or_else(|| NearMask { first: self.words.len(), cells }, |place| self.free.swap_remove(place));
        self.words.grow_to((mask.first + mask.words()).max(self.words.len()));
        (HEADER..mask.words()).for_each(|word| self.words.write(mask.first + word, 0));
        self.words.write(mask.first + HEADER - 1, cells);
        self.set_range(&mask, range);
        self.set_canopies(&mask, &[Canopy::OPEN; (CANOPY_BLOCKS * CANOPY_BLOCKS) as usize]);
        mask
    }

    /// Takes a mask back.
    pub fn remove(&mut self, mask: NearMask) {
        self.free.push(mask);
    }

    /// Sets the distances of a tile.
    pub fn set_range(&mut self, mask: &NearMask, MaskRange { cell_m, far_to_m, from_m }: MaskRange) {
        for (word, value) in (mask.first..).zip([cell_m, far_to_m, from_m.unwrap_or(NO_IMPOSTOR_M)]) {
            self.words.write(word, value.to_bits());
        }
    }

    /// Sets the canopies of a tile's blocks, row after row.
    pub fn set_canopies(&mut self, mask: &NearMask, canopies: &[PackedCanopy]) {
        let words = canopies.iter().flat_map(|canopy| [canopy.profile, canopy.exposure]);
        for (word, value) in (mask.first + mask.first_canopy()..mask.first + mask.words()).zip(words) {
            self.words.write(word, value);
        }
    }

    /// Sets whether a cell of a tile, counted from the tile's first, is near.
    pub fn set(&mut self, mask: &NearMask, cell: UVec2, is_near: bool) {
        let bit = cell.y * mask.cells + cell.x;
        if let Some(word) = self.words.get_mut(mask.first + HEADER + bit / u32::BITS) {
            let bit = 1 << (bit % u32::BITS);
            *word = if is_near { *word | bit } else { *word & !bit };
        }
    }

    /// The buffer has gone, with its device.
    pub fn forget_buffer(&mut self) {
        self.words.forget_buffer();
    }

    /// Uploads what has changed.
    pub fn upload(&mut self, uploads: &mut TableUploads) {
        if self.words.is_dirty() {
            uploads.upload(&self.buffer, &mut self.words);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};
    use std::collections::BTreeSet;

    const RANGE: MaskRange = MaskRange { cell_m: 64.0, far_to_m: 900.0, from_m: None };

    fn masks() -> NearMasks {
        NearMasks { buffer: Handle::default(), words: DirtyTable::default(), free: Vec::new() }
    }

    /// As the shader reads it.
    fn is_near(masks: &NearMasks, mask: &NearMask, cell: UVec2) -> bool {
        let words = &masks.words.rows()[mask.first as usize..];
        let bit = cell.y * words[3] + cell.x;
        words[4 + (bit >> 5) as usize] >> (bit & 31) & 1 == 1
    }

    #[test]
    fn a_mask_has_the_distances_of_its_forest() {
        let mut masks = masks();
        let [one, other] = [4, 8].map(|cells| masks.add(cells, RANGE));
        masks.set_range(&other, MaskRange { from_m: Some(50.0), ..RANGE });
        let header = |mask: &NearMask| masks.words.rows()[mask.first as usize..][..4].to_vec();
        assert_eq!(header(&one), [64.0_f32.to_bits(), 900.0_f32.to_bits(), NO_IMPOSTOR_M.to_bits(), 4]);
        assert_eq!(header(&other)[2..], [50.0_f32.to_bits(), 8]);
    }

    #[test]
    fn a_mask_has_the_canopies_of_its_blocks() {
        let mut masks = masks();
        let mask = masks.add(8, RANGE);
        let canopies: Vec<PackedCanopy> =
            (0..16).map(|block| PackedCanopy { profile: block, exposure: !block }).collect();
        masks.set_canopies(&mask, &canopies);
        // As the shader reads it: two words for the bits of 64 cells.
        let words = &masks.words.rows()[HEADER as usize + 2..];
        assert_eq!(words[2 * 6..2 * 6 + 2], [6, !6]);
        assert_eq!(words.len(), 32);
    }

    /// Masks of several sizes that come, change and go at random hold what a set of cells a mask holds.
    #[test]
    fn masks_hold_the_near_cells_of_their_own_tile() {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(2);
        let mut masks = masks();
        let mut tiles: Vec<(NearMask, BTreeSet<(u32, u32)>)> = Vec::new();
        let mut longest = 0;
        for _ in 0..4000 {
            match random.random_range(0..10) {
                0 if tiles.len() < 40 => {
                    let cells = 4 << random.random_range(0..5);
                    tiles.push((masks.add(cells, RANGE), BTreeSet::new()));
                }
                1 if !tiles.is_empty() => {
                    let (mask, _) = tiles.swap_remove(random.random_range(0..tiles.len()));
                    masks.remove(mask);
                }
                _ if !tiles.is_empty() => {
                    let tile = random.random_range(0..tiles.len());
                    let (mask, near) = &mut tiles[tile];
                    let [x, y] = [0; 2].map(|_: u32| random.random_range(0..mask.cells));
                    let is_near = random.random_bool(0.6);
                    if is_near {
                        near.insert((x, y))
                    } else {
                        near.remove(&(x, y))
                    };
                    masks.set(mask, UVec2::new(x, y), is_near);
                }
                _ => {}
            }
            longest = longest.max(masks.words.len());
        }
        for (mask, near) in &tiles {
            let cells = (0..mask.cells).flat_map(|y| (0..mask.cells).map(move |x| UVec2::new(x, y)));
            let found: BTreeSet<(u32, u32)> =
                cells.filter(|cell| is_near(&masks, mask, *cell)).map(|cell| (cell.x, cell.y)).collect();
            assert_eq!(found, *near);
        }
        // Masks that were given back are used again: at most 40 of each size were ever in use.
        let canopies = 2 * CANOPY_BLOCKS * CANOPY_BLOCKS;
        assert!(longest <= 40 * (5 * (HEADER + canopies) + 1 + 2 + 8 + 32 + 128), "{longest} words");
    }
}
