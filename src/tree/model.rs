//! The baked model of a tree: everything that the trees of one variant and age share. It never changes.

use super::{
    body::TreeBody,
    bounds::{PressureStep, SwayBounds, bounds_by_step, limit_bounds, reaches_m},
    individual::grow,
    leaf_mesh::leaves,
    leaf_season::LeafSeason,
    mechanics::beam_dynamics,
    skeleton::Skeleton,
    species::Species,
    vertices::{LeafVertices, WoodVertices},
    wood_mesh::wood,
};
use crate::dynamics::beam::BeamDynamics;
use bevy::{asset::Asset, reflect::TypePath};
use std::sync::Arc;

/// One variant of a species: skeleton, beams, vertices, bounds. Immutable once baked.
#[derive(Asset, TypePath, Clone, Debug)]
pub struct TreeModel {
    /// The beams and leaf clusters at rest. Shared, as are wood and leaves: tasks in the background keep
    /// a pointer of their own.
    pub skeleton: Arc<Skeleton>,
    /// The beams as they are posed, in the order of the skeleton's.
    pub beams: Vec<BeamDynamics>,
    /// When it has leaves, for its poses.
    pub leaf_season: LeafSeason,
    /// Trunk and branches.
    pub wood: Arc<WoodVertices>,
    /// The foliage; empty for a bare tree.
    pub leaves: Arc<LeafVertices>,
    /// What of it is in the way of rays and bodies.
    pub body: Arc<TreeBody>,
    /// Box around the tree in every pose that the saturating beams can take, tree-local, m.
    pub bounds: SwayBounds,
    /// The same for weaker winds.
    bounds_by_step: Box<[SwayBounds]>,
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
        let bounds_by_step = bounds_by_step(&beams, &reaches_m, bounds);
        let body = Arc::new(TreeBody::new(species, &skeleton, &beams, &leaves));
        let (skeleton, wood, leaves) = (Arc::new(skeleton), Arc::new(wood), Arc::new(leaves));
        let leaf_season = LeafSeason::of(&species.phenology);
        Self { skeleton, beams, leaf_season, wood, leaves, body, bounds, bounds_by_step }
    }

    /// Box around the tree in every pose that it takes while no beam's static-equivalent wind pressure is above this,
    /// tree-local, m; it may be that for a pressure that is greater by less than a third. units: m²/s²; one that is no number
    /// counts as the greatest.
    pub fn bounds_under(&self, pressure: f32) -> SwayBounds {
        self.bounds_at(PressureStep::of(pressure))
    }

    /// The same for a step of pressures.
    pub(crate) fn bounds_at(&self, PressureStep(step): PressureStep) -> SwayBounds {
        self.bounds_by_step.get(usize::from(step)).copied().unwrap_or(self.bounds)
    }

    /// Height of the tree at rest, m.
    pub fn height_m(&self) -> f32 {
        self.skeleton.height_m()
    }
}
