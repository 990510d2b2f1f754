//! Trees that wait for meshes of the levels that were selected for them: others stand for these meanwhile.

use super::components::DrawnTree;
use crate::{
    render::{
        instances::components::TreeInstance,
        lod::thresholds::LodSelection,
        species::library::{PreparedVariant, SpeciesLibrary},
    },
    tree::{Season, Tree},
};
use bevy::prelude::*;

/// Trees that were not drawn as was selected.
#[derive(Resource, Default)]
pub(crate) struct WaitingTrees(pub Vec<Entity>);

/// The levels that are drawn of a tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct DrawnLevels {
    pub first: u8,
    /// The one that the first fades into.
    pub next: Option<u8>,
    /// Whether they are those that were selected.
    pub is_complete: bool,
}

impl DrawnLevels {
    /// Those for a selection, as far as they are on the GPU.
    pub fn of(variant: &PreparedVariant, selection: &LodSelection, is_bare: bool) -> Self {
        let there = variant.parts_there();
        let last = variant.lods.len().saturating_sub(1) as u8;
        Self::new(selection, last, |level| there.contains(variant.parts_of(level, is_bare)))
    }

    /// In place of a level that is not there the next coarser one is drawn, and of a pair of which one is not there the other: none of
    /// them fades then. The last stands for all, whatever is there of it.
    fn new(selection: &LodSelection, last: u8, is_there: impl Fn(u8) -> bool) -> Self {
        let lod = selection.lod.min(last);
        let next = (selection.is_fading && lod < last).then_some(lod + 1);
        if is_there(lod) && next.is_none_or(&is_there) {
            return Self { first: lod, next, is_complete: true };
        }
        let first = (lod..last).find(|level| is_there(*level)).unwrap_or(last);
        Self { first, next: None, is_complete: false }
    }
}

/// Asks for what trees wait for, and has them drawn anew once it is there.
pub(crate) fn redraw_waiting_trees(
    season: Res<Season>,
    mut library: ResMut<SpeciesLibrary>,
    mut waiting: ResMut<WaitingTrees>,
    mut trees: Query<(&Tree, &TreeInstance, &LodSelection, &mut DrawnTree)>,
) {
    let library = library.bypass_change_detection();
    let trees_waiting = &mut waiting.bypass_change_detection().0;
    trees_waiting.sort_unstable();
    trees_waiting.dedup();
    trees_waiting.retain(|tree| {
        let Ok((tree, instance, selection, mut drawn)) = trees.get_mut(*tree) else { return false };
        let species = tree.species.id();
        let is_bare = library.is_bare(species, season.wrapped() + tree.season_shift());
        let Some(variant) = library.variant(species, instance.model) else { return false };
        let DrawnLevels { is_complete, .. } = DrawnLevels::of(variant, selection, is_bare);
        if is_complete {
            drawn.selection = None;
            return false;
        }
        let next = selection.lod + u8::from(selection.is_fading);
        library.want(species, instance.model, |variant| {
            variant.parts_of(selection.lod, is_bare).and(variant.parts_of(next, is_bare))
        });
        true
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    const LAST: u8 = 2;

    #[test]
    fn whatever_is_there_a_tree_is_drawn_once_and_by_the_nearest_level() {
        for lod in 0..=LAST {
            for is_fading in [false, true] {
                for there in 0..4_u8 {
                    // The last is always there.
                    let is_there = |level: u8| level == LAST || there >> level & 1 == 1;
                    let selection = LodSelection { lod, is_fading, ..default() };
                    let DrawnLevels { first, next, is_complete } = DrawnLevels::new(&selection, LAST, is_there);
                    assert!(is_there(first) && first >= lod);
                    assert!((lod..first).all(|finer| !is_there(finer)), "a finer one is there");
                    match next {
                        Some(next) => assert!(is_fading && (first, next) == (lod, lod + 1) && is_there(next)),
                        None => assert!(!is_complete || !is_fading || lod == LAST),
                    }
                    let is_selected = is_there(lod) && (!is_fading || lod == LAST || is_there(lod + 1));
                    assert_eq!(is_complete, is_selected);
                }
            }
        }
    }

    #[test]
    fn the_last_level_stands_in_even_if_it_lacks_the_wood_of_a_bare_tree() {
        let selection = LodSelection { lod: LAST, ..default() };
        let expected = DrawnLevels { first: LAST, next: None, is_complete: false };
        assert_eq!(DrawnLevels::new(&selection, LAST, |_| false), expected);
    }
}
