//! The skeleton of one tree: beams, parents first, and the clusters of leaves on them.
//!
//! A branch is a chain of beams, each continuing the one before: a continuation sits at the tip of its parent and
//! keeps its [`order`](SkeletonBeam::order). Every other child starts a branch of the next order. All points are
//! local to the tree, in metres, y up, the root at the origin.

use bevy::math::Vec3;

use super::growth::{envelope::Envelope, trunk::Trunk};

/// A straight or gently bowed piece of wood.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SkeletonBeam {
    /// Index of the beam that carries it, always smaller than its own; `None` for a stem from the ground.
    pub parent: Option<u32>,
    /// Where it sits on the parent, 0 at its root to 1 at its tip.
    pub attach: f32,
    /// Its root, on the parent's path, m.
    pub base: Vec3,
    /// Unit vector from its root to its tip.
    pub direction: Vec3,
    /// Length of the chord, m.
    pub length_m: f32,
    /// Radius at the root, m, without root flare and collar.
    pub base_radius_m: f32,
    /// Radius at the tip, m.
    pub tip_radius_m: f32,
    /// How far the rest curve leaves the chord at its middle, m.
    pub bow: Vec3,
    /// 0 for the trunk, one more than the parent's for each branching.
    pub order: u8,
}

impl SkeletonBeam {
    /// Point of the rest curve at `s`, 0 at the root to 1 at the tip: a parabola about the chord.
    #[must_use]
    pub fn path(&self, s: f32) -> Vec3 {
        self.base + self.direction * (self.length_m * s) + self.bow * (4.0 * s * (1.0 - s))
    }

    /// Unit tangent of the rest curve at `s`.
    #[must_use]
    pub fn tangent(&self, s: f32) -> Vec3 {
        let slope = self.direction * self.length_m + self.bow * (4.0 - 8.0 * s);
        slope.try_normalize().unwrap_or(self.direction)
    }

    /// Radius at `s`, m.
    #[must_use]
    pub fn radius_m(&self, s: f32) -> f32 {
        self.base_radius_m + (self.tip_radius_m - self.base_radius_m) * s
    }
}

/// A spray of leaves, drawn as one card.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LeafCluster {
    /// The beam that carries it.
    pub beam: u32,
    /// Where on that beam, 0 to 1.
    pub at: f32,
    /// Where it is attached, m.
    pub anchor: Vec3,
    /// Unit main axis, from the anchor to the tip.
    pub axis: Vec3,
    /// Unit normal of the spray, perpendicular to the axis.
    pub normal: Vec3,
    /// Length from anchor to tip, m.
    pub size_m: f32,
    /// Random phase of its flutter, 0 to 1.
    pub phase: f32,
    /// How deep in the crown: 0 at the envelope, 1 at its middle.
    pub depth: f32,
    /// Random tone of its colour, 0 to 1, alike within a branch.
    pub tint: f32,
}

/// One individual of a species.
#[derive(Clone, Debug, PartialEq)]
pub struct Skeleton {
    /// Beams, parents first; the first is the trunk, or the first stem of a shrub.
    pub beams: Vec<SkeletonBeam>,
    /// Sprays of leaves.
    pub clusters: Vec<LeafCluster>,
    /// What bounded the growth, at this individual's size.
    pub envelope: Envelope,
    /// The trunk's numbers at this individual's age: its flare for the mesh.
    pub trunk: Trunk,
}

impl Skeleton {
    /// Highest point of the wood, m.
    #[must_use]
    pub fn height_m(&self) -> f32 {
        self.beams.iter().map(|beam| beam.path(1.0).y).fold(0.0, f32::max)
    }

    /// For each beam the one that continues it, if any.
    #[must_use]
    pub fn continuations(&self) -> Vec<Option<u32>> {
        continuations(&self.beams)
    }
}

/// For each beam whether it bears no other: those of terminal branches, and of branches that have lost theirs.
pub(super) fn is_terminal(beams: &[SkeletonBeam]) -> Vec<bool> {
    let mut terminal = vec![true; beams.len()];
    beams.iter().filter_map(|beam| beam.parent).for_each(|parent| terminal[parent as usize] = false);
    terminal
}

pub(super) fn continuations(beams: &[SkeletonBeam]) -> Vec<Option<u32>> {
    let mut next = vec![None; beams.len()];
    for (index, beam) in (0u32..).zip(beams) {
        let Some(parent) = beam.parent else { continue };
        if beam.attach >= 1.0 && beam.order == beams[parent as usize].order {
            next[parent as usize].get_or_insert(index);
        }
    }
    next
}
