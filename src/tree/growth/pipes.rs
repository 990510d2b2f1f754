//! The radii of the wood, by the pipe model.
//!
//! Shinozaki et al. (1964): a tree is a bundle of unit pipes, one from each bunch of leaves down to the root, so a
//! cross-section counts the leaves beyond it. With Murray's exponent `e` (2 is Leonardo's rule of equal areas), a
//! beam beyond which `n` of the tree's `N` leaf clusters lie has the radius `R (n / N)^(1/e)`, `R` the trunk's.
//!
//! A trunk so keeps what real ones have: with its leaves it could bear 5 to 70 times its weight before it would buckle, which
//! is 1.7 to 4 times its height (McMahon 1973, Science 179, 1201: a quarter of the critical height).

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

#[cfg(test)]
mod tests {
    use super::*;
    use bevy::math::Vec3;

    fn beam(parent: Option<u32>, attach: f32, order: u8) -> SkeletonBeam {
        SkeletonBeam {
            parent,
            attach,
            base: Vec3::Y * attach,
            direction: if order == 0 { Vec3::Y } else { Vec3::X },
            length_m: 1.0,
            base_radius_m: 0.0,
            tip_radius_m: 0.0,
            bow: Vec3::ZERO,
            order,
        }
    }

    /// Without it a stem's end would be a tenth as thick as the wood that its uppermost branch needs.
    #[test]
    fn a_stem_is_as_thick_at_its_top_as_what_grows_there_needs() {
        let mut beams = vec![beam(None, 0.0, 0), beam(Some(0), 0.5, 1), beam(Some(0), 0.875, 1)];
        let leaf = |beam: u32| LeafCluster {
            beam,
            at: 1.0,
            anchor: Vec3::ZERO,
            axis: Vec3::X,
            normal: Vec3::Y,
            size_m: 0.1,
            phase: 0.0,
            depth: 0.0,
            tint: 0.0,
        };
        let clusters: Vec<LeafCluster> = std::iter::once(0).chain([1; 25]).chain([2; 100]).map(leaf).collect();
        assign_radii(&mut beams, &clusters, 0.1, 2.0);
        // Half of the upper branch's 100 pipes, since it is half way up the last quarter, and its own.
        let expected_m = 0.1 * (51.0_f32 / 126.0).sqrt();
        assert!((beams[0].tip_radius_m - expected_m).abs() < 1e-6, "{}", beams[0].tip_radius_m);
        // The branches bear none and taper to their own leaves.
        assert!((beams[1].tip_radius_m - 0.1 * (25.0_f32 / 126.0).sqrt()).abs() < 1e-6);
    }
}
