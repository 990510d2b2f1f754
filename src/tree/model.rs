//! A tree, baked: everything that thousands of trees share, and nothing that changes.

use super::{
    leaf_mesh::{LeafVertices, leaves},
    mechanics::beam_dynamics,
    mesh::{WoodVertices, wood},
    skeleton::{Skeleton, grow},
    species::Species,
};
use crate::dynamics::pose::{BeamDynamics, BeamPose, TreePoser};
use bevy::{asset::Asset, math::Vec3, reflect::TypePath};

/// One variant of a species: skeleton, beams, vertices, bounds. Immutable once baked.
#[derive(Asset, TypePath, Clone, Debug)]
pub struct TreeModel {
    /// The beams and leaf clusters at rest.
    pub skeleton: Skeleton,
    /// The beams as they are posed, in the order of the skeleton's.
    pub beams: Vec<BeamDynamics>,
    /// Trunk and branches.
    pub wood: WoodVertices,
    /// The foliage; empty for a bare tree.
    pub leaves: LeafVertices,
    /// Box around the tree in every pose that the saturating beams can take, tree-local, m.
    pub bounds: SwayBounds,
}

/// An axis-aligned box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SwayBounds {
    /// Least corner, m.
    pub min: Vec3,
    /// Greatest corner, m.
    pub max: Vec3,
}

impl TreeModel {
    /// Grows and bakes the variant of `species` that belongs to `seed`.
    pub fn bake(species: &Species, seed: u64) -> Self {
        let skeleton = grow(species, seed);
        let beams = beam_dynamics(species, &skeleton);
        let wood = wood(species, &skeleton);
        let leaves = leaves(species, &skeleton);
        let bounds = sway_bounds(&beams, &wood, &leaves);
        Self { skeleton, beams, wood, leaves, bounds }
    }

    /// Height of the tree at rest, m.
    pub fn height_m(&self) -> f32 {
        self.skeleton.height_m()
    }
}

/// Directions into which the whole tree is bent to its limit to find its bounds.
const BOUND_DIRECTIONS: usize = 16;
/// A free tip angle at which beams have saturated, rad.
const HURRICANE_RAD: f32 = 1e3;
/// Share by which the box is widened for poses between those directions.
const BOUND_MARGIN: f32 = 0.05;

/// Bends every beam to its limit into each of a ring of directions, and takes the box around all vertices.
fn sway_bounds(beams: &[BeamDynamics], wood: &WoodVertices, leaves: &LeafVertices) -> SwayBounds {
    let mut bounds = SwayBounds { min: Vec3::ZERO, max: Vec3::ZERO };
    let mut poses = vec![BeamPose::default(); beams.len()];
    for step in 0..=BOUND_DIRECTIONS {
        let azimuth = step as f32 / BOUND_DIRECTIONS as f32 * std::f32::consts::TAU;
        // The last step is the tree at rest.
        let lean = if step == BOUND_DIRECTIONS { Vec3::ZERO } else { Vec3::new(azimuth.cos(), 0.0, azimuth.sin()) };
        let to_the_limit =
            |beam: &BeamDynamics| lean.reject_from_normalized(beam.direction).normalize_or_zero() * HURRICANE_RAD;
        TreePoser::bent(beams, to_the_limit).pose(&[], &mut poses);
        let mut enclose = |sway: &[f32; 4], position: &[f32; 3], reach_m: f32| {
            let beam = sway[0] as usize;
            let (carried, _) = poses[beam].carry(&beams[beam], sway[1], Vec3::from_array(*position));
            bounds.min = bounds.min.min(carried - reach_m);
            bounds.max = bounds.max.max(carried + reach_m);
        };
        for (sway, position) in wood.sway.iter().zip(&wood.positions) {
            enclose(sway, position, 0.0);
        }
        for (sway, (position, anchor)) in leaves.sway.iter().zip(leaves.positions.iter().zip(&leaves.anchor)) {
            // A leaf may turn anywhere about its anchor.
            let anchor = Vec3::new(anchor[0], anchor[1], anchor[2]);
            enclose(sway, &anchor.to_array(), Vec3::from_array(*position).distance(anchor));
        }
    }
    let margin = (bounds.max - bounds.min) * BOUND_MARGIN;
    SwayBounds { min: bounds.min - margin, max: bounds.max + margin }
}
