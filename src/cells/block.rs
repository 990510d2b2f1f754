//! Squares of 16 x 16 cells: what a store is made of.

use super::cell::Cell;
use bevy::math::IVec2;

/// log₂ of the number of cells along a side: at 64 m a block measures a kilometre.
const SIDE_BITS: i32 = 4;
/// Cells along a side.
pub(super) const SIDE: i32 = 1 << SIDE_BITS;
const SLOTS: usize = (SIDE * SIDE) as usize;

/// Cells by their place in the block, row after row.
#[derive(Clone, Debug)]
pub(super) struct Block {
    slots: Box<[Option<Cell>; SLOTS]>,
    cells: u16,
}

/// The block of a cell.
pub(super) fn block_of(cell: IVec2) -> IVec2 {
    cell >> SIDE_BITS
}

fn slot_of(cell: IVec2) -> usize {
    let place = cell & (SIDE - 1);
    (place.y * SIDE + place.x) as usize
}

impl Block {
    pub(super) const BYTES: usize = size_of::<Self>() + size_of::<[Option<Cell>; SLOTS]>();

    pub(super) fn new() -> Self {
        Self { slots: Box::new([const { None }; SLOTS]), cells: 0 }
    }

    pub(super) fn get(&self, cell: IVec2) -> Option<&Cell> {
        self.slots[slot_of(cell)].as_ref()
    }

    /// Puts a cell in and gives back what was there.
    pub(super) fn insert(&mut self, cell: IVec2, content: Cell) -> Option<Cell> {
        let before = self.slots[slot_of(cell)].replace(content);
        self.cells += u16::from(before.is_none());
        before
    }

    pub(super) fn remove(&mut self, cell: IVec2) -> Option<Cell> {
        let content = self.slots[slot_of(cell)].take()?;
        self.cells -= 1;
        Some(content)
    }

    pub(super) fn is_empty(&self) -> bool {
        self.cells == 0
    }

    /// The block's cells, row after row; `block` is its place.
    pub(super) fn cells(&self, block: IVec2) -> impl Iterator<Item = (IVec2, &Cell)> {
        let cell = move |slot: usize| (block << SIDE_BITS) + IVec2::new(slot as i32 % SIDE, slot as i32 / SIDE);
        self.slots.iter().enumerate().filter_map(move |(slot, content)| Some((cell(slot), content.as_ref()?)))
    }
}
