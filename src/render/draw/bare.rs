//! Draws trees anew that have lost their leaves, or got new ones: bare trees have more of their twigs.

use super::components::DrawnTree;
use crate::{
    render::species::library::SpeciesLibrary,
    tree::{Season, Tree},
};
use bevy::prelude::*;

/// Trees that are looked at in a frame, at most. Leaves fall over weeks.
const LOOKED_AT_PER_FRAME: usize = 256;

/// Has trees drawn anew whose leaves have all come down, or begin to unfold.
pub(crate) fn redraw_bare_trees(
    season: Res<Season>,
    library: Res<SpeciesLibrary>,
    mut due: Local<Vec<Entity>>,
    mut looked_at_year: Local<f32>,
    drawn: Query<Entity, With<DrawnTree>>,
    mut trees: Query<(&Tree, &mut DrawnTree)>,
) {
    let year = season.wrapped();
    if due.is_empty() {
        if *looked_at_year == year {
            return;
        }
        *looked_at_year = year;
        due.extend(&drawn);
    }
    let rest = due.len().saturating_sub(LOOKED_AT_PER_FRAME);
    for entity in due.drain(rest..) {
        let Ok((tree, mut drawn)) = trees.get_mut(entity) else { continue };
        let is_bare = library.is_bare(tree.species.id(), year + tree.season_shift());
        if drawn.selection.is_some() && drawn.is_bare != is_bare {
            drawn.selection = None;
        }
    }
}
