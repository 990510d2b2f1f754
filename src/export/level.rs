//! The levels of a tree as surfaces of one material each.

use super::{
    look::SpeciesLook,
    settings::{ExportLevels, ExportSettings},
    surface::{Part, Surface},
    tree::ExportedTree,
};
use crate::{
    lod::{Lens, LodScreenSizes, thinned_meshes},
    tree::vertices::{LeafVertices, WoodVertices},
};

/// One level of detail.
pub(super) struct Level {
    /// 0 is the full tree.
    pub number: u32,
    /// In the order of [`Part`]; a part without triangles is left out.
    pub parts: Vec<(Part, Surface)>,
}

/// The levels that the settings ask for, from the finest to the coarsest.
pub(super) fn levels(tree: &ExportedTree, look: &SpeciesLook, settings: &ExportSettings) -> Vec<Level> {
    let is_wanted = |number: u32| match settings.levels {
        ExportLevels::One(level) => level == number,
        ExportLevels::Lod | ExportLevels::Nodes => true,
    };
    let mut levels = Vec::new();
    if is_wanted(0) {
        levels.push(level(0, &tree.model.wood, &tree.model.leaves, tree, look));
    }
    if settings.levels == ExportLevels::One(0) {
        return levels;
    }
    let is_bare = tree.model.leaf_season.share(settings.year) == 0.0;
    for (number, thinned) in (1..).zip(thinned_meshes(tree.species, tree.model, &settings.bake)) {
        if is_wanted(number) {
            let bare_wood = thinned.bare_wood.as_ref().filter(|_| is_bare);
            let wood = bare_wood.unwrap_or(&thinned.meshes.wood);
            levels.push(level(number, wood, &thinned.meshes.leaves, tree, look));
        }
    }
    levels
}

fn level(number: u32, wood: &WoodVertices, leaves: &LeafVertices, tree: &ExportedTree, look: &SpeciesLook) -> Level {
    let [in_leaf, bare] = Surface::of_leaves(leaves, &look.leaves);
    let wood = Surface::of_wood(wood, &tree.model.beams, &look.wood);
    let parts = [(Part::Wood, wood), (Part::Leaves, in_leaf), (Part::BareSprays, bare)];
    Level { number, parts: parts.into_iter().filter(|(_, surface)| !surface.indices.is_empty()).collect() }
}

/// The least share of a picture's height that a tree has at each of so many levels, as the renderer chooses them; the last is drawn
/// however small it is.
pub(super) fn screen_coverages(count: usize) -> Vec<f32> {
    let (sizes, lens) = (LodScreenSizes::default(), Lens::default());
    let distances_m = sizes.distances_of_three_m(1.0, lens);
    let share = |distance_m: f32| lens.pixels_at_1_m() / distance_m / lens.picture_px;
    (0..count).map(|level| if level + 1 == count { 0.0 } else { share(distances_m[level]) }).collect()
}
