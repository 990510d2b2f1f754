//! Decimates a tree: its own meshes without thin branches, and with fewer but larger sprays of leaves.
//!
//! What stays is nested: a coarser tree has no branch and no spray that a finer one lacks, so that a change of level is
//! seen as little as can be. Sprays are chosen by the golden ratio, that is evenly along the branches in whose order they
//! come. Those that stay are enlarged about their anchors until they have the area of all. The vertices are those of the
//! full tree, and the same material draws them. But where branches are a pixel or two wide their tubes have fewer
//! sides.

use bevy::math::Vec3;
use std::ops::Range;

use super::settings::Decimation;
use crate::tree::{
    Species, TreeModel, coarse_wood,
    skeleton::{Skeleton, SkeletonBeam},
    vertices::{LeafVertices, WoodVertices},
};

/// The fractional part of the golden ratio: no other step spreads any number of places more evenly on a circle.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// How many radii are tried for one below which branches can be left out, and what share of the last the next is.
const RADII_TRIED: i32 = 16;
const RADIUS_STEP: f32 = 0.8;

/// Decimated meshes of one model, on the beams of the full one.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DecimatedMeshes {
    /// The branches that are thick enough.
    pub wood: WoodVertices,
    /// The sprays that are left.
    pub leaves: LeafVertices,
}

/// Decimates the meshes of a model.
#[must_use]
pub fn decimate(model: &TreeModel, decimation: &Decimation) -> DecimatedMeshes {
    DecimatedMeshes {
        wood: thick_wood(&model.wood, &model.skeleton, decimation.least_radius_m),
        leaves: fewer_leaves(&model.leaves, decimation.leaf_share),
    }
}

/// The branches whose root has at least a radius, m, and whose parents have so, too.
#[must_use]
pub(crate) fn thick_wood(wood: &WoodVertices, skeleton: &Skeleton, least_radius_m: f32) -> WoodVertices {
    let stays = thick_beams(skeleton, least_radius_m);
    let mut out = WoodVertices::default();
    for tube in tubes(&wood.indices) {
        // A tube starts on its parent, and ends on its own last beam.
        let tip = wood.indices[tube.end - 1] as usize;
        if stays[wood.sway[tip][0] as usize] {
            out.append(wood, &wood.indices[tube]);
        }
    }
    out
}

/// The same branches in few vertices.
#[must_use]
pub(crate) fn coarse_thick_wood(species: &Species, skeleton: &Skeleton, least_radius_m: f32) -> WoodVertices {
    let stays = thick_beams(skeleton, least_radius_m);
    coarse_wood(species, skeleton, |beam| stays[beam])
}

/// The greatest radius, m, up to `most_m`, below which branches can be left out while the rest keeps that share of the side
/// area of all wood: of a tree without leaves, branches are what is seen. 0 if not even the thinnest can.
#[must_use]
pub fn prunable_radius_m(skeleton: &Skeleton, most_m: f32, share: f32) -> f32 {
    let side_m2 = |beam: &SkeletonBeam| beam.length_m * (beam.base_radius_m + beam.tip_radius_m);
    let all_m2: f32 = skeleton.beams.iter().map(side_m2).sum();
    let leaves_enough = |radius_m: &f32| {
        let stays = thick_beams(skeleton, *radius_m);
        let left = skeleton.beams.iter().zip(stays).filter(|(_, stays)| *stays);
        left.map(|(beam, _)| side_m2(beam)).sum::<f32>() >= share * all_m2
    };
    (0..RADII_TRIED).map(|tried| most_m * RADIUS_STEP.powi(tried)).find(leaves_enough).unwrap_or(0.0)
}

/// For each beam whether it is part of a branch that stays; stems always are.
fn thick_beams(skeleton: &Skeleton, least_radius_m: f32) -> Vec<bool> {
    let continuations = skeleton.continuations();
    let mut stays: Vec<bool> = Vec::with_capacity(skeleton.beams.len());
    for (index, beam) in (0u32..).zip(&skeleton.beams) {
        let own = |parent: u32| {
            let continues = continuations[parent as usize] == Some(index);
            stays[parent as usize] && (continues || beam.base_radius_m >= least_radius_m)
        };
        let own = beam.parent.is_none_or(own);
        stays.push(own);
    }
    stays
}

/// Where the triangles of each tube are: a tube's vertices all come after those of the tubes before.
fn tubes(indices: &[u32]) -> Vec<Range<usize>> {
    let mut tubes: Vec<Range<usize>> = Vec::new();
    let mut highest = None;
    for (triangle, corners) in indices.chunks_exact(3).enumerate() {
        let start = 3 * triangle;
        let lowest = corners.iter().min().copied();
        match tubes.last_mut() {
            Some(tube) if lowest <= highest => tube.end = start + 3,
            _ => tubes.push(start..start + 3),
        }
        highest = highest.max(corners.iter().max().copied());
    }
    tubes
}

impl WoodVertices {
    /// Adds triangles of another mesh, with their vertices.
    fn append(&mut self, from: &Self, triangles: &[u32]) {
        let (Some(&low), Some(&high)) = (triangles.iter().min(), triangles.iter().max()) else { return };
        let first = self.positions.len() as u32;
        let range = low as usize..=high as usize;
        self.positions.extend_from_slice(&from.positions[range.clone()]);
        self.normals.extend_from_slice(&from.normals[range.clone()]);
        self.uvs.extend_from_slice(&from.uvs[range.clone()]);
        self.sway.extend_from_slice(&from.sway[range]);
        self.indices.extend(triangles.iter().map(|index| index - low + first));
    }
}

/// A share of the sprays, enlarged so that they have the area of all.
pub(super) fn fewer_leaves(leaves: &LeafVertices, share: f32) -> LeafVertices {
    let sprays = sprays(leaves);
    let stays = |&(index, _): &(usize, &Spray)| is_chosen(index, share);
    let mut out = LeafVertices::default();
    sprays.iter().enumerate().filter(stays).for_each(|(_, spray)| out.append(leaves, spray));
    let (all_m2, left_m2) = (area_m2(leaves), area_m2(&out));
    if left_m2 > 0.0 && out.indices.len() < leaves.indices.len() {
        out.enlarge((all_m2 / left_m2).sqrt());
    }
    out
}

/// Whether the spray of an index is among the share that stays. The first always is.
fn is_chosen(index: usize, share: f32) -> bool {
    (index as f64 * GOLDEN).fract() < f64::from(share)
}

/// The vertices and the indices of one spray.
struct Spray {
    vertices: Range<usize>,
    indices: Range<usize>,
}

/// The sprays of a mesh: consecutive vertices with one anchor and one phase.
fn sprays(leaves: &LeafVertices) -> Vec<Spray> {
    let mut sprays: Vec<Spray> = Vec::new();
    for vertex in 0..leaves.positions.len() {
        let alike = |other: usize| {
            leaves.anchor[other] == leaves.anchor[vertex] && leaves.sway[other][2] == leaves.sway[vertex][2]
        };
        match sprays.last_mut() {
            Some(spray) if alike(spray.vertices.start) => spray.vertices.end = vertex + 1,
            _ => sprays.push(Spray { vertices: vertex..vertex + 1, indices: 0..0 }),
        }
    }
    let mut next = 0;
    for spray in &mut sprays {
        let own = leaves.indices[next..].iter().take_while(|&&index| (index as usize) < spray.vertices.end).count();
        spray.indices = next..next + own;
        next += own;
    }
    sprays
}

impl LeafVertices {
    fn append(&mut self, from: &Self, spray: &Spray) {
        let (first, low) = (self.positions.len() as u32, spray.vertices.start as u32);
        let range = || spray.vertices.clone();
        self.positions.extend_from_slice(&from.positions[range()]);
        self.normals.extend_from_slice(&from.normals[range()]);
        self.uvs.extend_from_slice(&from.uvs[range()]);
        self.sway.extend_from_slice(&from.sway[range()]);
        self.axis.extend_from_slice(&from.axis[range()]);
        self.anchor.extend_from_slice(&from.anchor[range()]);
        self.indices.extend(from.indices[spray.indices.clone()].iter().map(|index| index - low + first));
    }

    /// Makes all sprays larger about their anchors.
    fn enlarge(&mut self, scale: f32) {
        for (position, anchor) in self.positions.iter_mut().zip(&self.anchor) {
            let anchor = Vec3::from_slice(anchor);
            *position = (anchor + (Vec3::from_array(*position) - anchor) * scale).to_array();
        }
    }
}

/// Area of all triangles, m^2.
fn area_m2(leaves: &LeafVertices) -> f32 {
    let corner = |index: u32| Vec3::from_array(leaves.positions[index as usize]);
    let area = |triple: &[u32]| {
        let [a, b, c] = [triple[0], triple[1], triple[2]].map(corner);
        f64::from(0.5 * (b - a).cross(c - a).length())
    };
    leaves.indices.chunks_exact(3).map(area).sum::<f64>() as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    fn oak() -> TreeModel {
        TreeModel::bake(&Species::default(), 60.0, 2)
    }

    fn decimated(model: &TreeModel, least_radius_m: f32, leaf_share: f32) -> DecimatedMeshes {
        decimate(model, &Decimation { least_radius_m, leaf_share })
    }

    #[test]
    fn without_decimation_the_tree_stays_as_it_is() {
        let model = oak();
        let all = decimated(&model, 0.0, 1.0);
        assert_eq!((all.wood, all.leaves), (WoodVertices::clone(&model.wood), LeafVertices::clone(&model.leaves)));
    }

    #[test]
    fn levels_are_nested() {
        let model = oak();
        let levels = [(0.02, 0.7), (0.04, 0.4), (0.08, 0.1), (1.0, 0.02)]
            .map(|(radius, share)| decimated(&model, radius, share));
        for pair in levels.windows(2) {
            let (finer, coarser) = (&pair[0], &pair[1]);
            let has = |meshes: &DecimatedMeshes, position: &[f32; 3]| meshes.wood.positions.contains(position);
            assert!(coarser.wood.positions.iter().all(|position| has(finer, position)));
            assert!(coarser.leaves.anchor.iter().all(|anchor| finer.leaves.anchor.contains(anchor)));
            assert!(coarser.leaves.positions.len() < finer.leaves.positions.len());
            assert!(!coarser.wood.indices.is_empty() && coarser.wood.indices.len() < finer.wood.indices.len());
        }
    }

    #[test]
    fn a_prunable_radius_keeps_the_share_of_bare_wood() {
        let model = oak();
        let beams = &model.skeleton.beams;
        let continuations = model.skeleton.continuations();
        // Down to the ground, all that branches off is thick enough.
        let stays = |radius_m: f32, mut beam: usize| loop {
            let Some(parent) = beams[beam].parent.map(|parent| parent as usize) else { return true };
            if continuations[parent] != Some(beam as u32) && beams[beam].base_radius_m < radius_m {
                return false;
            }
            beam = parent;
        };
        let side_m2 =
            |beam: &usize| beams[*beam].length_m * 0.5 * (beams[*beam].base_radius_m + beams[*beam].tip_radius_m);
        let all_m2: f32 = (0..beams.len()).map(|beam| side_m2(&beam)).sum();
        let left = |radius_m| {
            (0..beams.len()).filter(|beam| stays(radius_m, *beam)).map(|beam| side_m2(&beam)).sum::<f32>() / all_m2
        };
        let mut before_m = 0.3;
        for share in [0.3, 0.5, 0.7, 0.9] {
            let radius_m = prunable_radius_m(&model.skeleton, 0.3, share);
            assert!(left(radius_m) > share, "{share}: {} by {radius_m} m", left(radius_m));
            assert!(left(radius_m / RADIUS_STEP) < share, "{share}: more may go than below {radius_m} m");
            assert!(radius_m <= before_m, "{share}: {radius_m} m");
            before_m = radius_m;
        }
        assert_eq!(prunable_radius_m(&model.skeleton, 0.01, 0.3), 0.01);
    }

    #[test]
    fn fewer_leaves_keep_the_whole_area() {
        let leaves = oak().leaves;
        for share in [0.5, 0.2, 0.05] {
            let fewer = fewer_leaves(&leaves, share);
            assert!((area_m2(&fewer) / area_m2(&leaves) - 1.0).abs() < 1e-4);
            let left = fewer.indices.len() as f32 / leaves.indices.len() as f32;
            // The golden ratio is never off by two of its places, of some hundred.
            let places = leaves.indices.len() as f32 / 6.0;
            assert!((left - share).abs() < 2.0 / places, "{left} for {share}");
            assert!(fewer.indices.iter().all(|&index| (index as usize) < fewer.positions.len()));
        }
    }

    #[test]
    fn triangles_of_what_stays_are_unchanged() {
        let model = oak();
        let thick = thick_wood(&model.wood, &model.skeleton, 0.03);
        let corners = |wood: &WoodVertices| -> Vec<[[f32; 3]; 3]> {
            let triples = wood.indices.chunks_exact(3);
            triples.map(|triple| std::array::from_fn(|corner| wood.positions[triple[corner] as usize])).collect()
        };
        let all = corners(&model.wood);
        let mut next = all.iter();
        // In the same order.
        assert!(corners(&thick).iter().all(|triangle| next.any(|other| other == triangle)));
    }
}
