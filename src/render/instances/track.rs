//! Keeps the tables up to date with trees that move, and poses those that are visible.

use super::{
    components::{HasImpostor, TreeInstance},
    tables::InstanceTables,
};
use crate::{
    render::{capabilities::RenderCapabilities, lod::thresholds::LodSelection},
    sway::InCanopy,
    tree::Tree,
    wind::Canopy,
};
use bevy::prelude::*;

/// Scales may differ by this share before a tree counts as stretched.
const UNIFORM_TOLERANCE: f32 = 1e-3;

/// A tree whose row may have to be written.
type ChangedTree =
    Or<(Changed<GlobalTransform>, Changed<Tree>, Changed<TreeInstance>, Changed<HasImpostor>, Changed<InCanopy>)>;

/// Writes the rows of trees that are new, were changed or have moved.
pub(crate) fn write_tree_rows(
    mut tables: ResMut<InstanceTables>,
    mut has_warned: Local<bool>,
    trees: Query<
        (Entity, &TreeInstance, &Tree, &GlobalTransform, Option<&HasImpostor>, Option<&InCanopy>),
        ChangedTree,
    >,
    mut left_canopies: RemovedComponents<InCanopy>,
    instances: Query<&TreeInstance, Without<InCanopy>>,
) {
    for tree in left_canopies.read().filter_map(|tree| instances.get(tree).ok()) {
        if let Some(row) = tree.row {
            tables.write_canopy(row, &Canopy::default());
        }
    }
    for (entity, instance, tree, at, impostor, canopy) in &trees {
        let Some(row) = instance.row else { continue };
        tables.write_transform(row, at, tree.season_shift(), instance.height_m);
        let impostor = impostor.and_then(|impostor| Some((impostor.from_m?, impostor.height_m)));
        tables.write_impostor(row, at, impostor);
        tables.write_canopy(row, &canopy.copied().unwrap_or_default().0);
        if !*has_warned && !is_uniform(at.scale()) {
            warn!(
                "windwood: tree {entity} has the scale {}, but a tree in the wind has one scale for all axes; the nearest \
                 is used, for this and for any other such tree",
                at.scale()
            );
            *has_warned = true;
        }
    }
}

fn is_uniform(scale: Vec3) -> bool {
    let scale = scale.abs();
    scale.max_element() - scale.min_element() <= UNIFORM_TOLERANCE * scale.max_element()
}

/// Poses trees that become visible, and no longer those that are hidden: by the game, by a cell that nobody sees, or because their
/// impostor stands for them. Of trees that are drawn at their coarsest level alone no more is posed than what moves that.
pub(crate) fn update_posed_trees(
    mut tables: ResMut<InstanceTables>,
    capabilities: Res<RenderCapabilities>,
    mut has_warned: Local<bool>,
    trees: Query<
        (&TreeInstance, &InheritedVisibility, &LodSelection),
        Or<(Changed<InheritedVisibility>, Changed<LodSelection>, Changed<TreeInstance>)>,
    >,
) {
    let tables = tables.bypass_change_detection();
    for (instance, visibility, selection) in &trees {
        if let Some(row) = instance.row {
            let is_coarsest = !selection.is_fading && selection.lod > 0 && selection.lod + 1 == instance.lod_count;
            let beams = if is_coarsest { instance.coarse_beams } else { u32::MAX };
            tables.set_posed(row, (visibility.get() && !selection.is_impostor).then_some(beams));
        }
    }
    if tables.retry_unposed() && !*has_warned {
        warn!("windwood: this device can pose {} beams at once; trees beyond that stand still", capabilities.max_poses);
        *has_warned = true;
    }
}
