//! How stiff, heavy and exposed each beam of a tree is: from a skeleton to the rows that are posed.
//!
//! A branch is a chain of tapered beams that continue one another, clamped where it grows from its parent; a stem stands on a
//! rotational spring (Neild & Wood 1999), since the ground gives: the root plate is a rigid disc of radius `a` that rocks on an
//! elastic half-space, `k = 8 G a^3 / (3 (1 - nu))` (Borowicka 1943). The wood inside the bark bends and twists, as hinges between
//! rigid pieces (`hinges.rs`), with `I = pi R^4/4` of the round section (eq. 20 corrected). Every other beam and leaf
//! cluster that a branch carries is a lump of mass and drag (`branches.rs`). From that come
//!
//! ```text
//! gain of a beam  = turn of its tip under the drag for |u|u = 1 m^2/s^2, over phi_1'(1)             (statics.rs, response.rs)
//! w of a branch   = where it resonates with all that it carries, which bends, twists and sways too        (resonance.rs, lag_curve.rs)
//! damping by drag = U (1 + V/2) sum c |u|^2 / (w sum m |u|^2),   c |u| u = drag of a lump                (composite.rs)
//! ```
//!
//! The third follows from drag by the velocity that a moving lump sees: `c (U - y')^(2 + V)` loses `(2 + V) c U y'`. All beams
//! of a branch sway with its frequency, or with two, each with its share of the deflection, where it has two peaks of about the same
//! strength. Without what it bears a trunk would sway much faster (80% of the crown must go
//! before it shows: Moore & Maguire 2004).
//!
//! Weight pulls over what leans, and holds what hangs: stems and twigs bend further by it, or less, and all branches sway slower, or faster.
//! How far a branch that bears others bends is worked out without its own weight.
//!
//! A beam's turn is such that it moves the tip of its branch, along the wind, as far as its wood does by bending and twisting, and in other
//! directions, as the twist of a crooked branch does, as nearly as one beam can (`skew.rs`). Where the drag of a beam is, in height and in
//! spread, is weighed by how much it bends that beam: that decides how much of the mean wind and of its gusts the beam feels
//! (`dynamics::beam`). All this is worked out twice, with leaves and without.

mod articulated;
mod bodies;
mod branches;
mod composite;
mod four;
mod hinges;
mod lag_curve;
mod resonance;
mod response;
mod skew;
mod statics;
mod twig;

pub(crate) use branches::{Piece, tree_pieces};

use self::{
    branches::{LoadedBranch, LoadedTree, branches},
    composite::{CompositeSway, composite_sways},
    response::{BeamLoad, BranchResponse},
    skew::stiff_axes,
};
use super::{
    skeleton::{Skeleton, SkeletonBeam},
    species::Species,
};
use crate::dynamics::{
    admittance::equivalent_size_m,
    beam::{BeamDynamics, BeamSway, NO_PARENT},
    frequency_classes::FrequencyClasses,
    pose::TIP_ANGLE_LIMIT,
    second_mode::SecondMode,
};
use bevy::math::Vec3;

/// Height at which foresters measure a trunk's diameter, m.
const BREAST_HEIGHT_M: f32 = 1.3;

/// The beams of `skeleton` as rows for posing, in the same order.
pub(super) fn beam_dynamics(species: &Species, skeleton: &Skeleton) -> Vec<BeamDynamics> {
    let mut rows: Vec<BeamDynamics> = skeleton.beams.iter().map(|beam| at_rest(species, beam)).collect();
    let tree = loaded_tree(species, skeleton);
    let has_leaves = !skeleton.clusters.is_empty();
    let exponents = [species.foliage.drag_exponent, species.wood.drag_exponent];
    let in_leaf = TreeResponse::new(&tree, &tree.branches, skeleton);
    in_leaf.write(&tree, exponents[usize::from(!has_leaves)], |beam, sway| rows[beam].in_leaf = sway);
    for branch in &tree.branches {
        share_angle_limit(branch, &mut rows);
        for (&beam, stiff_axis) in branch.beams.iter().zip(&branch.stiff_axes) {
            rows[beam as usize].stiff_axis = *stiff_axis;
        }
    }
    if has_leaves && !species.phenology.evergreen {
        let branches: Vec<LoadedBranch> = tree.branches.iter().map(LoadedBranch::without_leaves).collect();
        let bare = TreeResponse::new(&tree, &branches, skeleton);
        bare.write(&tree, exponents[1], |beam, sway| rows[beam].bare = sway);
        rows.iter_mut().for_each(match_modes);
    } else {
        rows.iter_mut().for_each(|row| row.bare = row.in_leaf);
    }
    rows
}

/// The branches of a tree with their stiff axes.
fn loaded_tree(species: &Species, skeleton: &Skeleton) -> LoadedTree {
    let mut tree = branches(species, skeleton);
    for branch in &mut tree.branches {
        branch.stiff_axes = stiff_axes(branch, skeleton);
    }
    tree
}

/// How all branches of a tree respond, in leaf or bare.
struct TreeResponse {
    responses: Vec<BranchResponse>,
    sways: Vec<CompositeSway>,
}

impl TreeResponse {
    fn new(tree: &LoadedTree, branches: &[LoadedBranch], skeleton: &Skeleton) -> Self {
        let responses: Vec<BranchResponse> = branches.iter().map(|branch| branch.response(skeleton)).collect();
        let sways = composite_sways(tree, branches, &responses);
        Self { responses, sways }
    }

    /// Hands out the sway of each beam.
    fn write(&self, tree: &LoadedTree, drag_exponent: f32, mut write: impl FnMut(usize, BeamSway)) {
        for ((branch, response), sway) in tree.branches.iter().zip(&self.responses).zip(&self.sways) {
            for (beam, load) in branch.beams.iter().zip(&response.loads) {
                write(*beam as usize, beam_sway(load, sway, drag_exponent));
            }
        }
    }
}

/// Gives each beam of a branch its share of the angle that the branch's tip may turn by: that which it has of the bend.
fn share_angle_limit(branch: &LoadedBranch, rows: &mut [BeamDynamics]) {
    let gain = |beam: &u32, rows: &[BeamDynamics]| rows[*beam as usize].in_leaf.gain.max(0.0);
    let total: f32 = branch.beams.iter().map(|beam| gain(beam, rows)).sum();
    for beam in &branch.beams {
        let share = gain(beam, rows) / total;
        let share = if share.is_finite() { share } else { 1.0 / branch.beams.len() as f32 };
        rows[*beam as usize].angle_limit_rad = TIP_ANGLE_LIMIT * share;
    }
}

/// Makes the two modes of a beam in leaf and bare those that are mixed while leaves unfold and fall: the slower with the slower. Where it
/// has one of both states alone, the other has it as far from its own, with no share of the motion.
fn match_modes(beam: &mut BeamDynamics) {
    let (in_leaf, bare) = (&mut beam.in_leaf, &mut beam.bare);
    match [in_leaf.second.is_there(), bare.second.is_there()] {
        [true, true] if in_leaf.second.class_offset * bare.second.class_offset < 0.0 => {
            *bare = bare.in_other_order(FrequencyClasses::default().ratio);
        }
        [true, false] => bare.second.class_offset = in_leaf.second.class_offset,
        [false, true] => in_leaf.second.class_offset = bare.second.class_offset,
        _ => {}
    }
}

fn beam_sway(load: &BeamLoad, sway: &CompositeSway, drag_exponent: f32) -> BeamSway {
    let finite = |value: f64| if value.is_finite() { value as f32 } else { 0.0 };
    let class = |frequency_hz: f64| FrequencyClasses::default().coordinate(frequency_hz as f32);
    let second = sway.second.map_or(SecondMode::default(), |second| {
        SecondMode::rounded(class(second.frequency_hz) - class(sway.frequency_hz), second.share as f32)
    });
    BeamSway {
        gain: finite(load.gain),
        class: class(sway.frequency_hz),
        second,
        averaging_speed_m_s: finite(sway.frequency_hz * equivalent_size_m(load.horizontal_m, load.vertical_m)),
        drag_damping_s_m: finite(sway.drag_damping_s_m),
        load_height_m: finite(load.height_m),
        drag_exponent,
    }
}

/// The measures of a tree that foresters take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TreeSway {
    /// Natural frequency of the trunk with all that it bears, Hz; of two that by which gusts move it further.
    pub frequency_hz: f32,
    /// Diameter over bark at breast height (1.3 m along the stem; at the tip of a lower one), m.
    pub dbh_m: f32,
    /// Height of the highest wood, m.
    pub height_m: f32,
}

/// First sway frequency and size of a tree; of a shrub those of its first stem.
#[must_use]
pub fn tree_sway(species: &Species, skeleton: &Skeleton) -> TreeSway {
    let tree = branches(species, skeleton);
    let in_leaf = TreeResponse::new(&tree, &tree.branches, skeleton);
    let (frequency_hz, dbh_m) = match (tree.branches.first(), in_leaf.sways.first()) {
        (Some(trunk), Some(sway)) => (sway.frequency_hz as f32, 2.0 * trunk.radius_m(skeleton, BREAST_HEIGHT_M)),
        _ => (0.0, 0.0),
    };
    TreeSway { frequency_hz, dbh_m, height_m: skeleton.height_m() }
}

fn at_rest(species: &Species, beam: &SkeletonBeam) -> BeamDynamics {
    BeamDynamics {
        base: beam.base,
        length_m: beam.length_m,
        direction: beam.direction,
        attach: beam.attach,
        parent: beam.parent.unwrap_or(NO_PARENT),
        stiff_axis: Vec3::ZERO,
        compliance_rad_n_m: hinges::beam_compliance(species, beam) as f32,
        in_leaf: BeamSway::default(),
        angle_limit_rad: TIP_ANGLE_LIMIT,
        bare: BeamSway::default(),
    }
}

#[cfg(test)]
mod tests;
