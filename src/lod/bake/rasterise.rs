//! Rasterises a tree: many parallel rays at once.
//!
//! Rays of one parallel projection differ only in where they start. So each triangle is asked which rays it stops, not
//! each ray which triangles it meets. A test holds the result equal to that of single rays; an atlas is done in a sixth of
//! their time.

use bevy::math::{Vec2, Vec3};
use std::ops::Range;

use super::{
    scene::{Scene, TreeParts},
    texels::Sample,
};

/// The axes of a view: unit vectors at right angles, tree-local.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::lod) struct ViewBasis {
    /// To the right in the picture; level.
    pub right: Vec3,
    /// Up in the picture.
    pub up: Vec3,
    /// Away from the eye.
    pub forward: Vec3,
}

impl ViewBasis {
    /// Of a view from the direction `to_eye`, a unit vector.
    pub fn towards(to_eye: Vec3) -> Self {
        // From above there is no level way to the right: +x is.
        let right = Vec3::new(to_eye.z, 0.0, -to_eye.x).try_normalize().unwrap_or(Vec3::X);
        Self { right, up: to_eye.cross(right), forward: -to_eye }
    }
}

/// A rectangular field of parallel rays on a tree.
pub(in crate::lod) struct ParallelRaster<'a> {
    scene: &'a Scene,
    /// Rays across and down.
    rays: [usize; 2],
    /// Vertices of the tree: place on the field, in rays, and depth, 0 to 1.
    projected: Vec<Vec3>,
    nearest: Vec<Hit>,
    /// What was rasterised last.
    parts: TreeParts,
}

/// The first triangle on a ray's way.
#[derive(Clone, Copy)]
struct Hit {
    depth: f32,
    triangle: u32,
    at: [f32; 2],
}

const NOTHING: Hit = Hit { depth: f32::INFINITY, triangle: u32::MAX, at: [0.0; 2] };

impl<'a> ParallelRaster<'a> {
    pub fn new(scene: &'a Scene, rays: [usize; 2]) -> Self {
        let projected = vec![Vec3::ZERO; scene.vertices.len()];
        Self { scene, rays, projected, nearest: vec![NOTHING; rays[0] * rays[1]], parts: TreeParts::All }
    }

    /// Rasterises parts of the tree as seen along `basis.forward`, in a box about `centre` whose half sides, m, lie along
    /// the basis.
    pub fn project(&mut self, basis: &ViewBasis, centre: Vec3, half_m: Vec3, parts: TreeParts) {
        let [across, down] = self.rays.map(|rays| 0.5 * rays as f32);
        let middle = Vec3::new(across, down, 0.5);
        let (right, down) = (basis.right * (across / half_m.x), basis.up * (-down / half_m.y));
        let forward = basis.forward * (0.5 / half_m.z);
        for (projected, vertex) in self.projected.iter_mut().zip(&self.scene.vertices) {
            let from = vertex.position - centre;
            *projected = Vec3::new(from.dot(right), from.dot(down), from.dot(forward)) + middle;
        }
        self.nearest.fill(NOTHING);
        self.parts = parts;
        for triangle in 0..self.scene.triangles_in(parts) {
            self.rasterise(triangle, basis.forward, parts);
        }
    }

    /// Finds the rays that a triangle stops.
    fn rasterise(&mut self, triangle: usize, forward: Vec3, parts: TreeParts) {
        let [a, b, c] = self.scene.triangles()[triangle].map(|vertex| self.projected[vertex as usize]);
        let low = a.min(b).min(c);
        let high = a.max(b).max(c);
        // Rays run through the middle of their cells: from the first that is not before `low` to the last before `high`.
        let cells = |low: f32, high: f32, rays: usize| (low + 0.5) as usize..((high + 0.5) as usize).min(rays);
        let (columns, rows) = (cells(low.x, high.x, self.rays[0]), cells(low.y, high.y, self.rays[1]));
        if columns.is_empty() || rows.is_empty() {
            return;
        }
        let (ab, ac) = ((b - a).truncate(), (c - a).truncate());
        let area = ab.perp_dot(ac);
        // Downwards counts as up here, so that what faces the eye turns the other way.
        if area == 0.0 || (area > 0.0 && !self.scene.is_leaf(triangle)) {
            return;
        }
        let (u_step, v_step) = (Vec2::new(ac.y, -ac.x) / area, Vec2::new(-ab.y, ab.x) / area);
        let opacity = self.scene.opacity(triangle, parts);
        let sides = [u_step.x, v_step.x, -u_step.x - v_step.x];
        let (to_b, to_c) = (b.z - a.z, c.z - a.z);
        for y in rows {
            let from = Vec2::new(0.5, y as f32 + 0.5) - a.truncate();
            let (u, v) = (from.dot(u_step), from.dot(v_step));
            for x in non_negative([u, v, 1.0 - u - v], sides, &columns) {
                let at = [u + u_step.x * x as f32, v + v_step.x * x as f32];
                let depth = a.z + at[0] * to_b + at[1] * to_c;
                let nearest = &mut self.nearest[y * self.rays[0] + x];
                if depth < nearest.depth && opacity.stops(at, forward) {
                    *nearest = Hit { depth, triangle: triangle as u32, at };
                }
            }
        }
    }

    /// Whether the ray of a column and row hit anything.
    pub fn hits(&self, x: usize, y: usize) -> bool {
        self.nearest[y * self.rays[0] + x].depth < f32::INFINITY
    }

    /// What the ray of a column and row hit.
    pub fn sample(&self, x: usize, y: usize) -> Option<Sample> {
        let hit = self.nearest[y * self.rays[0] + x];
        let sample = || self.scene.sample(hit.triangle as usize, hit.at, hit.depth.clamp(0.0, 1.0), self.parts);
        (hit.depth < f32::INFINITY).then(sample)
    }
}

/// Those of the numbers x for which none of the three `start + step x` is negative.
pub(in crate::lod) fn non_negative(start: [f32; 3], step: [f32; 3], numbers: &Range<usize>) -> Range<usize> {
    let (mut low, mut high) = (numbers.start as f32, numbers.end as f32 - 1.0);
    for (start, step) in start.into_iter().zip(step) {
        let root = -start / step;
        if step > 0.0 {
            low = low.max(root);
        } else if step < 0.0 {
            high = high.min(root);
        } else if start < 0.0 {
            return 0..0;
        }
    }
    if low > high {
        return 0..0;
    }
    // Both are positive: a cast rounds down, and is faster than a call.
    let first = low as usize;
    first + usize::from(first as f32 != low)..high as usize + 1
}
