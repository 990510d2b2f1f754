//! Leaves and twigs as densities in a coarse grid: how much of a ray they let through.
//!
//! Things of a projected area `a` by volume, scattered at random, let `exp(-int a ds)` of a ray through (Beer and Lambert; for crowns
//! Monsi & Saeki 1953). Leaves whose normals are spread evenly show half of their area, `G = 1/2`. Here `G` follows from the model's own
//! leaves: with `G_i` the mean of `|n_i|` along each axis, it is `sqrt(sum (G_i d_i)^2)` for the direction `d`, which is right along the
//! axes and for an even spread. Twigs show a quarter of their surface in the mean (Cauchy).
//!
//! The grid is that of the tree at rest. In the wind its layers are moved along with the stem, each as a whole: a ray is followed
//! through them one by one. Branches that sway on their own move less than a cell.

use super::{
    limbs::Limbs,
    ray::BodyRay,
    stems::{StemPlace, stem_places},
};
use crate::{
    dynamics::beam_pose::BeamPose,
    tree::{
        foliage::Foliage, generator::Growth, leaf::LeafKind, leaf::card_cover, leaf_mesh::WIDEST_AT,
        skeleton::Skeleton, species::Species, vertices::LeafVertices,
    },
};
use bevy::math::{IVec2, Vec2, Vec3, Vec3Swizzles};
use std::f32::consts::FRAC_PI_2;

/// Cells across and in height.
const ACROSS: usize = 12;
const LAYERS: usize = 16;
/// No cell is smaller, m.
const LEAST_CELL_M: f32 = 0.02;
/// Of the faces of a closed surface a ray that meets it once is stopped by the first.
const CLOSED: f32 = 0.5;
/// Share of the polygons of an impressionist's crown that their texture covers: fitted to rays through the shipped ones.
const POLYGON_COVER: f32 = 0.55;
/// Twigs stand in one another's shade along their branches, and not at random within a cell: so much of what they show counts. Fitted to
/// rays through the wood of the shipped species; the twigs of sprays are not among it.
const TWIGS: f32 = 0.7;
/// Layers that a storm bends into one another keep this share of their thickness.
const THINNEST_LAYER: f32 = 0.1;

/// The leaves and twigs of a tree.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CrownDensity {
    /// Least corner, and size of a cell, m.
    low: Vec3,
    cell: Vec3,
    /// Opaque area of leaves, and mean projected area of twigs, by volume, 1/m: layer by layer, each row by row.
    cells: Vec<[f32; 2]>,
    /// `G_i`.
    projection: Vec3,
    /// Opaque area of all leaves, m².
    leaf_area_m2: f32,
    /// For each border of a layer the places of stems there.
    stems: Vec<Vec<StemPlace>>,
}

/// A part of a ray within one cell of a crown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CrownStep {
    /// From, to, m along the ray.
    pub part_m: [f32; 2],
    /// Its optical depth: it lets `exp(-depth)` through.
    pub depth: f32,
}

impl CrownDensity {
    pub(super) fn new(species: &Species, skeleton: &Skeleton, leaves: &LeafVertices, limbs: &Limbs) -> Self {
        let twigs = twigs(skeleton, limbs);
        let points = leaves.positions.iter().map(|at| Vec3::from(*at)).chain(twigs.iter().map(|(at, _)| *at));
        let [low, high] =
            points.fold([Vec3::INFINITY, Vec3::NEG_INFINITY], |[low, high], at| [low.min(at), high.max(at)]);
        if !(low.is_finite() && high.is_finite()) {
            return Self::default();
        }
        let parts = Vec3::new(ACROSS as f32, LAYERS as f32, ACROSS as f32);
        let cell = ((high - low) / parts).max(Vec3::splat(LEAST_CELL_M));
        let cells = vec![[0.0; 2]; ACROSS * ACROSS * LAYERS];
        let mut crown = Self { low, cell, cells, ..Self::default() };
        crown.add_leaves(leaves, cover(species));
        twigs.iter().for_each(|(at, area_m2)| crown.add(*at, [0.0, *area_m2]));
        crown.stems = (0..=LAYERS).map(|border| stem_places(limbs, low.y + border as f32 * cell.y)).collect();
        crown
    }

    fn add_leaves(&mut self, leaves: &LeafVertices, cover: f32) {
        let mut projected = Vec3::ZERO;
        let mut area_m2 = 0.0;
        for corners in leaves.indices.chunks_exact(3) {
            let [a, b, c] = [0, 1, 2].map(|corner| Vec3::from(leaves.positions[corners[corner] as usize]));
            let doubled = (b - a).cross(c - a);
            projected += 0.5 * cover * doubled.abs();
            area_m2 += 0.5 * cover * doubled.length();
            // Cards may be as large as a cell: a quarter in the middle, and one at each corner.
            let middle = (a + b + c) / 3.0;
            for at in [middle, 0.5 * (middle + a), 0.5 * (middle + b), 0.5 * (middle + c)] {
                self.add(at, [0.125 * cover * doubled.length(), 0.0]);
            }
        }
        self.leaf_area_m2 = area_m2;
        self.projection = if area_m2 > 0.0 { projected / area_m2 } else { Vec3::splat(0.5) };
    }

    /// Adds areas, m², to the cell at a place.
    fn add(&mut self, at: Vec3, areas_m2: [f32; 2]) {
        let last = Vec3::new(ACROSS as f32, LAYERS as f32, ACROSS as f32) - 1.0;
        let place = ((at - self.low) / self.cell).clamp(Vec3::ZERO, last);
        let volume_m3 = self.cell.element_product();
        let [x, y, z] = place.to_array().map(|cell| cell as usize);
        let cell = &mut self.cells[(y * ACROSS + z) * ACROSS + x];
        cell.iter_mut().zip(areas_m2).for_each(|(density, area_m2)| *density += area_m2 / volume_m3);
    }

    /// Optical depth by length at a place of the tree at rest, 1/m.
    #[cfg(test)]
    pub(super) fn extinction(&self, at: Vec3, direction: Vec3, leaf_share: f32) -> f32 {
        let place = ((at - self.low) / self.cell).floor();
        let parts = Vec3::new(ACROSS as f32, LAYERS as f32, ACROSS as f32);
        if !(place.cmpge(Vec3::ZERO).all() && place.cmplt(parts).all()) {
            return 0.0;
        }
        let [x, y, z] = place.to_array().map(|cell| cell as usize);
        let [leaves, twigs] = self.cells[(y * ACROSS + z) * ACROSS + x];
        (self.projection * direction).length() * leaf_share * leaves + twigs
    }

    /// Opaque area of all leaves of the tree in leaf, one side, m².
    #[must_use]
    pub fn leaf_area_m2(&self) -> f32 {
        self.leaf_area_m2
    }

    /// Height of the middle of the leaves' extent, m.
    #[must_use]
    pub fn middle_m(&self) -> f32 {
        self.low.y + 0.5 * LAYERS as f32 * self.cell.y
    }

    /// How far each border of a layer is moved, m.
    pub(super) fn shifts(&self, limbs: &Limbs, poses: &[BeamPose]) -> Vec<Vec3> {
        let shift = |stems: &Vec<StemPlace>| {
            let moved = stems.iter().map(|stem| limbs.carry(stem.limb, stem.s, stem.rest, poses) - stem.rest);
            moved.sum::<Vec3>() / stems.len().max(1) as f32
        };
        self.stems.iter().map(shift).collect()
    }

    /// Visits the parts of a ray that lie in its cells, in order.
    pub(super) fn pass(&self, shifts: &[Vec3], ray: &BodyRay, leaf_share: f32, mut visit: impl FnMut(CrownStep)) {
        if self.cells.is_empty() || shifts.len() != LAYERS + 1 || !ray.origin.is_finite() {
            return;
        }
        let shown = (self.projection * ray.direction).length() * leaf_share;
        let borders = self.borders_m(shifts);
        let mut layer_of = |layer: usize| self.pass_layer(layer, &borders, shifts, ray, shown, &mut visit);
        if ray.direction.y >= 0.0 {
            (0..LAYERS).for_each(&mut layer_of);
        } else {
            (0..LAYERS).rev().for_each(&mut layer_of);
        }
    }

    /// Heights of the layers' borders in the pose, m: each above the one below.
    fn borders_m(&self, shifts: &[Vec3]) -> [f32; LAYERS + 1] {
        let mut borders = std::array::from_fn(|border| self.low.y + border as f32 * self.cell.y + shifts[border].y);
        for border in 1..=LAYERS {
            borders[border] = borders[border].max(borders[border - 1] + THINNEST_LAYER * self.cell.y);
        }
        borders
    }

    fn pass_layer(
        &self,
        layer: usize,
        borders: &[f32; LAYERS + 1],
        shifts: &[Vec3],
        ray: &BodyRay,
        shown: f32,
        visit: &mut impl FnMut(CrownStep),
    ) {
        let [low_m, high_m] = [borders[layer], borders[layer + 1]];
        let [from_m, to_m] = clipped(ray.part_m, ray.origin.y, ray.direction.y, [low_m, high_m]);
        if from_m >= to_m || (to_m - from_m).is_nan() {
            return;
        }
        // Where the ray is at rest, in cells.
        let at_rest = |t_m: f32| {
            let at = ray.origin + t_m * ray.direction;
            let share = (at.y - low_m) / (high_m - low_m);
            let shift = shifts[layer].lerp(shifts[layer + 1], share);
            (at - shift - self.low).xz() / self.cell.xz()
        };
        let row = layer * ACROSS * ACROSS;
        let length_m = to_m - from_m;
        walk(at_rest(from_m), at_rest(to_m), |cell, [from, to]| {
            let [leaves, twigs] = self.cells[row + cell.y as usize * ACROSS + cell.x as usize];
            let depth = (shown * leaves + twigs) * (to - from) * length_m;
            if depth > 0.0 {
                visit(CrownStep { part_m: [from, to].map(|share| from_m + share * length_m), depth });
            }
        });
    }
}

/// The part of a ray on which one coordinate lies between two values.
fn clipped([from_m, to_m]: [f32; 2], origin: f32, way: f32, [low, high]: [f32; 2]) -> [f32; 2] {
    if way == 0.0 {
        return if (low..high).contains(&origin) { [from_m, to_m] } else { [0.0, 0.0] };
    }
    let (one, other) = ((low - origin) / way, (high - origin) / way);
    [from_m.max(one.min(other)), to_m.min(one.max(other))]
}

/// Visits the cells of a layer on the way between two places, in cells, in order, with the shares of the way at which it enters and
/// leaves each (Amanatides & Woo 1987).
fn walk(from: Vec2, to: Vec2, mut visit: impl FnMut(IVec2, [f32; 2])) {
    let way = to - from;
    let side = ACROSS as f32;
    let within = clipped([0.0, 1.0], from.x, way.x, [0.0, side]);
    let [enters, leaves] = clipped(within, from.y, way.y, [0.0, side]);
    if enters >= leaves || (leaves - enters).is_nan() {
        return;
    }
    let last = IVec2::splat(ACROSS as i32 - 1);
    let mut cell = (from + enters * way).floor().as_ivec2().clamp(IVec2::ZERO, last);
    let step = IVec2::new(if way.x < 0.0 { -1 } else { 1 }, if way.y < 0.0 { -1 } else { 1 });
    let mut share = enters;
    loop {
        let border = |cell: i32, step: i32| (cell + i32::from(step > 0)) as f32;
        let at = |border: f32, from: f32, way: f32| if way == 0.0 { f32::INFINITY } else { (border - from) / way };
        let next = [at(border(cell.x, step.x), from.x, way.x), at(border(cell.y, step.y), from.y, way.y)];
        let to_next = next[0].min(next[1]).min(leaves);
        if to_next > share {
            visit(cell, [share, to_next]);
            share = to_next;
        }
        if share >= leaves {
            return;
        }
        if next[0] <= next[1] {
            cell.x += step.x;
        } else {
            cell.y += step.y;
        }
        if cell != cell.clamp(IVec2::ZERO, last) {
            return;
        }
    }
}

/// Share of the surface of the leaves that stops a ray which meets it.
fn cover(species: &Species) -> f32 {
    match &species.growth {
        Growth::Impressionist(_) => POLYGON_COVER,
        Growth::Gardner(_) => CLOSED,
        Growth::ReevesBlau(_) | Growth::Oak(_) | Growth::Fir(_) | Growth::AonoKunii(_) => {
            let Foliage { kind, leaf, .. } = &species.foliage;
            match kind {
                LeafKind::Sprays => card_cover(leaf, species.seed, WIDEST_AT),
                LeafKind::Ellipsoids(_) => CLOSED,
            }
        }
    }
}

/// The halves of all beams that are no limbs: their middles, m, and projected areas, m².
fn twigs(skeleton: &Skeleton, limbs: &Limbs) -> Vec<(Vec3, f32)> {
    let mut is_limb = vec![false; skeleton.beams.len()];
    limbs.limbs().iter().for_each(|limb| is_limb[limb.beam as usize] = true);
    let twigs = skeleton.beams.iter().zip(is_limb).filter(|(_, is_limb)| !is_limb);
    let halves = twigs.flat_map(|(beam, _)| {
        [0.25, 0.75].map(|s| (beam.path(s), TWIGS * FRAC_PI_2 * beam.radius_m(s) * 0.5 * beam.length_m))
    });
    halves.filter(|(at, area_m2)| at.is_finite() && area_m2.is_finite()).collect()
}
