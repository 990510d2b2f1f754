//! The wind among the trees of a forest follows its changes, and the leaves that come and fall.

use super::{
    cells::ForestCells,
    change_index::{ChangeIndex, TileChanges},
    stand::{Stand, StandSpecies},
    stand_changes::CellBalances,
};
use crate::{background::spawn_work, ground::Ground, scatter::Planter, tree::Season};
use bevy::{
    prelude::*,
    tasks::{block_on, poll_once},
};
use std::sync::Arc;

/// From one renewal to the next there are at least so many frames: where much is felled, not each tree has the wind worked out again.
const FRAMES_BETWEEN: u32 = 30;

/// Works the stand of forests out again, in the background, when much or little of them was felled or planted near the viewers, or has other leaves.
pub(super) fn renew_stands(mut frames: Local<u32>, season: Res<Season>, mut forests: Query<&mut ForestCells>) {
    *frames = frames.wrapping_add(1);
    for mut forest in &mut forests {
        let forest = forest.bypass_change_detection();
        if let Some(task) = &mut forest.stand_task {
            let Some(stand) = block_on(poll_once(task)) else { continue };
            forest.stand_task = None;
            match stand {
                Ok(stand) => forest.set_stand(stand),
                Err(panic) => forest.tell(&panic),
            }
        }
        if !frames.is_multiple_of(FRAMES_BETWEEN) {
            continue;
        }
        let Some(stand) = forest.stands().map(|stands| &stands.own) else { continue };
        let now = |species: &Option<StandSpecies>| species.map(|species| species.in_season(season.wrapped()));
        if !forest.stand_is_due && stand.species.iter().all(|species| now(species) == *species) {
            continue;
        }
        let (planter, ground) = (stand.planter.clone(), stand.ground.clone());
        let species: Vec<_> = stand.species.iter().map(now).collect();
        let tiles = forest.changes.as_ref().map_or_else(Vec::new, ChangeIndex::tiles);
        forest.stand_is_due = false;
        forest.stand_task = Some(spawn_work(move || {
            let balances = balances(&tiles, &planter, &ground, &species);
            Stand { planter, ground, species, balances }
        }));
    }
}

/// Sums the changes of tiles up. Cells in which something was felled are planted, to know how many stems there were: some ten microseconds
/// each.
fn balances(
    tiles: &[Arc<TileChanges>],
    planter: &Planter,
    ground: &impl Ground,
    species: &[Option<StandSpecies>],
) -> CellBalances {
    let mut balances = CellBalances::default();
    let mut plants = Vec::new();
    for tile in tiles {
        for (cell, felled) in tile.felled_by_cell(planter) {
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
