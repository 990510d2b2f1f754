//! Sets of cells, a bit for each.

use crate::cells::block::{SIDE, block_of};
use bevy::{math::IVec2, platform::collections::HashMap};

/// Some cells, block by block. Whole runs of a row come and go at once, so that a disc of a million cells is a matter of
/// some thousand blocks.
#[derive(Clone, Debug, Default)]
pub(super) struct CellBits(HashMap<IVec2, Rows>);

/// A block's cells: a bit each, the least column the lowest.
type Rows = [u16; SIDE as usize];

impl CellBits {
    pub(super) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Number of cells; counts them.
    pub(super) fn len(&self) -> usize {
        self.0.values().flatten().map(|row| row.count_ones() as usize).sum()
    }

    /// The blocks that have cells, in no order.
    pub(super) fn blocks(&self) -> impl Iterator<Item = IVec2> {
        self.0.keys().copied()
    }

    pub(super) fn insert(&mut self, cell: IVec2) {
        self.insert_run(cell.y, cell.x, cell.x);
    }

    pub(super) fn remove(&mut self, cell: IVec2) {
        self.remove_run(cell.y, cell.x, cell.x);
    }

    /// Takes in the cells of a row between these columns, both included.
    pub(super) fn insert_run(&mut self, row: i32, first: i32, last: i32) {
        visit_pieces(row, first, last, |block, row, bits| self.0.entry(block).or_default()[row] |= bits);
    }

    /// Takes the cells of a row between these columns out, both included.
    pub(super) fn remove_run(&mut self, row: i32, first: i32, last: i32) {
        visit_pieces(row, first, last, |block, row, bits| {
            let Some(rows) = self.0.get_mut(&block) else { return };
            rows[row] &= !bits;
            if rows.iter().all(|row| *row == 0) {
                self.0.remove(&block);
            }
        });
    }

    /// Visits the cells of a block, row after row, and keeps those for which `keep` is true.
    pub(super) fn retain(&mut self, block: IVec2, mut keep: impl FnMut(IVec2) -> bool) {
        let Some(rows) = self.0.get_mut(&block) else { return };
        let corner = block * SIDE;
        let mut any = 0;
        for (y, row) in rows.iter_mut().enumerate() {
            let mut left = *row;
            while left != 0 {
                let x = left.trailing_zeros();
                left &= left - 1;
                if !keep(corner + IVec2::new(x as i32, y as i32)) {
                    *row &= !(1 << x);
                }
            }
            any |= *row;
        }
        if any == 0 {
            self.0.remove(&block);
        }
    }

    #[cfg(test)]
    pub(super) fn capacity(&self) -> usize {
        self.0.capacity()
    }
}

/// Visits the parts of a run that lie in one block each: the block, the row in it, and the bits of the columns.
fn visit_pieces(row: i32, first: i32, last: i32, mut visit: impl FnMut(IVec2, usize, u16)) {
    let [from, to] = [first, last].map(|column| block_of(IVec2::new(column, row)));
    for x in from.x..=to.x {
        let [low, high] = [first, last].map(|column| (column - x * SIDE).clamp(0, SIDE - 1));
        let bits = u16::MAX << low & u16::MAX >> (SIDE - 1 - high);
        visit(IVec2::new(x, from.y), (row - from.y * SIDE) as usize, bits);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::collections::BTreeSet;

    fn cells(set: &CellBits) -> BTreeSet<(i32, i32)> {
        let mut all = BTreeSet::new();
        let mut set = set.clone();
        for block in set.blocks().collect::<Vec<_>>() {
            set.retain(block, |cell| all.insert((cell.y, cell.x)));
        }
        all
    }

    proptest! {
        #[test]
        fn runs_equal_single_cells(
            runs in prop::collection::vec((any::<bool>(), -40..40_i32, -60..60_i32, 0..50_i32), 0..40),
        ) {
            let (mut set, mut slow) = (CellBits::default(), BTreeSet::new());
            for (comes, row, first, more) in runs {
                let run = (first..=first + more).map(|column| (row, column));
                if comes {
                    set.insert_run(row, first, first + more);
                    slow.extend(run);
                } else {
                    set.remove_run(row, first, first + more);
                    run.for_each(|cell| { slow.remove(&cell); });
                }
            }
            prop_assert_eq!(set.len(), slow.len());
            prop_assert_eq!(set.is_empty(), slow.is_empty());
            prop_assert_eq!(cells(&set), slow);
        }
    }

    #[test]
    fn cells_that_are_not_kept_are_removed() {
        let mut set = CellBits::default();
        (-20..20).for_each(|row| set.insert_run(row, -20, 19));
        for block in set.blocks().collect::<Vec<_>>() {
            set.retain(block, |cell| cell.x % 2 == 0);
        }
        assert_eq!(set.len(), 800);
        (-20..20).for_each(|column| set.remove(IVec2::new(column, 3)));
        assert_eq!(set.len(), 780);
        for block in set.blocks().collect::<Vec<_>>() {
            set.retain(block, |_| false);
        }
        assert!(set.is_empty());
    }
}
