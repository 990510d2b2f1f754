//! Fits the bounds of drawn trees to the winds that blow.

use super::components::{TreeMeshOf, TreeMeshes};
use crate::{
    render::{instances::components::TreeInstance, species::library::SpeciesLibrary, wind_exposure::WindExposure},
    sway::LiveSway,
    tree::{Tree, TreeModel},
};
use bevy::{camera::primitives::Aabb, prelude::*};

/// Trees whose bounds are fitted in a frame, at most: all of them take milliseconds, and a wind grows over many frames.
const FITTED_PER_FRAME: usize = 512;

/// Gives trees that are awake the bounds of the greatest bend, and takes these back when they sleep.
pub(crate) fn fit_live_bounds(
    models: Res<Assets<TreeModel>>,
    library: Res<SpeciesLibrary>,
    awake: Query<(&Tree, &TreeInstance, &TreeMeshes), With<LiveSway>>,
    mut slept: RemovedComponents<LiveSway>,
    trees: Query<(&Tree, &TreeInstance, &TreeMeshes), Without<LiveSway>>,
    mut meshes: Query<&mut Aabb, With<TreeMeshOf>>,
) {
    let mut fit = |of_tree: &TreeMeshes, bounds: Aabb| {
        let mut meshes = meshes.iter_many_mut(of_tree.iter()).matched();
        while let Some(mut mesh) = meshes.fetch_next() {
            mesh.set_if_neq(bounds);
        }
    };
    for (tree, instance, of_tree) in &awake {
        let Some(model) = models.get(instance.model) else { continue };
        let Some(variant) = library.variant(tree.species.id(), instance.model) else { continue };
        // Beside the limit, leaves that drift: they are in the bounds that the variant has.
        let (min, max) =
            (model.bounds.min.min(variant.bounds.min().into()), model.bounds.max.max(variant.bounds.max().into()));
        fit(of_tree, Aabb::from_min_max(min, max));
    }
    for (tree, instance, of_tree) in slept.read().filter_map(|tree| trees.get(tree).ok()) {
        if let Some(variant) = library.variant(tree.species.id(), instance.model) {
            fit(of_tree, variant.bounds);
        }
    }
}

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
