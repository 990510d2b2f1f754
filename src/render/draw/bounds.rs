//! Fits the bounds of drawn trees to the winds that blow.

use super::components::{TreeMeshOf, TreeMeshes};
use crate::{
    render::{instances::components::TreeInstance, species::library::SpeciesLibrary, wind_exposure::WindExposure},
    tree::{Tree, TreeModel},
};
use bevy::{camera::primitives::Aabb, prelude::*};

/// Trees whose bounds are fitted in a frame, at most: all of them take milliseconds, and a wind grows over many frames.
const FITTED_PER_FRAME: usize = 512;

/// Widens the bounds of trees when a stronger wind comes, and narrows them when it has gone.
pub(crate) fn fit_tree_bounds(
    exposure: Res<WindExposure>,
    models: Res<Assets<TreeModel>>,
    mut library: ResMut<SpeciesLibrary>,
    mut due: Local<Vec<Entity>>,
    trees: Query<(&Tree, &TreeInstance, &TreeMeshes)>,
    drawn: Query<Entity, With<TreeMeshes>>,
    mut meshes: Query<&mut Aabb, With<TreeMeshOf>>,
) {
    if exposure.is_changed() && library.bypass_change_detection().fit_bounds(&models, &exposure) {
        due.clear();
        due.extend(&drawn);
    }
    let rest = due.len().saturating_sub(FITTED_PER_FRAME);
    for tree in due.drain(rest..) {
        let Ok((tree, instance, of_tree)) = trees.get(tree) else { continue };
        let Some(variant) = library.variant(tree.species.id(), instance.model) else { continue };
        let mut meshes = meshes.iter_many_mut(of_tree.iter()).matched();
        while let Some(mut bounds) = meshes.fetch_next() {
            bounds.set_if_neq(variant.bounds);
        }
    }
}
