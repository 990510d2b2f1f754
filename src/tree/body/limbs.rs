//! Trunk and main limbs: the thickest beams of a tree, posed as they are in the whole tree.

use super::{ray::BodyRay, round_cone::RoundCone};
use crate::{
    dynamics::{
        beam::{BeamDynamics, NO_PARENT},
        beam_pose::BeamPose,
    },
    tree::skeleton::SkeletonBeam,
};
use bevy::math::Vec3;

/// Wood that is thinner than this at its root is a twig, m; of a sapling, what is thinner than a share of its stem.
const LEAST_RADIUS_M: f32 = 0.02;
const LEAST_SHARE: f32 = 0.25;
/// Most limbs of a tree: the thickest ones count.
const MOST_LIMBS: usize = 256;

/// A piece of trunk or limb.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limb {
    /// Its number among the model's beams.
    pub beam: u32,
    /// Its axis at rest, at its root, its middle and its tip, m.
    pub axis: [Vec3; 3],
    /// Radius at these places, m.
    pub radii_m: [f32; 3],
    /// 0 for a stem, one more for each branching.
    pub order: u8,
}

/// Trunk and main limbs of a model: each with all that bear it, parents first.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Limbs {
    limbs: Vec<Limb>,
    /// Their dynamics, whose parents are numbers of limbs.
    beams: Vec<BeamDynamics>,
}

/// Where a ray hits wood.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LimbHit {
    /// Number of the model's beam.
    pub beam: u32,
    /// Where on the beam, from 0 at its root to 1 at its tip.
    pub at: f32,
    /// Along the ray, m.
    pub distance_m: f32,
    /// Unit normal of the surface.
    pub normal: Vec3,
}

/// A piece of trunk or limb as a capsule: all within a radius of a stretch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TreeCapsule {
    /// One end, m.
    pub a: Vec3,
    /// The other, m.
    pub b: Vec3,
    /// Radius, m: the mean of both ends of the wood.
    pub radius_m: f32,
    /// Number of the model's beam.
    pub beam: u32,
}

impl Limbs {
    pub(super) fn new(skeleton: &[SkeletonBeam], beams: &[BeamDynamics]) -> Self {
        let chosen = chosen(skeleton);
        let mut numbers = vec![NO_PARENT; skeleton.len()];
        let mut out = Self::default();
        for (index, beam) in skeleton.iter().enumerate().filter(|(index, _)| chosen[*index]) {
            numbers[index] = out.limbs.len() as u32;
            let places = [0.0, 0.5, 1.0];
            out.limbs.push(Limb {
                beam: index as u32,
                axis: places.map(|s| beam.path(s)),
                radii_m: places.map(|s| beam.radius_m(s)),
                order: beam.order,
            });
            let parent = beam.parent.map_or(NO_PARENT, |parent| numbers[parent as usize]);
            out.beams.push(BeamDynamics { parent, ..beams[index] });
        }
        out
    }

    /// All of them.
    #[must_use]
    pub fn limbs(&self) -> &[Limb] {
        &self.limbs
    }

    /// Their dynamics: what poses these, poses them as they are posed in the whole tree.
    #[must_use]
    pub fn beams(&self) -> &[BeamDynamics] {
        &self.beams
    }

    /// Where a place of a limb's rest frame, bound at `s` of its axis, is in its pose.
    pub(super) fn carry(&self, limb: usize, s: f32, rest: Vec3, poses: &[BeamPose]) -> Vec3 {
        let pose = poses.get(limb).copied().unwrap_or(BeamPose::REST);
        self.beams.get(limb).map_or(rest, |beam| pose.carry(beam, s, rest).0)
    }

    pub(super) fn cones(&self, poses: &[BeamPose]) -> Vec<RoundCone> {
        let of_limb = |(index, limb): (usize, &Limb)| {
            let [root, middle, tip] = [0, 1, 2].map(|k| self.carry(index, 0.5 * k as f32, limb.axis[k], poses));
            let [thick, mean, thin] = limb.radii_m;
            [
                RoundCone { ends: [root, middle], radii_m: [thick, mean] },
                RoundCone { ends: [middle, tip], radii_m: [mean, thin] },
            ]
        };
        self.limbs.iter().enumerate().flat_map(of_limb).collect()
    }

    pub(super) fn hit(&self, cones: &[RoundCone], ray: &BodyRay) -> Option<LimbHit> {
        let [from_m, mut to_m] = ray.part_m;
        let mut first = None;
        for (number, cone) in cones.iter().enumerate() {
            if cone.may_be_hit(ray.origin, ray.direction)
                && let Some(hit_m) = cone.hit(ray.origin, ray.direction, from_m)
                && hit_m <= to_m
                && first.is_none_or(|_| hit_m < to_m)
            {
                (first, to_m) = (Some(number), hit_m);
            }
        }
        let number = first?;
        let (along, normal) = cones[number].surface(ray.origin + to_m * ray.direction);
        let at = 0.5 * ((number % 2) as f32 + along);
        Some(LimbHit { beam: self.limbs[number / 2].beam, at, distance_m: to_m, normal })
    }

    pub(super) fn capsules(&self, cones: &[RoundCone], least_radius_m: f32) -> Vec<TreeCapsule> {
        let thick = |pair: &(usize, &RoundCone)| self.limbs[pair.0 / 2].radii_m[0] >= least_radius_m;
        let capsule = |(number, cone): (usize, &RoundCone)| TreeCapsule {
            a: cone.ends[0],
            b: cone.ends[1],
            radius_m: 0.5 * (cone.radii_m[0] + cone.radii_m[1]),
            beam: self.limbs[number / 2].beam,
        };
        cones.iter().enumerate().filter(thick).map(capsule).collect()
    }
}

/// Which beams are limbs: the thickest, and all that bear one.
fn chosen(skeleton: &[SkeletonBeam]) -> Vec<bool> {
    let stem_m = skeleton.first().map_or(0.0, |stem| stem.base_radius_m);
    let least_m = LEAST_RADIUS_M.min(LEAST_SHARE * stem_m);
    let mut thick: Vec<usize> = (0..skeleton.len()).filter(|index| skeleton[*index].base_radius_m >= least_m).collect();
    thick.sort_by(|a, b| skeleton[*b].base_radius_m.total_cmp(&skeleton[*a].base_radius_m).then(a.cmp(b)));
    let mut chosen = vec![false; skeleton.len()];
    let mut count = 0;
    for limb in thick {
        let mut bearing = Vec::new();
        let mut next = Some(limb);
        while let Some(index) = next.filter(|index| !chosen[*index]) {
            bearing.push(index);
            next = skeleton[index].parent.map(|parent| parent as usize);
        }
        if count + bearing.len() > MOST_LIMBS {
            break;
        }
        count += bearing.len();
        bearing.into_iter().for_each(|index| chosen[index] = true);
    }
    chosen
}
