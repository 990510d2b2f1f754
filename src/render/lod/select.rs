//! Selects the LOD levels of trees.

use super::{
    thresholds::{LodDistance, LodSelection, LodThresholds},
    viewers::LodViewers,
};
use crate::render::{
    instances::components::{HasImpostor, TreeInstance},
    settings::ActiveLevelOfDetail,
};
use bevy::prelude::*;

/// What selection has to know of a tree.
type Selected =
    (Entity, &'static TreeInstance, &'static GlobalTransform, Option<&'static HasImpostor>, &'static mut LodSelection);

/// Selects the levels of trees that have just got an instance, or have moved, and those of all when a viewer has moved. In the latter case
/// no more than so many change in a frame; the rest follow in the next ones.
pub(crate) fn select_lods(
    settings: Res<ActiveLevelOfDetail>,
    mut viewers: ResMut<LodViewers>,
    transforms: TransformHelper,
    mut trees: Query<Selected>,
    new: Query<Entity, Changed<TreeInstance>>,
    moved: Query<Entity, (With<LodSelection>, Changed<GlobalTransform>)>,
) {
    for tree in &new {
        let Ok((entity, instance, _, impostor, mut selection)) = trees.get_mut(tree) else { continue };
        // A tree that was spawned in this frame has no place in the world yet.
        let at = transforms.compute_global_transform(entity).unwrap_or_default();
        *selection = select(&viewers, instance, &at, impostor, None);
    }
    for tree in &moved {
        let Ok((_, instance, at, impostor, mut selection)) = trees.get_mut(tree) else { continue };
        let next = select(&viewers, instance, at, impostor, Some(*selection));
        selection.set_if_neq(next);
    }
    if !std::mem::take(&mut viewers.bypass_change_detection().is_due) {
        return;
    }
    let mut left = settings.0.changes_per_frame;
    for (_, instance, at, impostor, mut selection) in &mut trees {
        let next = select(&viewers, instance, at, impostor, Some(*selection));
        if next == *selection {
            continue;
        }
        if left == 0 {
            viewers.bypass_change_detection().is_due = true;
            return;
        }
        left -= 1;
        *selection = next;
    }
}

fn select(
    viewers: &LodViewers,
    instance: &TreeInstance,
    at: &GlobalTransform,
    impostor: Option<&HasImpostor>,
    before: Option<LodSelection>,
) -> LodSelection {
    select_at(viewers.distance(at.translation()), &viewers.thresholds, instance, at, impostor, before)
}

/// The selection for a tree at a distance.
pub(super) fn select_at(
    distance: LodDistance,
    thresholds: &LodThresholds,
    instance: &TreeInstance,
    at: &GlobalTransform,
    impostor: Option<&HasImpostor>,
    before: Option<LodSelection>,
) -> LodSelection {
    let scale = at.affine().matrix3.y_axis.length();
    let (height_m, count) = (instance.height_m * scale, instance.lod_count);
    match (instance.row, impostor.and_then(|impostor| Some((impostor.from_m?, impostor.height_m * scale)))) {
        (None, _) => thresholds.select_without_fade(distance.scaled_m, height_m, count, before),
        (Some(_), Some(impostor)) => thresholds.select_before_impostor(distance, height_m, count, impostor, before),
        (Some(_), None) => thresholds.select(distance.scaled_m, height_m, count, before),
    }
}
