//! The levels of a tree that are its own meshes thinned: how much of it each species bears to lose.

use super::{
    decimate::{DecimatedMeshes, coarse_thick_wood, fewer_leaves, prunable_radius_m, thick_wood},
    screen_size::{Lens, LodScreenSizes},
    settings::{Decimation, LodBakeSettings},
};
use crate::tree::{Growth, Species, TreeModel, crown::impressionist::leaves_at, vertices::WoodVertices};

/// Share of the side of its wood that each level of a tree that sheds its leaves keeps at least: under leaves, and without them, where
/// twigs are all that is seen of a crown. Branches of birches are thin: with all that may be left out under the leaves of an oak, a birch
/// would be a pole in spring.
const LEAST_WOOD_SHARE: f32 = 0.45;
const LEAST_BARE_WOOD_SHARE: f32 = 0.9;

/// A plant with no more vertices of leaves than so many is never thinned: its few leaves, enlarged, would look like another plant.
const SMALL_VERTICES: usize = 2000;

/// Sprays are enlarged to this share of the tree's height at most. By eye: with 0.34 of a young hazel, one saw single leaves that were not
/// its own.
const MOST_SPRAY_HEIGHTS: f32 = 1.0 / 6.0;

/// The meshes of a lower level.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ThinnedMeshes {
    /// Those of the tree in leaf.
    pub meshes: DecimatedMeshes,
    /// The wood of the bare tree, where that is more.
    pub bare_wood: Option<WoodVertices>,
}

/// What is left out at a level.
#[derive(Clone, Copy, Default)]
struct SeasonalDecimation {
    in_leaf: Decimation,
    /// Branches as thick as this stay while the tree is bare, m, where those are more.
    bare_radius_m: Option<f32>,
}

/// The meshes of the lower levels of a tree, from the finest to the coarsest: one for each decimation of the settings.
///
/// Crowns of polygons have the polygons of the distance at which the level begins, on a usual camera's picture.
#[must_use]
pub fn thinned_meshes(species: &Species, model: &TreeModel, settings: &LodBakeSettings) -> Vec<ThinnedMeshes> {
    let levels = settings.decimations.iter().enumerate();
    levels.map(|(number, wanted)| thinned(species, model, number, wanted)).collect()
}

/// One of them: the level of that number, from 0.
pub(crate) fn thinned(species: &Species, model: &TreeModel, number: usize, wanted: &Decimation) -> ThinnedMeshes {
    let decimation = bearable(species, model, wanted);
    let wood = |radius_m| match is_coarse(number) {
        true => coarse_thick_wood(species, &model.skeleton, radius_m),
        false => thick_wood(&model.wood, &model.skeleton, radius_m),
    };
    let leaves = match &species.growth {
        Growth::Impressionist(crown) => {
            let begin_m = LodScreenSizes::default().distances_of_three_m(crown.height_m, Lens::default())[number];
            leaves_at(crown, &model.skeleton, begin_m)
        }
        _ => fewer_leaves(&model.leaves, decimation.in_leaf.leaf_share),
    };
    let meshes = DecimatedMeshes { wood: wood(decimation.in_leaf.least_radius_m), leaves };
    ThinnedMeshes { meshes, bare_wood: decimation.bare_radius_m.map(wood) }
}

/// Whether a thinned level, by its number from 0, is made for trees that are a quarter of a screen high and less: its tubes have few sides.
fn is_coarse(number: usize) -> bool {
    number > 0
}

/// As much of a decimation as a tree bears.
fn bearable(species: &Species, model: &TreeModel, wanted: &Decimation) -> SeasonalDecimation {
    // Ellipsoids are few, and each is seen: none may be left out. Impressionist crowns know which of their polygons may.
    let is_indivisible = matches!(species.growth, Growth::Gardner(_) | Growth::Impressionist(_));
    if !is_indivisible && model.leaves.positions.len() <= SMALL_VERTICES {
        return SeasonalDecimation::default();
    }
    let radius_m = |share| prunable_radius_m(&model.skeleton, wanted.least_radius_m, share);
    let is_evergreen = species.phenology.evergreen;
    let leafy_m = if is_evergreen { wanted.least_radius_m } else { radius_m(LEAST_WOOD_SHARE) };
    let bare_m = if is_evergreen { leafy_m } else { radius_m(LEAST_BARE_WOOD_SHARE) };
    // Of a shrub, an enlarged spray would be half the crown.
    let most_enlarged = MOST_SPRAY_HEIGHTS * model.height_m() / species.foliage.size_m;
    let least_share = most_enlarged.powi(-2).min(1.0);
    let leaf_share = if is_indivisible { 1.0 } else { wanted.leaf_share.max(least_share) };
    let in_leaf = Decimation { least_radius_m: leafy_m, leaf_share };
    SeasonalDecimation { in_leaf, bare_radius_m: (bare_m < leafy_m).then_some(bare_m) }
}
