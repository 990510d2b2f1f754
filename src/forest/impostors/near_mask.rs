//! Tells trees from where on impostors stand for them, and the shader of impostors which cells' trees are drawn as entities.

use super::tiles::ForestImpostors;
use crate::{
    forest::cells::ForestCells,
    render::{
        buffers::table_uploads::TableUploads, impostors::near_mask::NearMasks, instances::components::HasImpostor,
        lod::viewers::LodViewers,
    },
};
use bevy::prelude::*;

/// Trees give way to impostors at this share, at the latest, of the distance to which all of them stand as entities: the fade must end
/// before it.
const TREES_END_AT: f32 = 0.88;

/// Writes where that has changed: forest by forest, since each has cells and distances of its own.
pub(super) fn update_near_masks(
    mut commands: Commands,
    mut masks: ResMut<NearMasks>,
    mut uploads: TableUploads,
    mut viewers: ResMut<LodViewers>,
    mut forests: Query<(&mut ForestCells, Option<&mut ForestImpostors>)>,
) {
    for (mut forest, mut tiles) in &mut forests {
        let settings = forest.settings();
        // Trees do not fade before there is something to stand for them.
        let from_m = match &tiles {
            Some(tiles) if tiles.is_complete() => Some(TREES_END_AT * settings.trees_to_m),
            Some(_) => forest.impostors_from_m,
            None => None,
        };
        if forest.impostors_from_m != from_m {
            forest.impostors_from_m = from_m;
            viewers.is_due = true;
            for tree in forest.near.trees() {
                commands.entity(tree).try_insert(HasImpostor { from_m });
            }
        }
        if let Some(tiles) = &mut tiles {
            tiles.mark_near_cells(&forest, &mut masks);
        }
    }
    masks.upload(&mut uploads);
}

/// Gives the masks of tiles back that go with their forest, or whose forest begins anew.
pub(super) fn free_near_masks(
    discarded: On<Discard<ForestImpostors>>,
    mut forests: Query<&mut ForestImpostors>,
    mut masks: ResMut<NearMasks>,
) {
    if let Ok(mut tiles) = forests.get_mut(discarded.entity) {
        tiles.take_masks().for_each(|mask| masks.remove(mask));
    }
}
