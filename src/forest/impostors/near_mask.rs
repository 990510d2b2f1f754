//! Tells the shader of impostors which cells' trees are drawn as entities.

use super::tiles::ForestImpostors;
use crate::{
    forest::cells::ForestCells,
    render::{impostors::near_mask::NearMask, lod::impostor_range::ImpostorRange},
    viewpoint::Viewpoints,
};
use bevy::{prelude::*, render::storage::ShaderBuffer};

/// Trees give way to impostors at this share, at the latest, of the distance to which all of them stand as entities: the fade must end
/// before it.
const TREES_END_AT: f32 = 0.88;

/// Uploads which cells are drawn, where that has changed.
pub(super) fn update_near_mask(
    mut mask: ResMut<NearMask>,
    mut buffers: ResMut<Assets<ShaderBuffer>>,
    viewpoints: Viewpoints,
    mut impostors: ResMut<ImpostorRange>,
    forests: Query<(&ForestCells, Option<&ForestImpostors>)>,
) {
    let Some((forest, tiles)) = forests.iter().next() else { return };
    // Trees do not fade before there is something to stand for them.
    let is_complete = tiles.is_some_and(ForestImpostors::is_complete);
    let from_m = if is_complete {
        Some(TREES_END_AT * forest.settings().trees_to_m)
    } else {
        impostors.from_m.filter(|_| tiles.is_some())
    };
    impostors.set_if_neq(ImpostorRange { from_m });
    let Some(centre) = viewpoints.iter().next().map(|eye| forest.planter().cell_at(eye.xz())) else { return };
    let (cell_m, far_to_m) = (forest.planter().cell_m(), forest.settings().far_to_m);
    mask.update(centre, cell_m, far_to_m, forest.near.drawn_cells(), &mut buffers);
}
