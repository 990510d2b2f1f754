//! What a game has taken from the stand of a forest, and added to it, cell by cell.

use bevy::{math::IVec2, platform::collections::HashMap};

/// What is other with the stand of a cell. Stems that were aged or made others count as they were.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct CellBalance {
    /// Share of the plan's stems that is left.
    pub left: f32,
    /// Frontal area of stems that were planted, m^2, and that times their heights, m^3.
    pub added_m2: f32,
    pub added_m3: f32,
}

impl Default for CellBalance {
    fn default() -> Self {
        Self { left: 1.0, added_m2: 0.0, added_m3: 0.0 }
    }
}

/// The cells whose stands are not as the plan has them.
pub(super) type CellBalances = HashMap<IVec2, CellBalance>;
