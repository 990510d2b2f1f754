//! How far and how fast.

use crate::setting::{SettingError, require};
use bevy::reflect::Reflect;
use serde::{Deserialize, Serialize};

/// The most cells from a viewer to the keep radius: 830,000 in all.
const FARTHEST_CELLS: f32 = 512.0;

/// How far the forest is planted about viewers, and how fast.
#[derive(Clone, Copy, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct StreamSettings {
    /// Cells nearer than this to a viewer are planted. units: m, domain: 0 to `keep_m` less the side of a cell.
    pub load_m: f32,
    /// Cells farther than this from every viewer are dropped. units: m, domain: up to 512 cells.
    pub keep_m: f32,
    /// The most cells that one step orders. domain: \[1, 100000\].
    pub plants_per_step: u32,
    /// The most cells that are ordered and not yet delivered. domain: \[1, 100000\].
    pub most_ordered: u32,
    /// The most cells that one step drops. domain: \[1, 100000\].
    pub drops_per_step: u32,
}

impl Default for StreamSettings {
    fn default() -> Self {
        Self { load_m: 10_000.0, keep_m: 10_500.0, plants_per_step: 64, most_ordered: 256, drops_per_step: 64 }
    }
}

impl StreamSettings {
    /// Checks every field, for cells with this side, m.
    ///
    /// # Errors
    /// The first field outside its domain.
    pub fn validate(&self, cell_m: f32) -> Result<(), SettingError> {
        require("cell_m", cell_m, 8.0..=8192.0)?;
        require("keep_m", self.keep_m, cell_m..=FARTHEST_CELLS * cell_m)?;
        require("load_m", self.load_m, 0.0..=self.keep_m - cell_m)?;
        require("plants_per_step", self.plants_per_step as f32, 1.0..=1e5)?;
        require("most_ordered", self.most_ordered as f32, 1.0..=1e5)?;
        require("drops_per_step", self.drops_per_step as f32, 1.0..=1e5)
    }
}
