//! Tells trees from where on impostors stand for them, and the shader of impostors which cells' trees are drawn as entities.

use super::{species::ImpostorSpeciesLibrary, tiles::ForestImpostors};
use crate::{
    forest::cells::ForestCells,
    render::{buffers::table_uploads::TableUploads, impostors::near_mask::NearMasks, lod::viewers::LodViewers},
};
use bevy::prelude::*;

/// The fade from trees to impostors ends at this share, at the latest, of the distance to which all trees stand as entities: no less than
/// [`FADE_LAG`](crate::render::lod::thresholds::FADE_LAG) before it.
const FADE_ENDS_AT: f32 = 0.97;

/// Writes where that has changed: forest by forest, since each has cells and distances of its own.
pub(super) fn update_near_masks(
    mut commands: Commands,
    library: Res<ImpostorSpeciesLibrary>,
    mut masks: ResMut<NearMasks>,
    mut uploads: TableUploads,
    mut viewers: ResMut<LodViewers>,
    mut forests: Query<(&mut ForestCells, Option<&mut ForestImpostors>)>,
) {
    let fade = viewers.thresholds.impostor_fade;
    for (mut forest, mut tiles) in &mut forests {
        let settings = forest.settings();
        // Trees do not fade before there is something to stand for them.
        let from_m = match &tiles {
            Some(tiles) if tiles.is_complete() => Some(FADE_ENDS_AT * settings.trees_to_m / (1.0 + fade)),
            Some(_) => forest.impostors_from_m,
            None => None,
        };
        let sizes = || forest.species().iter().map(|species| library.size_of(species.id()));
        if forest.impostors_from_m != from_m || !sizes().eq(forest.impostor_sizes.iter().copied()) {
            let sizes = sizes().collect();
            forest.impostor_sizes = sizes;
            forest.impostors_from_m = from_m;
            viewers.is_due = true;
            if let Some(impostors) = forest.impostors() {
                for tree in forest.near.trees() {
                    commands.entity(tree.entity).try_insert(impostors.of(&tree.plant));
                }
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
