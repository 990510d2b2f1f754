//! The levels of a tree that are its own meshes thinned: how much of it each species bears to lose.

use super::{
    decimate::{DecimatedMeshes, decimate, prunable_radius_m},
    screen_size::{Lens, LodScreenSizes},
    settings::{Decimation, LodBakeSettings},
};
use crate::tree::{Growth, Species, TreeModel, crown::impressionist::leaves_at};

/// Share of the wood that each level of a tree that sheds its leaves keeps at least. Branches of birches are thin: with all that may be
/// left out under the leaves of an oak, a birch would be a bare pole in winter.
const LEAST_WOOD_SHARE: f32 = 0.45;

/// A plant with no more vertices of leaves than so many is never thinned: its few leaves, enlarged, would look like another plant.
const SMALL_VERTICES: usize = 2000;

/// The meshes of the lower levels of a tree, from the finest to the coarsest: one for each decimation of the settings.
///
/// Crowns of polygons have the polygons of the distance at which the level begins, on a usual camera's picture.
#[must_use]
pub fn thinned_meshes(species: &Species, model: &TreeModel, settings: &LodBakeSettings) -> Vec<DecimatedMeshes> {
    let bearable = settings.decimations.iter().map(|wanted| bearable(species, model, wanted));
    let thinned = bearable.enumerate().map(|(number, decimation)| {
        let mut meshes = decimate(model, &decimation);
        if let Growth::Impressionist(crown) = &species.growth {
            let begin_m = LodScreenSizes::default().distances_of_three_m(crown.height_m, Lens::default())[number];
            meshes.leaves = leaves_at(crown, &model.skeleton, begin_m);
        }
        meshes
    });
    thinned.collect()
}

/// As much of a decimation as a tree bears.
fn bearable(species: &Species, model: &TreeModel, wanted: &Decimation) -> Decimation {
    // Ellipsoids are few, and each is seen: none may be left out. Impressionist crowns know which of their polygons may.
    let is_indivisible = matches!(species.growth, Growth::Gardner(_) | Growth::Impressionist(_));
    if !is_indivisible && model.leaves.positions.len() <= SMALL_VERTICES {
        return Decimation::default();
    }
    let least_radius_m = match species.phenology.evergreen {
        true => wanted.least_radius_m,
        false => prunable_radius_m(&model.skeleton, wanted.least_radius_m, LEAST_WOOD_SHARE),
    };
    Decimation { least_radius_m, leaf_share: if is_indivisible { 1.0 } else { wanted.leaf_share } }
}
