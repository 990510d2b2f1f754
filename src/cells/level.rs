//! Which level of detail a cell has: that of a tree at its nearest point.

use super::{block::block_of, view::Seen};
use crate::lod::{Level, LevelSwitches};
use bevy::math::IVec2;

/// For so many frames an unseen cell's level is remembered: one at the edge of a trembling picture does not change.
const REMEMBERED_FRAMES: u8 = 60;

/// The levels of the cells of one camera, from frame to frame.
#[derive(Clone, Debug, Default)]
pub struct CellLevels {
    /// In the order of the store.
    known: Vec<Known>,
    before: Vec<Known>,
}

#[derive(Clone, Copy, Debug)]
struct Known {
    cell: IVec2,
    level: Level,
    unseen_frames: u8,
}

impl CellLevels {
    /// Fills `levels` with the level of each cell of `seen`, which is as [`CellStore::see`](super::CellStore::see) gives
    /// it.
    pub fn choose(&mut self, seen: &[Seen], switches: &LevelSwitches, levels: &mut Vec<Level>) {
        levels.clear();
        std::mem::swap(&mut self.known, &mut self.before);
        self.known.clear();
        let mut before = self.before.iter().peekable();
        for &Seen { cell, distance_m, .. } in seen {
            while let Some(unseen) = before.next_if(|known| order(known.cell) < order(cell)) {
                self.known.extend(unseen.aged());
            }
            let known = before.next_if(|known| known.cell == cell);
            let level = switches.choose(distance_m, known.map(|known| known.level));
            self.known.push(Known { cell, level, unseen_frames: 0 });
            levels.push(level);
        }
        self.known.extend(before.filter_map(Known::aged));
    }

    /// Number of cells whose level is known.
    pub fn len(&self) -> usize {
        self.known.len()
    }

    /// Whether no cell's level is known.
    pub fn is_empty(&self) -> bool {
        self.known.is_empty()
    }
}

impl Known {
    /// A frame later, unseen; `None` when it is forgotten.
    fn aged(&self) -> Option<Self> {
        let unseen_frames = self.unseen_frames + 1;
        (unseen_frames <= REMEMBERED_FRAMES).then_some(Self { unseen_frames, ..*self })
    }
}

/// Cells are in order by this, in a store and here.
fn order(cell: IVec2) -> [i32; 4] {
    let block = block_of(cell);
    [block.y, block.x, cell.y, cell.x]
}

#[cfg(test)]
mod tests;
