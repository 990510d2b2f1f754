//! The wood inside a crown of polygons or ellipsoids: a trunk, and limbs that carry them.

use std::f32::consts::TAU;

use bevy::math::Vec3;
use rand::{Rng, RngExt};

use super::profile::Profile;
use crate::tree::skeleton::SkeletonBeam;

/// What keeps a beam's length positive where its ends fall together, m.
const SHORTEST_BEAM_M: f32 = 1e-3;
/// Turn about the trunk from limb to limb, rad: the golden angle of phyllotaxis.
const GOLDEN_ANGLE_RAD: f32 = 2.399_963;
/// Sag of a limb's middle as a share of its length.
const LIMB_SAG: f32 = 0.04;
/// Where a limb's branches leave it first.
const FIRST_BRANCH_AT: f32 = 0.35;

/// What the wood of a crown looks like.
pub(super) struct CrownWood {
    /// How high the trunk reaches, m.
    pub trunk_top_m: f32,
    /// Height below which no limb leaves the trunk, m.
    pub lowest_limb_m: f32,
    /// Metres that a limb rises for each metre outwards.
    pub rise: f32,
    /// Beams, parents first; radii are still to be found.
    pub beams: Vec<SkeletonBeam>,
}

impl CrownWood {
    /// A trunk of two beams, straight up.
    pub(super) fn with_trunk(trunk_top_m: f32, lowest_limb_m: f32, rise: f32) -> Self {
        let middle_m = (0.5 * (lowest_limb_m + trunk_top_m)).clamp(0.3 * trunk_top_m, 0.8 * trunk_top_m);
        let mut wood = Self { trunk_top_m, lowest_limb_m, rise, beams: Vec::new() };
        wood.push(None, 0.0, Vec3::ZERO, Vec3::Y * middle_m, 0);
        wood.push(Some(0), 1.0, Vec3::Y * middle_m, Vec3::Y * trunk_top_m, 0);
        wood
    }

    /// A limb from the trunk to `target`; returns its index.
    pub(super) fn limb(&mut self, target: Vec3) -> u32 {
        let out_m = target.x.hypot(target.z);
        let highest_m = 0.97 * self.trunk_top_m;
        let height_m = (target.y - self.rise * out_m).clamp(self.lowest_limb_m.min(highest_m), highest_m);
        let middle_m = self.beams[0].length_m;
        let (parent, from_m, length_m) =
            if height_m < middle_m { (0, 0.0, middle_m) } else { (1, middle_m, self.beams[1].length_m) };
        let attach = ((height_m - from_m) / length_m).clamp(0.0, 1.0);
        self.push(Some(parent), attach, Vec3::Y * (from_m + attach * length_m), target, 1)
    }

    /// Side branches of a limb towards `targets`, farther and farther along it.
    pub(super) fn branches(&mut self, limb: u32, targets: &[Vec3]) {
        let carrier = self.beams[limb as usize];
        for (index, &target) in targets.iter().enumerate() {
            let share = (index as f32 + 1.0) / targets.len() as f32;
            let attach = FIRST_BRANCH_AT + (0.98 - FIRST_BRANCH_AT) * share;
            self.push(Some(limb), attach, carrier.path(attach), target, 2);
        }
    }

    fn push(&mut self, parent: Option<u32>, attach: f32, base: Vec3, tip: Vec3, order: u8) -> u32 {
        let along = tip - base;
        let direction = along.try_normalize().unwrap_or(Vec3::Y);
        let length_m = along.length().max(SHORTEST_BEAM_M);
        let bow = (direction * direction.y - Vec3::Y) * (LIMB_SAG * length_m);
        self.beams.push(SkeletonBeam {
            parent,
            attach,
            base,
            direction,
            length_m,
            base_radius_m: 0.0,
            tip_radius_m: 0.0,
            bow,
            order,
        });
        self.beams.len() as u32 - 1
    }
}

/// Where limbs end: spread evenly in height and around, `reach` of the way out to the surface.
pub(super) fn limb_targets(profile: &Profile, count: u32, reach: f32, random: &mut impl Rng) -> Vec<Vec3> {
    let start_rad = random.random_range(0.0..TAU);
    (0..count)
        .map(|index| {
            // The last share is short of the base: a limb there would leave the trunk downwards.
            let polar_share = 0.12 + 0.76 * (index as f32 + random.random::<f32>()) / count as f32;
            let azimuth_rad = start_rad + GOLDEN_ANGLE_RAD * index as f32 + random.random_range(-0.2..0.2);
            let surface = profile.surface(polar_share, azimuth_rad);
            profile.core(surface).lerp(surface, reach * random.random_range(0.85..1.0))
        })
        .collect()
}

/// The nearest of the beams of `order` and beyond: its index, and the place on it.
pub(super) fn nearest(beams: &[SkeletonBeam], order: u8, point: Vec3) -> (u32, f32) {
    let place = |beam: &SkeletonBeam| ((point - beam.base).dot(beam.direction) / beam.length_m).clamp(0.0, 1.0);
    let mut best = (0, 1.0, f32::INFINITY);
    for (index, beam) in (0_u32..).zip(beams).filter(|(_, beam)| beam.order >= order) {
        let at = place(beam);
        let distance = beam.path(at).distance_squared(point);
        if distance < best.2 {
            best = (index, at, distance);
        }
    }
    (best.0, best.1)
}
