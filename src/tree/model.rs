//! A tree, baked: everything that thousands of trees share, and nothing that changes.

use super::{
    bounds::{SwayBounds, bounds_under, limit_bounds, reaches_m},
    leaf_mesh::{LeafVertices, leaves},
    mechanics::beam_dynamics,
    mesh::{WoodVertices, wood},
    skeleton::{Skeleton, grow},
    species::Species,
};
use crate::dynamics::pose::BeamDynamics;
use bevy::{asset::Asset, reflect::TypePath};
use std::sync::Arc;

/// One variant of a species: skeleton, beams, vertices, bounds. Immutable once baked.
#[derive(Asset, TypePath, Clone, Debug)]
pub struct TreeModel {
    /// The beams and leaf clusters at rest.
    pub skeleton: Skeleton,
    /// The beams as they are posed, in the order of the skeleton's.
    pub beams: Vec<BeamDynamics>,
    /// Trunk and branches. Shared, as are the leaves: whoever cuts a model in the background takes a copy of it.
    pub wood: Arc<WoodVertices>,
    /// The foliage; empty for a bare tree.
    pub leaves: Arc<LeafVertices>,
    /// Box around the tree in every pose that the saturating beams can take, tree-local, m.
    pub bounds: SwayBounds,
    /// See [`reaches_m`].
    reaches_m: Vec<f32>,
}

impl TreeModel {
    /// Grows and bakes the variant of `species` that belongs to `seed`, at an age.
    pub fn bake(species: &Species, age_years: f32, seed: u64) -> Self {
        let skeleton = grow(species, age_years, seed);
        let beams = beam_dynamics(species, &skeleton);
        let wood = wood(species, &skeleton);
        let leaves = leaves(species, &skeleton);
        let reaches_m = reaches_m(&beams, &wood, &leaves);
        let bounds = limit_bounds(&beams, &reaches_m);
        Self { skeleton, beams, wood: Arc::new(wood), leaves: Arc::new(leaves), bounds, reaches_m }
    }

    /// Box around the tree in every pose that it takes while no beam's static-equivalent wind pressure is above this,
    /// tree-local, m. units: m²/s²; one that is no number counts as the greatest.
    pub fn bounds_under(&self, pressure: f32) -> SwayBounds {
        bounds_under(&self.beams, &self.reaches_m, pressure).intersection(self.bounds)
    }

    /// Height of the tree at rest, m.
    pub fn height_m(&self) -> f32 {
        self.skeleton.height_m()
    }
}
