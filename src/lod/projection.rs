//! Many parallel rays at once.
//!
//! Rays of one parallel projection differ only in where they start. So each triangle is asked which rays it stops, not
//! each ray which triangles it meets; what is seen is the same (a test holds it equal to [`Scene::cast`]), and an atlas is
//! done in a sixth of the time.

use bevy::math::{Vec2, Vec3};
use std::ops::Range;

use super::{
    film::Sample,
    scene::{Scene, Sight},
    views::ViewBasis,
};

/// A rectangular field of parallel rays on a tree.
pub(super) struct Projection<'a> {
    scene: &'a Scene,
    /// Rays across and down.
    rays: [usize; 2],
    /// Corners of the tree: place on the field, in rays, and depth, 0 to 1.
    corners: Vec<Vec3>,
    nearest: Vec<Seen>,
}

/// The first triangle on a ray's way.
#[derive(Clone, Copy)]
struct Seen {
    depth: f32,
    triangle: u32,
    at: [f32; 2],
}

const NOTHING: Seen = Seen { depth: f32::INFINITY, triangle: u32::MAX, at: [0.0; 2] };

impl<'a> Projection<'a> {
    pub(super) fn new(scene: &'a Scene, rays: [usize; 2]) -> Self {
        Self { scene, rays, corners: vec![Vec3::ZERO; scene.corners.len()], nearest: vec![NOTHING; rays[0] * rays[1]] }
    }

    /// Looks at what is in sight of the tree along `basis.forward`, at a box about `centre` whose half sides, m, lie along
    /// the basis.
    pub(super) fn look(&mut self, basis: &ViewBasis, centre: Vec3, half_m: Vec3, sight: Sight) {
        let [across, down] = self.rays.map(|rays| 0.5 * rays as f32);
        let middle = Vec3::new(across, down, 0.5);
        let (right, down) = (basis.right * (across / half_m.x), basis.up * (-down / half_m.y));
        let forward = basis.forward * (0.5 / half_m.z);
        for (projected, corner) in self.corners.iter_mut().zip(&self.scene.corners) {
            let from = corner.position - centre;
            *projected = Vec3::new(from.dot(right), from.dot(down), from.dot(forward)) + middle;
        }
        self.nearest.fill(NOTHING);
        for triangle in 0..self.scene.triangles_in(sight) {
            self.cover(triangle, basis.forward, sight);
        }
    }

    /// Finds the rays that a triangle stops.
    fn cover(&mut self, triangle: usize, forward: Vec3, sight: Sight) {
        let [a, b, c] = self.scene.triangles()[triangle].map(|corner| self.corners[corner as usize]);
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
        let gate = self.scene.gate(triangle, sight);
        let sides = [u_step.x, v_step.x, -u_step.x - v_step.x];
        let (to_b, to_c) = (b.z - a.z, c.z - a.z);
        for y in rows {
            let from = Vec2::new(0.5, y as f32 + 0.5) - a.truncate();
            let (u, v) = (from.dot(u_step), from.dot(v_step));
            for x in within([u, v, 1.0 - u - v], sides, &columns) {
                let at = [u + u_step.x * x as f32, v + v_step.x * x as f32];
                let depth = a.z + at[0] * to_b + at[1] * to_c;
                let seen = &mut self.nearest[y * self.rays[0] + x];
                if depth < seen.depth && gate.stops(at, forward) {
                    *seen = Seen { depth, triangle: triangle as u32, at };
                }
            }
        }
    }

    /// Whether the ray of a column and row saw anything.
    pub(super) fn hits(&self, x: usize, y: usize) -> bool {
        self.nearest[y * self.rays[0] + x].depth < f32::INFINITY
    }

    /// What the ray of a column and row saw.
    pub(super) fn sample(&self, x: usize, y: usize) -> Option<Sample> {
        let seen = self.nearest[y * self.rays[0] + x];
        (seen.depth < f32::INFINITY)
            .then(|| self.scene.hit(seen.triangle as usize, seen.at, 0.0).sample(seen.depth.clamp(0.0, 1.0)))
    }
}

/// Those of the numbers x for which none of the three `start + step x` is negative.
pub(super) fn within(start: [f32; 3], step: [f32; 3], numbers: &Range<usize>) -> Range<usize> {
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
