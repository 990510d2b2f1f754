//! The wind among the trees of a forest follows its changes.

use super::{cells::ForestCells, stand::Stand, stand_changes::balances};
use bevy::{
    prelude::*,
    tasks::{AsyncComputeTaskPool, block_on, poll_once},
};

/// From one renewal to the next there are at least so many frames: where much is felled, not each tree has the wind worked out again.
const FRAMES_BETWEEN: u32 = 30;

/// Works the stand of forests out again, in the background, when much or little of them was felled or planted near the viewers.
pub(super) fn renew_stands(mut frames: Local<u32>, mut forests: Query<&mut ForestCells>) {
    *frames = frames.wrapping_add(1);
    for mut forest in &mut forests {
        let forest = forest.bypass_change_detection();
        if let Some(task) = &mut forest.stand_task {
            let Some(stand) = block_on(poll_once(task)) else { continue };
            forest.stand_task = None;
            forest.set_stand(stand);
        }
        if !forest.stand_is_due || !frames.is_multiple_of(FRAMES_BETWEEN) {
            continue;
        }
        let (Some(stand), Some(index)) = (forest.stand(), &forest.changes) else { continue };
        let (planter, ground, species) = (stand.planter.clone(), stand.ground.clone(), stand.species.clone());
        let tiles = index.tiles();
        forest.stand_is_due = false;
        forest.stand_task = Some(AsyncComputeTaskPool::get().spawn(async move {
            let balances = balances(&tiles, &planter, &ground, &species);
            Stand { planter, ground, species, balances }
        }));
    }
}
