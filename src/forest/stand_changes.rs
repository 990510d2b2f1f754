//! What a game has taken from the stand of a forest, and added to it, cell by cell.

use super::{change_index::TileChanges, stand::StandSpecies};
use crate::{ground::Ground, scatter::Planter};
use bevy::{math::IVec2, platform::collections::HashMap};
use std::sync::Arc;

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

/// Sums the changes of tiles up. Cells in which something was felled are planted, to know how many stems there were: some ten microseconds
/// each.
pub(super) fn balances(
    tiles: &[Arc<TileChanges>],
    planter: &Planter,
    ground: &impl Ground,
    species: &[Option<StandSpecies>],
) -> CellBalances {
    let mut balances = CellBalances::default();
    let mut plants = Vec::new();
    for tile in tiles {
        for (cell, felled) in tile.felled_by_cell(f64::from(planter.cell_m())) {
            planter.plant(cell, ground, &mut plants);
            let stems = plants.len().max(1) as f32;
            balances.entry(cell).or_default().left = 1.0 - (felled as f32).min(stems) / stems;
        }
        for (cell, number, age_years) in tile.planted() {
            let Some(Some(species)) = species.get(usize::from(number)) else { continue };
            let (area_m2, height_m) = species.tree_at(age_years);
            let balance = balances.entry(cell).or_default();
            balance.added_m2 += area_m2;
            balance.added_m3 += area_m2 * height_m;
        }
    }
    balances
}
