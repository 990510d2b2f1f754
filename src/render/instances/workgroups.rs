//! The workgroups of the pose pass: each poses a run of 64 beams of one tree.

use super::tag::ROW_BITS;
use crate::render::buffers::dirty_table::DirtyTable;

/// Beams that a workgroup poses.
pub(crate) const WORKGROUP_SIZE: u32 = 64;

/// An entry without a tree. Its run would lie beyond the beams of any tree, so its workgroup has nothing to do.
const UNUSED: u32 = u32::MAX;

/// The list is compacted when more than one entry of so many is unused.
const MAX_UNUSED_SHARE: u32 = 5;

/// One entry a workgroup. The entries of one tree lie side by side.
#[derive(Default)]
pub(crate) struct PoseWorkgroups {
    pub table: DirtyTable<u32>,
    unused: u32,
}

/// The entry of the run of beams from `64 run` on of a row's tree, as the shader reads it: the row in the low bits.
fn entry(row: u32, run: u32) -> u32 {
    row | run << ROW_BITS
}

impl PoseWorkgroups {
    /// Workgroups for so many poses.
    fn count(poses: u32) -> u32 {
        poses.div_ceil(WORKGROUP_SIZE)
    }

    /// Adds those of a tree with so many poses. Returns the place of the first.
    pub fn add(&mut self, row: u32, poses: u32) -> u32 {
        let first = self.table.len();
        self.table.grow_to(first + Self::count(poses));
        for run in 0..Self::count(poses) {
            self.table.write(first + run, entry(row, run));
        }
        first
    }

    /// Removes those of a tree with so many poses that lie from `first` on.
    pub fn remove(&mut self, first: u32, poses: u32) {
        (first..first + Self::count(poses)).for_each(|place| self.table.write(place, UNUSED));
        self.unused += Self::count(poses);
    }

    /// Compacts the list where too much of it is unused. Calls `moved` with each row and the new place of its first entry.
    pub fn compact(&mut self, mut moved: impl FnMut(u32, u32)) {
        if self.unused * MAX_UNUSED_SHARE <= self.table.len() {
            return;
        }
        let mut end = 0;
        for place in 0..self.table.len() {
            let Some(&used) = self.table.get(place).filter(|entry| **entry != UNUSED) else { continue };
            let row = used & ((1 << ROW_BITS) - 1);
            if used == entry(row, 0) {
                moved(row, end);
            }
            if place != end {
                self.table.write(end, used);
            }
            end += 1;
        }
        self.table.truncate(end);
        self.unused = 0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy::platform::collections::HashMap;
    use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};

    #[test]
    fn posed_trees_have_all_their_workgroups_and_others_have_none() {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(1);
        let (mut workgroups, mut posed) = (PoseWorkgroups::default(), HashMap::<u32, (u32, u32)>::default());
        for _ in 0..3000 {
            let row = random.random_range(0..200);
            match posed.remove(&row) {
                Some((first, poses)) => workgroups.remove(first, poses),
                None => {
                    let poses = random.random_range(1..300);
                    posed.insert(row, (workgroups.add(row, poses), poses));
                }
            }
            workgroups.compact(|row, first| {
                if let Some(at) = posed.get_mut(&row) {
                    at.0 = first;
                }
            });
            for (row, (first, poses)) in &posed {
                let expected = (0..poses.div_ceil(WORKGROUP_SIZE)).map(|run| entry(*row, run));
                assert!(workgroups.table.rows()[*first as usize..].iter().copied().zip(expected).all(|(a, b)| a == b));
            }
            let busy = workgroups.table.rows().iter().filter(|entry| **entry != UNUSED).count();
            let wanted: u32 = posed.values().map(|(_, poses)| poses.div_ceil(WORKGROUP_SIZE)).sum();
            assert_eq!(busy as u32, wanted);
            assert!(
                workgroups.table.len() <= wanted * MAX_UNUSED_SHARE / (MAX_UNUSED_SHARE - 1),
                "{} {wanted}",
                workgroups.table.len()
            );
        }
    }
}
