//! What is posed, as the graphics processor reads it: the chunks of beams of every tree that is, a workgroup each.

use super::{
    rows::{CHUNK, pose_chunk},
    table::Table,
};

/// A place in the list that is no tree's. As a chunk it would lie beyond the beams of any tree, so that its workgroup finds
/// nothing to do.
const NOBODY: u32 = u32::MAX;

/// The list is put together again when more than this share of it is nobody's.
const IDLE_SHARE: u32 = 5;

/// The chunks that are posed. Those of one tree lie side by side.
#[derive(Default)]
pub(super) struct Chunks {
    pub table: Table<u32>,
    idle: u32,
}

impl Chunks {
    /// Chunks of so many poses.
    fn count(poses: u32) -> u32 {
        poses.div_ceil(CHUNK)
    }

    /// Adds those of a tree with so many poses, and says where.
    pub fn add(&mut self, row: u32, poses: u32) -> u32 {
        let first = self.table.len();
        self.table.reach(first + Self::count(poses));
        for chunk in 0..Self::count(poses) {
            self.table.write(first + chunk, pose_chunk(row, chunk));
        }
        first
    }

    /// Takes away those of a tree with so many poses that lie at `first`.
    pub fn remove(&mut self, first: u32, poses: u32) {
        (first..first + Self::count(poses)).for_each(|place| self.table.write(place, NOBODY));
        self.idle += Self::count(poses);
    }

    /// Moves what is posed together where too much of the list is nobody's, and tells where the chunks of each row lie now.
    pub fn tidy(&mut self, mut tell: impl FnMut(u32, u32)) {
        if self.idle * IDLE_SHARE <= self.table.len() {
            return;
        }
        let mut end = 0;
        for place in 0..self.table.len() {
            let Some(&chunk) = self.table.get(place).filter(|chunk| **chunk != NOBODY) else { continue };
            let row = chunk & 0xffff;
            if chunk == pose_chunk(row, 0) {
                tell(row, end);
            }
            if place != end {
                self.table.write(end, chunk);
            }
            end += 1;
        }
        self.table.truncate(end);
        self.idle = 0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy::platform::collections::HashMap;
    use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};

    #[test]
    fn whoever_is_posed_has_all_chunks_and_nobody_else_has_any() {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(1);
        let (mut chunks, mut posed) = (Chunks::default(), HashMap::<u32, (u32, u32)>::default());
        for _ in 0..3000 {
            let row = random.random_range(0..200);
            match posed.remove(&row) {
                Some((first, poses)) => chunks.remove(first, poses),
                None => {
                    let poses = random.random_range(1..300);
                    posed.insert(row, (chunks.add(row, poses), poses));
                }
            }
            chunks.tidy(|row, first| {
                if let Some(at) = posed.get_mut(&row) {
                    at.0 = first;
                }
            });
            for (row, (first, poses)) in &posed {
                let expected = (0..poses.div_ceil(CHUNK)).map(|chunk| pose_chunk(*row, chunk));
                assert!(chunks.table.rows()[*first as usize..].iter().copied().zip(expected).all(|(a, b)| a == b));
            }
            let busy = chunks.table.rows().iter().filter(|chunk| **chunk != NOBODY).count();
            let wanted: u32 = posed.values().map(|(_, poses)| poses.div_ceil(CHUNK)).sum();
            assert_eq!(busy as u32, wanted);
            assert!(chunks.table.len() <= wanted * IDLE_SHARE / (IDLE_SHARE - 1), "{} {wanted}", chunks.table.len());
        }
    }
}
