//! The wind among the trees of a forest follows its changes, and the leaves that come and fall.

use super::{
    cells::ForestCells,
    change_index::{ChangeIndex, TileChanges},
    forest_stand::{DueStand, RenewedStand, tiles_that_feel},
    reach::tile_of,
    stand::{Stand, StandSpecies},
    stand_changes::CellBalances,
};
use crate::{background::spawn_work, tree::Season};
use bevy::{platform::collections::HashSet, prelude::*};
use std::sync::Arc;

/// From one renewal to the next there are at least so many frames: where much is felled, not each tree has the wind worked out again.
const FRAMES_BETWEEN: u32 = 30;

/// Works the stand of forests out again, in the background, where much or little of them was felled or planted, or has other leaves.
pub(super) fn renew_stands(mut frames: Local<u32>, season: Res<Season>, mut forests: Query<&mut ForestCells>) {
    *frames = frames.wrapping_add(1);
    for mut forest in &mut forests {
        let forest = forest.bypass_change_detection();
        if let Err(panic) = forest.stand.receive() {
            forest.tell(&panic);
        }
        if !frames.is_multiple_of(FRAMES_BETWEEN) || forest.stand.is_being_renewed() {
            continue;
        }
        let Some(before) = forest.stand.get().map(|stands| stands.own.clone()) else { continue };
        let now = |species: &Option<StandSpecies>| species.map(|species| species.in_season(season.wrapped()));
        if before.species.iter().any(|species| now(species) != *species) {
            forest.stand.note_changes();
        }
        if !forest.stand.has_due() {
            continue;
        }
        let species = before.species.iter().map(now).collect();
        let (index, tile_cells) = (forest.changes.as_ref(), forest.tile_cells);
        forest.stand.renew(|due| {
            let changes = due_changes(&due, index, tile_cells);
            spawn_work(move || renewed(&before, species, &due, &changes, tile_cells))
        });
    }
}

/// The changes of the tiles that have something due.
fn due_changes(due: &DueStand, index: Option<&ChangeIndex>, tile_cells: i32) -> Vec<Arc<TileChanges>> {
    let Some(index) = index else { return Vec::new() };
    if due.everywhere {
        return index.tiles();
    }
    let tiles: HashSet<IVec2> = due.cells.iter().map(|cell| tile_of(*cell, tile_cells)).collect();
    tiles.into_iter().filter_map(|tile| index.tile(tile)).collect()
}

/// A stand after what is due of it.
fn renewed(
    before: &Stand,
    species: Vec<Option<StandSpecies>>,
    due: &DueStand,
    changes: &[Arc<TileChanges>],
    tile_cells: i32,
) -> RenewedStand {
    let is_due = |cell: &IVec2| due.everywhere || due.cells.contains(cell);
    let kept = before.balances.iter().filter(|(cell, _)| !is_due(cell));
    let mut balances: CellBalances = kept.map(|(cell, balance)| (*cell, *balance)).collect();
    for tile in changes {
        balances.extend(tile_balances(tile, before, &species, is_due));
    }
    let (planter, ground) = (before.planter.clone(), before.ground.clone());
    let tiles = (!due.everywhere).then(|| tiles_that_feel(&due.cells, planter.cell_m(), tile_cells));
    (Stand { planter, ground, species, balances }, tiles)
}

/// Sums the changes of a tile up, in those of its cells that are asked for. Cells in which something was felled are planted, to know how many
/// stems there were: some ten microseconds each.
fn tile_balances(
    changes: &TileChanges,
    Stand { planter, ground, .. }: &Stand,
    species: &[Option<StandSpecies>],
    is_asked: impl Fn(&IVec2) -> bool,
) -> CellBalances {
    let mut balances = CellBalances::default();
    let mut plants = Vec::new();
    for (cell, felled) in changes.felled_by_cell(planter).into_iter().filter(|(cell, _)| is_asked(cell)) {
        planter.plant(cell, ground, &mut plants);
        let stems = plants.len().max(1) as f32;
        balances.entry(cell).or_default().left = 1.0 - (felled as f32).min(stems) / stems;
    }
    for (cell, number, age_years) in changes.planted().filter(|(cell, ..)| is_asked(cell)) {
        let Some(Some(species)) = species.get(usize::from(number)) else { continue };
        let (area_m2, height_m) = species.tree_at(age_years);
        let balance = balances.entry(cell).or_default();
        balance.added_m2 += area_m2;
        balance.added_m3 += area_m2 * height_m;
    }
    balances
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        forest::{
            changes::{ForestChanges, NewStem},
            stand::test_stand,
            stem_id::StemId,
        },
        scatter::Planted,
    };

    const TILE_CELLS: i32 = 4;

    /// Fells so many stems of a cell.
    fn fell(changes: &mut ForestChanges, stand: &Stand, cell: IVec2, stems: usize) {
        let mut plants: Vec<Planted> = Vec::new();
        stand.planter.plant(cell, &stand.ground, &mut plants);
        for plant in &plants[..stems] {
            changes.fell(StemId::at(plant.position.xz())).expect("a stem of the plan");
        }
    }

    fn renew(before: &Stand, due: &DueStand, changes: &ForestChanges) -> RenewedStand {
        let index = ChangeIndex::of(changes, &before.planter, TILE_CELLS);
        renewed(before, before.species.clone(), due, &due_changes(due, Some(&index), TILE_CELLS), TILE_CELLS)
    }

    /// Cells one after another, and all at once: some felled, one of them planted again, one as in the plan again.
    #[test]
    fn what_is_due_is_renewed_and_the_rest_stays() {
        let (mut stand, mut changes) = (test_stand::wood(), ForestChanges::default());
        let cells = [IVec2::new(0, 0), IVec2::new(1, 0), IVec2::new(5, 3)];
        for (number, cell) in cells.into_iter().enumerate() {
            fell(&mut changes, &stand, cell, 5 + number);
            let due = DueStand { everywhere: false, cells: [cell].into_iter().collect() };
            let (renewed, tiles) = renew(&stand, &due, &changes);
            let tiles = tiles.expect("one cell is not everywhere");
            assert!(tiles.contains(&tile_of(cell, TILE_CELLS)) && !tiles.contains(&IVec2::new(20, 20)));
            stand = renewed;
        }
        let place_m = Vec2::splat(0.5 * stand.planter.cell_m());
        let species = stand.planter.species()[0].clone();
        changes.plant(&NewStem { place_m, species, age_years: 30.0 }).expect("a good stem");
        let felled: Vec<StemId> = changes.felled().collect();
        let is_in = |id: &&StemId| stand.planter.cell_at(id.place_m().expect("of the plan")) == cells[2];
        felled.iter().filter(is_in).for_each(|id| changes.restore(*id).expect("it was felled"));
        let due = DueStand { everywhere: false, cells: [cells[0], cells[2]].into_iter().collect() };
        let (step_by_step, _) = renew(&stand, &due, &changes);
        let (at_once, tiles) = renew(&test_stand::wood(), &DueStand { everywhere: true, ..default() }, &changes);
        assert_eq!((tiles, &at_once.balances), (None, &step_by_step.balances));
        assert_eq!(at_once.balances.len(), 2);
        assert!(at_once.balances[&cells[0]].added_m2 > 0.0 && at_once.balances[&cells[1]].left < 1.0);
    }
}
