//! Which level of detail a cell has.
//!
//! A level follows from the size on screen: a tree of height h at distance d measures h·v / (2·d·tan(f/2)) pixels in a
//! picture of v pixels with a vertical field of view f. Solved for the distance this gives three distances at which the
//! levels change. A cell that has a level keeps it until the distance is passed by a margin.

use super::{block::block_of, view::Seen};
use crate::setting::{SettingError, require};
use bevy::{math::IVec2, reflect::Reflect};
use serde::{Deserialize, Serialize};

/// For so many frames an unseen cell's level is remembered: one at the edge of a trembling picture does not change.
const REMEMBERED_FRAMES: u8 = 60;

/// How much of a tree is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Reflect)]
pub enum Level {
    /// The grown tree.
    High,
    /// A trunk and an envelope of leaves.
    Medium,
    /// A few still polygons.
    Low,
    /// Nothing but the colour of the ground.
    #[default]
    Ground,
}

const LEVELS: [Level; 4] = [Level::High, Level::Medium, Level::Low, Level::Ground];

/// How large on screen a tree must be for each level.
#[derive(Clone, Copy, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct LevelDistances {
    /// Trees that measure more have the high level. units: pixels of height, domain: `medium_px` to 100000.
    pub high_px: f32,
    /// Smaller ones that measure more than this have the medium level. units: pixels, domain: `low_px` to 100000.
    pub medium_px: f32,
    /// Smaller ones that measure more than this have the low level; the rest fade into the ground.
    /// units: pixels, domain: \[0.1, 100000\].
    pub low_px: f32,
    /// All distances are multiplied by it: a fast machine has more, a slow one less than 1. domain: \[0.1, 10\].
    pub quality: f32,
    /// By this share of a distance it must be passed before a level changes. domain: \[0, 0.5\].
    pub margin: f32,
}

impl Default for LevelDistances {
    /// Full trees from two fifths of a picture of 1080 pixels on; of 25 m in a view of 45° that is at 80 m, 540 m and 11 km.
    fn default() -> Self {
        Self { high_px: 400.0, medium_px: 60.0, low_px: 3.0, quality: 1.0, margin: 0.08 }
    }
}

/// What makes a picture of what is seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lens {
    /// Vertical field of view. units: rad, domain: (0, π).
    pub fov_rad: f32,
    /// Height of the picture. units: pixels.
    pub picture_px: f32,
}

/// At which distances a tree changes its level.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LevelSwitches {
    at_m: [f32; 3],
    margin: f32,
}

impl LevelDistances {
    /// Checks every field.
    ///
    /// # Errors
    /// The first field outside its domain.
    pub fn validate(&self) -> Result<(), SettingError> {
        require("low_px", self.low_px, 0.1..=1e5)?;
        require("medium_px", self.medium_px, self.low_px..=1e5)?;
        require("high_px", self.high_px, self.medium_px..=1e5)?;
        require("quality", self.quality, 0.1..=10.0)?;
        require("margin", self.margin, 0.0..=0.5)
    }

    /// Where trees of a height, m, change their level. Without a picture (no pixels, no field of view) nothing but the
    /// ground is left.
    pub fn switches(&self, tree_height_m: f32, lens: Lens) -> LevelSwitches {
        let pixels_at_1_m = tree_height_m * lens.picture_px / (2.0 * (0.5 * lens.fov_rad).tan());
        let at_m = [self.high_px, self.medium_px, self.low_px].map(|px| (self.quality * pixels_at_1_m / px).max(0.0));
        LevelSwitches { at_m, margin: self.margin }
    }
}

impl LevelSwitches {
    /// The distances at which the high, the medium and the low level end, m.
    pub fn at_m(&self) -> [f32; 3] {
        self.at_m
    }

    /// The level at a distance, m, of what has had the level `before`. A distance that is no number changes nothing.
    pub fn choose(&self, distance_m: f32, before: Option<Level>) -> Level {
        if distance_m.is_nan() {
            return before.unwrap_or_default();
        }
        let passed = |margin: f32| self.at_m.iter().filter(|&&at_m| distance_m > at_m * (1.0 + margin)).count();
        match before {
            Some(before) => before.clamp(LEVELS[passed(self.margin)], LEVELS[passed(-self.margin)]),
            None => LEVELS[passed(0.0)],
        }
    }
}

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
