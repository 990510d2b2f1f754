//! What wind, rot and snow have broken: snapped tops, stubs of branches, dead trees.
//!
//! A tree breaks after it has grown, so its wood keeps the thickness that it grew with. A branch snaps at a place
//! drawn uniformly from `remains` to 1 of its length; with it goes all that grew beyond. Of a beam's path (a parabola)
//! the part up to `c` of the way is again a parabola: its bow is `c^2` times as high.

use bevy::reflect::Reflect;
use rand::{Rng, RngExt};
use serde::{Deserialize, Serialize};

use crate::{
    setting::{SettingError, require},
    tree::skeleton::{LeafCluster, SkeletonBeam, continuations},
};

/// What has happened to the trees of a species.
#[derive(Clone, Copy, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Damage {
    /// Dead trees have no leaves.
    pub dead: bool,
    /// Probability that a trunk has lost its top, 0 to 1.
    pub broken_trunks: f32,
    /// Probability that a branch is broken off to a stub, 0 to 1.
    pub broken_branches: f32,
    /// Least share of a broken branch that is left, 0.02 to 1.
    pub remains: f32,
}

impl Default for Damage {
    fn default() -> Self {
        Self { dead: false, broken_trunks: 0.0, broken_branches: 0.0, remains: 0.2 }
    }
}

impl Damage {
    pub(in crate::tree) fn validate(&self) -> Result<(), SettingError> {
        require("broken_trunks", self.broken_trunks, 0.0..=1.0)?;
        require("broken_branches", self.broken_branches, 0.0..=1.0)?;
        require("remains", self.remains, 0.02..=1.0)
    }

    /// Breaks branches of a tree whose beams have their radii.
    pub(in crate::tree) fn apply(
        &self,
        beams: &mut Vec<SkeletonBeam>,
        clusters: &mut Vec<LeafCluster>,
        random: &mut impl Rng,
    ) {
        if self.dead {
            clusters.clear();
        }
        if self.broken_trunks == 0.0 && self.broken_branches == 0.0 {
            return;
        }
        let left = self.left(beams, random);
        remove(&left, beams, clusters);
    }

    /// How much of each beam is left, 0 to 1.
    fn left(&self, beams: &[SkeletonBeam], random: &mut impl Rng) -> Vec<f32> {
        let next = continuations(beams);
        let mut continues = vec![false; beams.len()];
        next.iter().flatten().for_each(|&index| continues[index as usize] = true);
        let mut left = vec![1.0_f32; beams.len()];
        for first in (0..beams.len()).filter(|&index| !continues[index]) {
            let chance = if beams[first].order == 0 { self.broken_trunks } else { self.broken_branches };
            let (lot, place) = (random.random::<f32>(), random.random::<f32>());
            if lot >= chance {
                continue;
            }
            let chain = || std::iter::successors(Some(first), |&beam| next[beam].map(|index| index as usize));
            let length_m: f32 = chain().map(|beam| beams[beam].length_m).sum();
            let mut left_m = length_m * (self.remains + (1.0 - self.remains) * place);
            for beam in chain() {
                left[beam] = (left_m / beams[beam].length_m).clamp(0.0, 1.0);
                left_m -= beams[beam].length_m;
            }
        }
        left
    }
}

/// Less of a beam than this share is nothing.
const LEAST_LEFT: f32 = 0.01;

/// Shortens beams to what is left of them, and takes away what they carried beyond.
fn remove(left: &[f32], beams: &mut Vec<SkeletonBeam>, clusters: &mut Vec<LeafCluster>) {
    let mut places: Vec<Option<u32>> = Vec::with_capacity(beams.len());
    let mut kept: Vec<SkeletonBeam> = Vec::with_capacity(beams.len());
    for (beam, &share) in beams.iter().zip(left) {
        let carried = beam.parent.map(|parent| (places[parent as usize], left[parent as usize]));
        let lost = matches!(carried, Some((place, left)) if place.is_none() || beam.attach > left);
        if lost || share < LEAST_LEFT {
            places.push(None);
            continue;
        }
        let mut beam = shortened(beam, share);
        if let Some((place, left)) = carried {
            beam.parent = place;
            beam.attach = if beam.attach >= 1.0 { 1.0 } else { (beam.attach / left).min(1.0) };
        }
        places.push(Some(kept.len() as u32));
        kept.push(beam);
    }
    clusters.retain_mut(|cluster| {
        let (place, left) = (places[cluster.beam as usize], left[cluster.beam as usize]);
        let Some(place) = place.filter(|_| cluster.at <= left) else { return false };
        cluster.beam = place;
        cluster.at = (cluster.at / left).min(1.0);
        true
    });
    *beams = kept;
}

/// The first `share` of a beam.
fn shortened(beam: &SkeletonBeam, share: f32) -> SkeletonBeam {
    if share >= 1.0 {
        return *beam;
    }
    let chord = beam.path(share) - beam.base;
    SkeletonBeam {
        direction: chord.try_normalize().unwrap_or(beam.direction),
        length_m: chord.length(),
        tip_radius_m: beam.radius_m(share),
        bow: beam.bow * (share * share),
        ..*beam
    }
}

#[cfg(test)]
mod tests {
    use bevy::math::Vec3;

    use super::*;

    fn bowed() -> SkeletonBeam {
        SkeletonBeam {
            parent: None,
            attach: 0.0,
            base: Vec3::new(1.0, 2.0, 3.0),
            direction: Vec3::new(0.6, 0.8, 0.0),
            length_m: 4.0,
            base_radius_m: 0.2,
            tip_radius_m: 0.1,
            bow: Vec3::new(0.3, -0.2, 0.4),
            order: 0,
        }
    }

    #[test]
    fn a_broken_beam_keeps_the_path_of_the_whole_one() {
        let whole = bowed();
        let broken = shortened(&whole, 0.3);
        for s in [0.0, 0.2, 0.7, 1.0] {
            assert!(broken.path(s).distance(whole.path(0.3 * s)) < 1e-5);
            assert!((broken.radius_m(s) - whole.radius_m(0.3 * s)).abs() < 1e-6);
        }
    }

    #[test]
    fn a_break_removes_all_beyond_it_and_moves_nothing_else() {
        let trunk = bowed();
        let child = |attach: f32| SkeletonBeam {
            parent: Some(0),
            attach,
            base: trunk.path(attach),
            order: 1,
            base_radius_m: 0.05,
            ..trunk
        };
        let mut beams = vec![trunk, child(0.3), child(0.9), SkeletonBeam { parent: Some(2), order: 2, ..child(0.5) }];
        remove(&[0.5, 1.0, 1.0, 1.0], &mut beams, &mut Vec::new());
        assert_eq!(beams.len(), 2);
        assert!((beams[1].attach - 0.6).abs() < 1e-6);
        assert!(beams[1].base.distance(beams[0].path(beams[1].attach)) < 1e-5);
    }
}
