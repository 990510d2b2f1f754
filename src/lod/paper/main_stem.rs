//! The main stem, with which an envelope of leaves moves, and the cone that is drawn for it.

use bevy::math::{Vec2, Vec3};
use std::f32::consts::TAU;

use crate::tree::{
    skeleton::{Skeleton, SkeletonBeam},
    vertices::WoodVertices,
};

/// Sides of the trunk's cone.
const TRUNK_SIDES: u32 = 6;
/// How far the trunk reaches into the ground, m, as that of the full tree.
const ROOT_DEPTH_M: f32 = 0.35;

/// The beams, from the root, of the stem that reaches highest.
pub(super) struct MainStem<'a> {
    skeleton: &'a Skeleton,
    chain: Vec<usize>,
}

impl<'a> MainStem<'a> {
    pub fn of(skeleton: &'a Skeleton) -> Self {
        let continuations = skeleton.continuations();
        let chain = |root: usize| -> Vec<usize> {
            std::iter::successors(Some(root), |&beam| continuations[beam].map(|next| next as usize)).collect()
        };
        let height_m = |chain: &[usize]| chain.last().map_or(0.0, |&tip| skeleton.beams[tip].path(1.0).y);
        let roots = (0..skeleton.beams.len()).filter(|&beam| skeleton.beams[beam].parent.is_none());
        let chain = roots.map(chain).max_by(|a, b| height_m(a).total_cmp(&height_m(b))).unwrap_or_default();
        Self { skeleton, chain }
    }

    /// Indices of its beams.
    pub fn chain(&self) -> &[usize] {
        &self.chain
    }

    fn beams(&self) -> impl Iterator<Item = (usize, &SkeletonBeam)> {
        self.chain.iter().map(|&index| (index, &self.skeleton.beams[index]))
    }

    /// The beam at a height and the place on it; above the stem's tip, the tip.
    pub fn place(&self, height_m: f32) -> (usize, f32) {
        let Some((index, beam)) = self.beams().find(|(_, beam)| beam.path(1.0).y >= height_m).or(self.beams().last())
        else {
            return (0, 0.0);
        };
        let climb_m = beam.path(1.0).y - beam.base.y;
        (index, if climb_m > 1e-4 { ((height_m - beam.base.y) / climb_m).clamp(0.0, 1.0) } else { 1.0 })
    }

    /// A cone along the stem, a ring at each end of a beam.
    pub fn cone(&self, tile_m: f32) -> WoodVertices {
        let mut out = WoodVertices::default();
        let Some((first, root)) = self.beams().next() else { return out };
        let turns = (TAU * root.base_radius_m / tile_m).round().max(1.0);
        let mut along_m = -ROOT_DEPTH_M;
        let below = root.base - root.direction * ROOT_DEPTH_M;
        out.ring(below, root.direction, root.base_radius_m, [turns, along_m / tile_m], (first, 0.0));
        let last = self.chain.len() - 1;
        for (place, (index, beam)) in self.beams().enumerate() {
            along_m += beam.length_m + if place == 0 { ROOT_DEPTH_M } else { 0.0 };
            let radius_m = if place == last { 0.0 } else { beam.tip_radius_m };
            out.ring(beam.path(1.0), beam.tangent(1.0), radius_m, [turns, along_m / tile_m], (index, 1.0));
        }
        for low in (0..=last as u32).flat_map(|ring| (0..TRUNK_SIDES).map(move |side| ring * (TRUNK_SIDES + 1) + side))
        {
            let above = low + TRUNK_SIDES + 1;
            out.indices.extend([low, low + 1, above, above, low + 1, above + 1]);
        }
        out
    }
}

impl WoodVertices {
    /// A ring of the cone; `turns` and height in the bark.
    fn ring(&mut self, centre: Vec3, tangent: Vec3, radius_m: f32, [turns, v]: [f32; 2], (beam, at): (usize, f32)) {
        let across = tangent.any_orthonormal_vector();
        let aside = tangent.cross(across);
        for side in 0..=TRUNK_SIDES {
            let turn = side as f32 / TRUNK_SIDES as f32;
            let heading = Vec2::from_angle(TAU * if side == TRUNK_SIDES { 0.0 } else { turn });
            let outwards = across * heading.x + aside * heading.y;
            self.positions.push((centre + outwards * radius_m).to_array());
            self.normals.push(outwards.to_array());
            self.uvs.push([turn * turns, v]);
            self.sway.push([beam as f32, at, 0.0, 1.0]);
        }
    }
}
