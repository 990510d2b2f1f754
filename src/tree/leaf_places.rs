//! Where leaves sit: sprays along the thin branches and at their tips, or ellipsoids on the terminal ones.

use bevy::math::Vec3;
use rand::{Rng, RngExt};

use super::{
    foliage::{CLUSTERS_LIMIT, Foliage},
    growth::{envelope::Envelope, grower::leave},
    leaf::{LeafArrangement, LeafEllipsoids, LeafKind},
    skeleton::{LeafCluster, SkeletonBeam, continuations, is_terminal},
};

/// Places leaves on all beams that carry them.
pub(super) fn place_foliage(
    foliage: &Foliage,
    beams: &[SkeletonBeam],
    envelope: &Envelope,
    random: &mut impl Rng,
) -> Vec<LeafCluster> {
    let mut clusters = Vec::new();
    let mut tones = vec![0.0; beams.len()];
    let continuations = continuations(beams);
    let is_terminal = is_terminal(beams);
    let last_branches_at = last_branches_at(beams);
    for (index, beam) in beams.iter().enumerate() {
        // A branch has a tone of its own, close to that of the branch it grows on.
        let own_tone: f32 = random.random();
        tones[index] = beam.parent.map_or(0.5, |parent| 0.6 * tones[parent as usize] + 0.4 * own_tone);
        let continues = beam.attach >= 1.0 && beam.parent.is_some_and(|p| beams[p as usize].order == beam.order);
        let first_at = match (beam.order < foliage.first_order, continues) {
            // Past its last branch a stem is a young shoot: the leader of a spruce has needles.
            (true, _) if beam.order == 0 => last_branches_at[index].unwrap_or(1.0),
            (true, _) => 1.0,
            (false, true) => 0.0,
            (false, false) => foliage.first_at,
        };
        let twig = Twig { foliage, beam, index: index as u32, envelope, tone: tones[index] };
        match &foliage.kind {
            LeafKind::Sprays => twig.place_sprays(first_at, continuations[index].is_none(), &mut clusters, random),
            LeafKind::Ellipsoids(leaves) if is_terminal[index] => twig.place_ellipsoids(leaves, &mut clusters, random),
            LeafKind::Ellipsoids(_) => {}
        }
        if clusters.len() >= CLUSTERS_LIMIT {
            clusters.truncate(CLUSTERS_LIMIT);
            break;
        }
    }
    clusters
}

/// For each beam that bears others, where the last of them leaves it: a share of its length. 1 where one continues it.
fn last_branches_at(beams: &[SkeletonBeam]) -> Vec<Option<f32>> {
    let mut last: Vec<Option<f32>> = vec![None; beams.len()];
    for beam in beams {
        let Some(parent) = beam.parent else { continue };
        let last_at = &mut last[parent as usize];
        *last_at = Some(last_at.map_or(beam.attach, |at| at.max(beam.attach)));
    }
    last
}

struct Twig<'a> {
    foliage: &'a Foliage,
    beam: &'a SkeletonBeam,
    index: u32,
    envelope: &'a Envelope,
    tone: f32,
}

impl Twig<'_> {
    fn place_sprays(&self, first_at: f32, ends: bool, clusters: &mut Vec<LeafCluster>, random: &mut impl Rng) {
        let spacing = self.foliage.spacing_m / self.beam.length_m;
        let mut roll = if random.random::<bool>() { 0.0 } else { self.foliage.roll_deg.to_radians() };
        let mut at = first_at + 0.5 * spacing * random.random::<f32>();
        let around = match self.foliage.arrangement {
            LeafArrangement::Alternate => 1,
            LeafArrangement::Opposite => 2,
            LeafArrangement::Whorled => 3,
        };
        let spread = self.foliage.roll_spread_deg.to_radians();
        while at < 1.0 && clusters.len() < CLUSTERS_LIMIT {
            for place in 0..around {
                let evenly = std::f32::consts::TAU * place as f32 / around as f32;
                let turn = roll + evenly + spread * random.random_range(-1.0..1.0);
                clusters.push(self.spray(at, self.foliage.angle_deg.to_radians(), turn, random));
            }
            roll += self.foliage.roll_deg.to_radians();
            at += spacing * random.random_range(0.7..1.3);
        }
        if ends {
            clusters.push(self.spray(1.0, 0.0, 0.0, random));
        }
    }

    /// Ellipsoids all along the beam, each somewhere in a part of its own, and the last of them at the tip.
    fn place_ellipsoids(&self, leaves: &LeafEllipsoids, clusters: &mut Vec<LeafCluster>, random: &mut impl Rng) {
        let count = leaves.count_on(self.beam.length_m);
        let first_at = self.foliage.first_at;
        for index in 0..count {
            let place = (index as f32 + random.random::<f32>()) / count as f32;
            let is_last = index + 1 == count;
            let at = if is_last { 1.0 } else { first_at + (1.0 - first_at) * place };
            let angle_deg = if is_last { 0.0 } else { self.foliage.angle_deg };
            let spread_deg = self.foliage.roll_spread_deg * random.random_range(-1.0..1.0);
            let roll_deg = self.foliage.roll_deg * index as f32 + spread_deg;
            let mut leaf = self.spray(at, angle_deg.to_radians(), roll_deg.to_radians(), random);
            leaf.size_m = 2.0 * leaves.semi_axes_of(leaf.phase).x * self.size_m(leaf.anchor);
            clusters.push(leaf);
        }
    }

    /// Sprays are smaller where the crown is narrow, so that a fir comes to a point.
    fn size_m(&self, anchor: Vec3) -> f32 {
        let size_m = self.foliage.size_m;
        size_m.min(LEAST_SIZE_SHARE * size_m + 0.7 * self.envelope.girth_m(anchor.y))
    }

    fn spray(&self, at: f32, angle_rad: f32, roll_rad: f32, random: &mut impl Rng) -> LeafCluster {
        let anchor = self.beam.path(at);
        let outward = self.envelope.outward(anchor);
        let axis = leave(self.beam.tangent(at), angle_rad, roll_rad) - Vec3::Y * self.foliage.droop;
        let axis = axis.try_normalize().unwrap_or(self.beam.direction);
        let face = outward.lerp(Vec3::Y, self.foliage.skyward) + unit(random) * self.foliage.disorder;
        LeafCluster {
            beam: self.index,
            at,
            anchor,
            axis,
            normal: face.reject_from_normalized(axis).try_normalize().unwrap_or(axis.any_orthonormal_vector()),
            size_m: self.size_m(anchor) * (1.0 + self.foliage.size_spread * random.random_range(-1.0..1.0)),
            phase: random.random(),
            depth: self.envelope.depth(anchor),
            tint: 0.6 * self.tone + 0.4 * random.random::<f32>(),
        }
    }
}

/// A spray keeps this share of its size where the crown is narrowest.
const LEAST_SIZE_SHARE: f32 = 0.4;

/// Uniform on the unit sphere (Archimedes).
fn unit(random: &mut impl Rng) -> Vec3 {
    let height: f32 = random.random_range(-1.0..1.0);
    let heading = random.random_range(0.0..std::f32::consts::TAU);
    let radius = (1.0 - height * height).sqrt();
    Vec3::new(radius * heading.cos(), height, radius * heading.sin())
}
