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
    /// Grows and bakes the variant of `species` that belongs to `seed`, at an age.
    pub fn bake(species: &Species, age_years: f32, seed: u64) -> Self {
        let skeleton = grow(species, age_years, seed);
        let beams = beam_dynamics(species, &skeleton);
        let wood = wood(species, &skeleton);
        let leaves = leaves(species, &skeleton);
        let bounds = sway_bounds(&beams, &wood, &leaves);
        Self { skeleton, beams, wood: Arc::new(wood), leaves: Arc::new(leaves), bounds }
    }

    /// Height of the tree at rest, m.
    pub fn height_m(&self) -> f32 {
        self.skeleton.height_m()
    }
}

/// Directions into which the whole tree is bent to its limit to find its bounds.
const BOUND_DIRECTIONS: usize = 8;
/// Share by which the box is widened for poses between those directions and for points between the places on a beam.
const BOUND_MARGIN: f32 = 0.08;
/// Places on a beam whose surroundings are enclosed; its root lies on its parent.
const BOUND_PLACES: [f32; 2] = [0.5, 1.0];
/// A free tip angle at which beams have saturated, rad.
const HURRICANE_RAD: f32 = 1e3;

/// Bends every beam to its limit into each of a ring of directions, and takes the box around all that is bound to it.
fn sway_bounds(beams: &[BeamDynamics], wood: &WoodVertices, leaves: &LeafVertices) -> SwayBounds {
    let reaches = reaches_m(beams, wood, leaves);
    let mut bounds = SwayBounds { min: Vec3::ZERO, max: Vec3::ZERO };
    let mut poses = vec![BeamPose::REST; beams.len()];
    for step in 0..=BOUND_DIRECTIONS {
        let azimuth = step as f32 / BOUND_DIRECTIONS as f32 * std::f32::consts::TAU;
        // The last step is the tree at rest.
        let lean = if step == BOUND_DIRECTIONS { Vec3::ZERO } else { Vec3::new(azimuth.cos(), 0.0, azimuth.sin()) };
        let to_the_limit =
            |beam: &BeamDynamics| lean.reject_from_normalized(beam.direction).normalize_or_zero() * HURRICANE_RAD;
        TreePoser::bent(beams, to_the_limit).pose(&[], &mut poses);
        for ((beam, pose), reach_m) in beams.iter().zip(&poses).zip(&reaches) {
            for s in BOUND_PLACES {
                let (carried, _) = pose.carry(beam, s, beam.base + beam.direction * (beam.length_m * s));
                bounds.min = bounds.min.min(carried - *reach_m);
                bounds.max = bounds.max.max(carried + *reach_m);
            }
        }
    }
    let margin = (bounds.max - bounds.min) * BOUND_MARGIN;
    SwayBounds { min: bounds.min - margin, max: bounds.max + margin }
}

/// For each beam the greatest distance of what is bound to it from the place on its axis that carries it, m; a leaf may
/// turn anywhere about its anchor.
fn reaches_m(beams: &[BeamDynamics], wood: &WoodVertices, leaves: &LeafVertices) -> Vec<f32> {
    let mut reaches = vec![0.0_f32; beams.len()];
    let mut reach = |sway: &[f32; 4], at: Vec3, beyond_m: f32| {
        let index = sway[0] as usize;
        let beam = &beams[index];
        let axis = beam.base + beam.direction * (beam.length_m * sway[1]);
        reaches[index] = reaches[index].max(at.distance(axis) + beyond_m);
    };
    for (sway, position) in wood.sway.iter().zip(&wood.positions) {
        reach(sway, Vec3::from_array(*position), 0.0);
    }
    for (sway, (position, anchor)) in leaves.sway.iter().zip(leaves.positions.iter().zip(&leaves.anchor)) {
        let anchor = Vec3::from_slice(anchor);
        reach(sway, anchor, Vec3::from_array(*position).distance(anchor));
    }
    reaches
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};

    /// Trees whose beams are bent at random, to the limit and all over the place, stay in their box.
    #[test]
    fn no_pose_leaves_the_bounds() {
        for seed in 0..3 {
            let model = TreeModel::bake(&Species::default(), 120.0, seed);
            let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
            let mut poses = vec![BeamPose::REST; model.beams.len()];
            for _ in 0..20 {
                let wind = Vec3::new(random.random_range(-1.0..1.0), 0.3, random.random_range(-1.0..1.0));
                let angles: Vec<Vec3> = model
                    .beams
                    .iter()
                    .map(|beam| {
                        let mut odd = || random.random_range(-0.5..0.5);
                        let odd = Vec3::new(odd(), odd(), odd());
                        (wind + odd).reject_from_normalized(beam.direction) * random.random_range(0.0..100.0)
                    })
                    .collect();
                let mut next = angles.iter();
                // `bent` asks for the beams in their order.
                let order = std::cell::RefCell::new(&mut next);
                let angle = |_: &BeamDynamics| order.borrow_mut().next().copied().unwrap_or(Vec3::ZERO);
                TreePoser::bent(&model.beams, angle).pose(&[], &mut poses);
                for (sway, at) in model.wood.sway.iter().zip(&model.wood.positions) {
                    let beam = sway[0] as usize;
                    let (carried, _) = poses[beam].carry(&model.beams[beam], sway[1], Vec3::from_array(*at));
                    assert!(
                        carried.cmpge(model.bounds.min).all() && carried.cmple(model.bounds.max).all(),
                        "{carried}"
                    );
                }
            }
        }
    }
}
