//! The skin: how each place of a tree follows few joints.
//!
//! A joint sits at the tip of a beam and moves as the tip does. Between the root and the tip of such a beam the axis turns by `h(s)` of the
//! tip's angle ([`MODE_SHAPE`](crate::dynamics::MODE_SHAPE)). So a vertex there follows the tip with the weight `h(s) / h(1)`, and with the
//! rest what the root is attached to: its rotation is right to the first order, its place to 0.09 of the beam's length times the angle. A
//! beam without a joint moves rigidly with the place where it is attached.

use super::surface::BeamPlace;
use crate::{
    dynamics::{BeamDynamics, bend::mode_shape},
    tree::TreeModel,
};
use bevy::math::Vec3;

/// The joints of a vertex, at most.
pub(super) const MOST_INFLUENCES: usize = 4;
/// Weights add up to this in a file.
const WHOLE: u16 = u16::MAX;

/// A skeleton of few joints, and what follows it.
pub(super) struct Skin {
    /// Parents before their children. The first is the ground, which does not move.
    pub joints: Vec<Joint>,
    /// For each beam the joint at its tip.
    joint_of: Vec<Option<u8>>,
    /// For each beam what its root follows.
    at_root: Vec<Influences>,
}

/// A joint of the skin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Joint {
    /// The beam at whose tip it is; `None` for the ground.
    pub beam: Option<u32>,
    /// Its place at rest, tree-local, m. Its axes are those of the tree.
    pub rest: Vec3,
    /// Its parent, which comes before it.
    pub parent: Option<usize>,
}

/// Joints with weights, the greatest first; they add up to 1.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Influences {
    joints: [u8; MOST_INFLUENCES],
    weights: [f32; MOST_INFLUENCES],
}

impl Influences {
    const GROUND: Self = Self { joints: [0; MOST_INFLUENCES], weights: [1.0, 0.0, 0.0, 0.0] };

    /// `share` of one joint, the rest of these. What is beyond four is left to the others.
    fn mixed(&self, joint: u8, share: f32) -> Self {
        let mut all: Vec<(u8, f32)> =
            self.joints.into_iter().zip(self.weights.map(|weight| (1.0 - share) * weight)).collect();
        match all.iter_mut().find(|(other, weight)| *other == joint && *weight > 0.0) {
            Some((_, weight)) => *weight += share,
            None => all.push((joint, share)),
        }
        all.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
        all.truncate(MOST_INFLUENCES);
        let sum: f32 = all.iter().map(|(_, weight)| weight).sum();
        let mut mixed = Self::default();
        for (slot, (joint, weight)) in all.into_iter().enumerate().filter(|(_, (_, weight))| *weight > 0.0) {
            (mixed.joints[slot], mixed.weights[slot]) = (joint, weight / sum);
        }
        mixed
    }

    /// As a file has them: weights that add up to 65,535 exactly, and joint 0 where there is no weight.
    pub fn packed(&self) -> ([u8; MOST_INFLUENCES], [u16; MOST_INFLUENCES]) {
        let mut weights = self.weights.map(|weight| (weight * f32::from(WHOLE)).round() as u16);
        let others: u16 = weights[1..].iter().sum();
        weights[0] = WHOLE - others;
        let joints = std::array::from_fn(|slot| if weights[slot] > 0 { self.joints[slot] } else { 0 });
        (joints, weights)
    }
}

impl Skin {
    /// A skin with joints at the tips of these beams, in ascending order.
    pub fn new(model: &TreeModel, beams: &[u32]) -> Self {
        let mut skin = Self {
            joints: vec![Joint { beam: None, rest: Vec3::ZERO, parent: None }],
            joint_of: vec![None; model.beams.len()],
            at_root: Vec::with_capacity(model.beams.len()),
        };
        // The joint at or below the root of each beam.
        let mut below: Vec<usize> = Vec::with_capacity(model.beams.len());
        let mut chosen = beams.iter().peekable();
        for (index, beam) in (0_u32..).zip(&model.beams) {
            let parent = (beam.parent < index).then_some(beam.parent as usize);
            let parent_joint = parent.map_or(0, |parent| skin.joint_of[parent].map_or(below[parent], usize::from));
            below.push(parent_joint);
            skin.at_root.push(parent.map_or(Influences::GROUND, |parent| {
                skin.influences(BeamPlace { beam: parent as u32, at: beam.attach })
            }));
            if chosen.next_if(|chosen| **chosen == index).is_some() {
                skin.joint_of[index as usize] = Some(skin.joints.len() as u8);
                skin.joints.push(Joint { beam: Some(index), rest: tip(beam), parent: Some(parent_joint) });
            }
        }
        skin
    }

    /// What a place follows.
    pub fn influences(&self, place: BeamPlace) -> Influences {
        let beam = place.beam as usize;
        let Some(root) = self.at_root.get(beam) else { return Influences::GROUND };
        match self.joint_of[beam] {
            Some(joint) => {
                root.mixed(joint, (mode_shape(place.at.clamp(0.0, 1.0))[0] / mode_shape(1.0)[0]).clamp(0.0, 1.0))
            }
            None => *root,
        }
    }
}

/// The tip of a beam's axis at rest, tree-local, m.
pub(super) fn tip(beam: &BeamDynamics) -> Vec3 {
    beam.base + beam.direction * beam.length_m
}
