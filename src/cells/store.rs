//! The cells of a forest and their plants.
//!
//! A store has two layers: blocks of 16 x 16 cells, dense, in a map that is sorted by row and column. A dense array over
//! the whole plan would be quicker to index, but a plan may reach 200 km with cells of 8 m (2.5 GB of empty slots). A hash
//! map of cells would have no order, and no rows to walk along. With blocks a lookup is one search among few (a hundred at
//! 10 km), neighbours lie together, and rows without anything are skipped.

use super::{
    block::{Block, SIDE, block_of},
    cell::Cell,
};
use crate::{
    scatter::Stem,
    setting::{SettingError, require},
};
use bevy::math::{DVec2, IVec2, Vec2};
use std::collections::{BTreeMap, btree_map::Entry};

/// (Row, column) of a block.
type Key = (i32, i32);

fn key_of(block: IVec2) -> Key {
    (block.y, block.x)
}

/// The cells of a forest that are planted, and their plants.
#[derive(Clone, Debug)]
pub struct CellStore {
    cell_m: f32,
    blocks: BTreeMap<Key, Block>,
    /// The least and the greatest block.
    bounds: Option<[IVec2; 2]>,
    cells: usize,
    plants: usize,
    heap_bytes: usize,
}

impl CellStore {
    /// An empty store of cells with this side. units: m, domain: \[8, 1024\], the plan's own.
    ///
    /// # Errors
    /// Where `cell_m` is outside its domain.
    pub fn new(cell_m: f32) -> Result<Self, SettingError> {
        require("cell_m", cell_m, 8.0..=1024.0)?;
        Ok(Self { cell_m, blocks: BTreeMap::new(), bounds: None, cells: 0, plants: 0, heap_bytes: 0 })
    }

    /// Side of a cell, m.
    pub fn cell_m(&self) -> f32 {
        self.cell_m
    }

    /// The least corner (x, z) of a cell, m.
    pub fn corner_m(&self, cell: IVec2) -> DVec2 {
        cell.as_dvec2() * f64::from(self.cell_m)
    }

    /// The cell at a place (x, z), m.
    pub fn cell_at(&self, place_m: Vec2) -> IVec2 {
        (place_m.as_dvec2() / f64::from(self.cell_m)).floor().as_ivec2()
    }

    /// Puts a planted cell in, also where nothing grew, and gives back what was there before.
    pub fn insert(&mut self, cell: IVec2, content: Cell) -> Option<Cell> {
        self.plants += content.len();
        self.heap_bytes += content.heap_bytes();
        let block = block_of(cell);
        let before = self.blocks.entry(key_of(block)).or_insert_with(Block::new).insert(cell, content);
        self.bounds = Some(self.bounds.map_or([block; 2], |[min, max]| [min.min(block), max.max(block)]));
        self.cells += usize::from(before.is_none());
        self.forget(before.as_ref());
        before
    }

    /// Takes a cell out.
    pub fn remove(&mut self, cell: IVec2) -> Option<Cell> {
        let Entry::Occupied(mut entry) = self.blocks.entry(key_of(block_of(cell))) else { return None };
        let content = entry.get_mut().remove(cell);
        if entry.get().is_empty() {
            entry.remove();
            let blocks = self.blocks.keys().map(|&(row, column)| [IVec2::new(column, row); 2]);
            self.bounds = blocks.reduce(|[min, max], [block, _]| [min.min(block), max.max(block)]);
        }
        self.cells -= usize::from(content.is_some());
        self.forget(content.as_ref());
        content
    }

    fn forget(&mut self, content: Option<&Cell>) {
        self.plants -= content.map_or(0, Cell::len);
        self.heap_bytes -= content.map_or(0, Cell::heap_bytes);
    }

    /// A cell that is planted.
    pub fn get(&self, cell: IVec2) -> Option<&Cell> {
        self.block(block_of(cell))?.get(cell)
    }

    /// Whether a cell is planted.
    pub fn contains(&self, cell: IVec2) -> bool {
        self.get(cell).is_some()
    }

    /// One plant of a cell.
    pub fn stem(&self, cell: IVec2, index: usize) -> Option<Stem> {
        let record = self.get(cell)?.records().get(index)?;
        Some(Stem::unpack(*record, self.corner_m(cell), self.cell_m))
    }

    /// The plants of a cell.
    pub fn stems(&self, cell: IVec2) -> impl Iterator<Item = Stem> {
        let corner_m = self.corner_m(cell);
        let records = self.get(cell).map_or(&[][..], Cell::records);
        records.iter().map(move |record| Stem::unpack(*record, corner_m, self.cell_m))
    }

    /// All cells: block after block of 16 x 16, each row after row, whatever the order in which they came.
    pub fn iter(&self) -> impl Iterator<Item = (IVec2, &Cell)> {
        self.blocks.iter().flat_map(|(&(row, column), block)| block.cells(IVec2::new(column, row)))
    }

    /// Number of cells.
    pub fn len(&self) -> usize {
        self.cells
    }

    /// Whether no cell is planted.
    pub fn is_empty(&self) -> bool {
        self.cells == 0
    }

    /// Number of plants.
    pub fn plants(&self) -> usize {
        self.plants
    }

    /// Memory for the cells and their plants, without what map and allocator add. units: bytes.
    pub fn bytes(&self) -> usize {
        size_of::<Self>() + self.blocks.len() * (size_of::<Key>() + Block::BYTES) + self.heap_bytes
    }

    /// The least and the greatest corner (x, z) of all blocks, m.
    pub(super) fn corners_m(&self) -> Option<[DVec2; 2]> {
        let side_m = f64::from(self.cell_m) * f64::from(SIDE);
        self.bounds.map(|[min, max]| [min.as_dvec2() * side_m, (max.as_dvec2() + 1.0) * side_m])
    }

    pub(super) fn block(&self, block: IVec2) -> Option<&Block> {
        self.blocks.get(&key_of(block))
    }

    /// The least and the greatest block of a square about a place.
    pub(super) fn blocks_about(&self, place_m: Vec2, reach_m: f32) -> [IVec2; 2] {
        let side_m = f64::from(self.cell_m) * f64::from(SIDE);
        let corner = |reach_m: f32| (place_m.as_dvec2() + f64::from(reach_m)) / side_m;
        [-reach_m, reach_m].map(|reach_m| corner(reach_m).floor().as_ivec2())
    }

    /// Visits the blocks between two, in rows. Where there are none it takes no time.
    pub(super) fn visit_blocks<'a>(&'a self, [min, max]: [IVec2; 2], mut visit: impl FnMut(IVec2, &'a Block)) {
        if min.cmpgt(max).any() {
            return;
        }
        let mut row = min.y;
        while row <= max.y {
            let mut next_row = None;
            for (&(found_row, column), block) in self.blocks.range((row, min.x)..) {
                if found_row != row || column > max.x {
                    next_row = Some(if found_row == row { row.saturating_add(1) } else { found_row });
                    break;
                }
                visit(IVec2::new(column, row), block);
            }
            match next_row {
                Some(next) if next > row => row = next,
                _ => return,
            }
        }
    }
}

#[cfg(test)]
pub(super) mod tests;
