//! What of a tree is in the way: of a ray, a bullet, a line of sight, a body.
//!
//! | file | what |
//! |---|---|
//! | `ray` | A way through it. |
//! | `round_cone` | A piece of wood with round ends, as a ray meets it. |
//! | `limbs` | Trunk and main limbs: beams that are posed as all others, each as two round cones. |
//! | `crown` | Leaves and twigs as densities in a coarse grid, which lean with the stem: how much of a ray they let through. |
//! | `stems` | Where stems are at a height. |
//!
//! A body belongs to a model, and so is made in the background. Everything is in the tree's own coordinates, in metres.

mod crown;
mod limbs;
mod ray;
mod round_cone;
mod stems;

pub use crown::{CrownDensity, CrownStep};
pub use limbs::{Limb, LimbHit, Limbs, TreeCapsule};
pub use ray::BodyRay;
pub use round_cone::RoundCone;

use super::{skeleton::Skeleton, species::Species, vertices::LeafVertices};
use crate::dynamics::{
    beam::BeamDynamics,
    beam_pose::BeamPose,
    pose::{TreeInWind, TreePoser},
};
use bevy::math::Vec3;

/// The body of one model.
#[derive(Clone, Debug, PartialEq)]
pub struct TreeBody {
    /// Trunk and main limbs.
    pub limbs: Limbs,
    /// Leaves and twigs.
    pub crown: CrownDensity,
}

/// A body in a pose.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PosedBody {
    /// Two for each limb, from its root to its tip.
    cones: Vec<RoundCone>,
    /// How far the crown has been moved at each border of its layers, m.
    shifts: Vec<Vec3>,
}

impl TreeBody {
    pub(super) fn new(species: &Species, skeleton: &Skeleton, beams: &[BeamDynamics], leaves: &LeafVertices) -> Self {
        let limbs = Limbs::new(&skeleton.beams, beams);
        let crown = CrownDensity::new(species, skeleton, leaves, &limbs);
        Self { limbs, crown }
    }

    /// The body at rest.
    #[must_use]
    pub fn at_rest(&self) -> PosedBody {
        self.posed(&vec![BeamPose::REST; self.limbs.limbs().len()])
    }

    /// The body as it is posed by a wind whose table gives these responses to the rows that it is asked for.
    #[must_use]
    pub fn poser(&self, tree: &TreeInWind) -> TreePoser {
        TreePoser::new(self.limbs.beams(), tree)
    }

    /// The body in the poses of its limbs, in their order.
    #[must_use]
    pub fn posed(&self, poses: &[BeamPose]) -> PosedBody {
        PosedBody { cones: self.limbs.cones(poses), shifts: self.crown.shifts(&self.limbs, poses) }
    }

    /// The body in the poses of all of the model's beams, in their order.
    #[must_use]
    pub fn posed_by_all(&self, poses: &[BeamPose]) -> PosedBody {
        let of = |limb: &Limb| poses.get(limb.beam as usize).copied().unwrap_or(BeamPose::REST);
        let own: Vec<BeamPose> = self.limbs.limbs().iter().map(of).collect();
        self.posed(&own)
    }

    /// The wood that a ray hits first.
    #[must_use]
    pub fn hit(&self, posed: &PosedBody, ray: &BodyRay) -> Option<LimbHit> {
        self.limbs.hit(&posed.cones, ray)
    }

    /// Visits the parts of a ray that lie in the crown, in order, with how much each of them blocks.
    pub fn pass_crown(&self, posed: &PosedBody, ray: &BodyRay, leaf_share: f32, visit: impl FnMut(CrownStep)) {
        self.crown.pass(&posed.shifts, ray, leaf_share, visit);
    }

    /// Share of a ray that leaves and twigs let through, 0 to 1, where that share of the leaves is there.
    #[must_use]
    pub fn transmittance(&self, posed: &PosedBody, ray: &BodyRay, leaf_share: f32) -> f32 {
        let mut depth = 0.0;
        self.pass_crown(posed, ray, leaf_share, |step| depth += step.depth);
        (-depth).exp()
    }

    /// Trunk and limbs that are as thick as this at their roots, m, as capsules.
    #[must_use]
    pub fn capsules(&self, posed: &PosedBody, least_radius_m: f32) -> Vec<TreeCapsule> {
        self.limbs.capsules(&posed.cones, least_radius_m)
    }
}

#[cfg(test)]
mod tests;
