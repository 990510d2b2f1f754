//! Takes the changes of forests over.

use super::{
    cells::ForestCells, change_index::ChangeIndex, changed_cells::FelledStem, changes::ForestChanges,
    falling::FallingTree, journal::Journal, messages::TreeFelled, stem_id::StemId,
};
#[cfg(feature = "render")]
use crate::render::instances::components::HasImpostor;
use crate::tree::Grown;
use bevy::prelude::*;

/// Takes changes over that were made since the last frame, or that a forest which begins anew has to know.
pub(super) fn apply_changes(
    mut commands: Commands,
    mut forests: Query<(Entity, &mut ForestCells, Option<&mut ForestChanges>)>,
    grown: Query<(), With<Grown>>,
    mut felled: MessageWriter<TreeFelled>,
) {
    for (forest, mut cells, changes) in &mut forests {
        let knows_none = cells.changes.as_ref().is_none_or(ChangeIndex::is_empty);
        let has_begun = cells.changes.is_none();
        let stems = match changes {
            Some(mut changes) if has_begun || changes.is_changed() => {
                let journal = changes.bypass_change_detection().journal.take();
                let journal = if has_begun { Journal::All } else { journal };
                cells.apply(&changes, journal)
            }
            None if has_begun || !knows_none => cells.apply(&ForestChanges::default(), Journal::All),
            _ => continue,
        };
        for FelledStem { stem, place, species, tree } in stems {
            let tree = tree.map(|tree| tree.entity);
            if let Some(tree) = tree {
                let falls = cells.settings().felled_trees_fall && grown.contains(tree);
                fell_or_remove(tree, falls, &mut commands);
            }
            felled.write(TreeFelled { forest, tree, id: stem.id, place, species });
        }
    }
}

/// Lets a tree fall, or removes it.
fn fell_or_remove(tree: Entity, falls: bool, commands: &mut Commands) {
    // The game may have despawned it.
    let Ok(mut tree) = commands.get_entity(tree) else { return };
    if !falls {
        tree.try_despawn();
        return;
    }
    tree.try_remove::<StemId>().try_insert(FallingTree::default());
    #[cfg(feature = "render")]
    tree.try_remove::<HasImpostor>();
}
