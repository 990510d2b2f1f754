//! The radii of the wood, by the pipe model.
//!
//! Shinozaki et al. (1964): a tree is a bundle of unit pipes, one from each bunch of leaves down to the root, so a
//! cross-section counts the leaves beyond it. With Murray's exponent `e` (2 is Leonardo's rule of equal areas), a
//! beam beyond which `n` of the tree's `N` leaf clusters lie has the radius `R (n / N)^(1/e)`, `R` the trunk's.

use crate::tree::skeleton::{LeafCluster, SkeletonBeam, continuations};

/// A child is at most this thick beside its parent, so that its first ring hides inside.
const CHILD_TO_PARENT_LIMIT: f32 = 0.85;

/// Sets every beam's radii, so that none grows outward.
pub(in crate::tree) fn assign_radii(
    beams: &mut [SkeletonBeam],
    clusters: &[LeafCluster],
    trunk_radius_m: f32,
    exponent: f32,
) {
    let (at_base, at_tip) = count_pipes(beams, clusters);
    // Of several stems the thickest is the one that bears most.
    let stems = beams.iter().zip(&at_base).filter(|(beam, _)| beam.parent.is_none());
    let total = stems.map(|(_, &pipes)| pipes).fold(1.0, f32::max);
    let radius = |pipes: f32| trunk_radius_m * (pipes / total).powf(1.0 / exponent);
    let at_top = pipes_at_top(beams, &at_base, &at_tip);
    for index in 0..beams.len() {
        let beam = beams[index];
        let limit = beam.parent.map_or(trunk_radius_m, |parent| {
            let parent = &beams[parent as usize];
            let continues = beam.attach >= 1.0 && beam.order == parent.order;
            parent.radius_m(beam.attach) * if continues { 1.0 } else { CHILD_TO_PARENT_LIMIT }
        });
        beams[index].base_radius_m = radius(at_base[index]).min(limit);
        beams[index].tip_radius_m = radius(at_top[index]).min(beams[index].base_radius_m);
    }
}

/// Pipes through the base and the tip of each beam: at least one.
fn count_pipes(beams: &[SkeletonBeam], clusters: &[LeafCluster]) -> (Vec<f32>, Vec<f32>) {
    let mut at_base = vec![0.0_f32; beams.len()];
    let mut at_tip = vec![0.0_f32; beams.len()];
    for cluster in clusters {
        let carried = if cluster.at >= 1.0 { &mut at_tip } else { &mut at_base };
        carried[cluster.beam as usize] += 1.0;
    }
    for index in (0..beams.len()).rev() {
        at_tip[index] = at_tip[index].max(1.0);
        at_base[index] += at_tip[index];
        if let Some(parent) = beams[index].parent {
            let pipes = at_base[index];
            let carried = if beams[index].attach >= 1.0 { &mut at_tip } else { &mut at_base };
            carried[parent as usize] += pipes;
        }
    }
    (at_base, at_tip)
}

/// The last share of a stem whose pipes count for its tip.
const TOP_SHARE: f32 = 0.25;

/// Pipes for the tip of each beam. A beam tapers in a straight line. Where a stem bears branches up to its end, a line to the pipes of
/// that end alone would run far below those along it: the top of the stem would hardly stand under what it bears. There it is the
/// mean of the pipes along the last [`TOP_SHARE`] of the beam.
fn pipes_at_top(beams: &[SkeletonBeam], at_base: &[f32], at_tip: &[f32]) -> Vec<f32> {
    let next = continuations(beams);
    let mut at_top = at_tip.to_vec();
    for (beam, &pipes) in beams.iter().zip(at_base) {
        let Some(parent) = beam.parent.map(|parent| parent as usize) else { continue };
        let along = (beam.attach - (1.0 - TOP_SHARE)) / TOP_SHARE;
        if beams[parent].order == 0 && next[parent].is_none() && beam.attach < 1.0 && along > 0.0 {
            at_top[parent] += along * pipes;
        }
    }
    at_top
}
