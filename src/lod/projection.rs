//! Many parallel rays at once.
//!
//! Rays of one parallel projection differ only in where they start. So each triangle is asked which rays it stops, not
//! each ray which triangles it meets; what is seen is the same (a test holds it equal to [`Scene::cast`]), and an atlas is
//! done in a fifth of the time.

use bevy::math::{Vec2, Vec3};

use super::{
    film::{Film, Sample},
    scene::{Scene, Sight},
    views::ViewBasis,
};

/// A square field of parallel rays on a tree.
pub(super) struct Projection<'a> {
    scene: &'a Scene,
    /// Rays each way.
    rays: usize,
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
    pub(super) fn new(scene: &'a Scene, rays: usize) -> Self {
        Self { scene, rays, corners: vec![Vec3::ZERO; scene.corners.len()], nearest: vec![NOTHING; rays * rays] }
    }

    /// Looks at the tree along `basis.forward`, at a box about `centre` whose half sides, m, lie along the basis.
    pub(super) fn look(&mut self, basis: &ViewBasis, centre: Vec3, half_m: Vec3) {
        let rays = self.rays as f32;
        let (right, down) = (basis.right * (0.5 * rays / half_m.x), basis.up * (-0.5 * rays / half_m.y));
        let forward = basis.forward * (0.5 / half_m.z);
        let middle = Vec3::new(0.5 * rays, 0.5 * rays, 0.5);
        for (projected, corner) in self.corners.iter_mut().zip(&self.scene.corners) {
            let from = corner.position - centre;
            *projected = Vec3::new(from.dot(right), from.dot(down), from.dot(forward)) + middle;
        }
        self.nearest.fill(NOTHING);
        for triangle in 0..self.scene.triangles.len() {
            self.cover(triangle, basis.forward);
        }
    }

    /// Finds the rays that a triangle stops.
    fn cover(&mut self, triangle: usize, forward: Vec3) {
        let [a, b, c] = self.scene.triangles[triangle].map(|corner| self.corners[corner as usize]);
        let low = a.min(b).min(c).truncate();
        let high = a.max(b).max(c).truncate();
        // Rays run through the middle of their cells.
        let first = (low - 0.5).ceil().max(Vec2::ZERO);
        let last = (high - 0.5).floor().min(Vec2::splat(self.rays as f32 - 1.0));
        if first.cmpgt(last).any() {
            return;
        }
        let (ab, ac) = ((b - a).truncate(), (c - a).truncate());
        let area = ab.perp_dot(ac);
        // Downwards counts as up here, so that what faces the eye turns the other way.
        if area == 0.0 || (area > 0.0 && !self.scene.is_leaf(triangle)) {
            return;
        }
        let (u_step, v_step) = (Vec2::new(ac.y, -ac.x) / area, Vec2::new(-ab.y, ab.x) / area);
        let (first_x, last_x) = (first.x as usize, last.x as usize);
        for y in first.y as usize..=last.y as usize {
            let from = Vec2::new(first.x + 0.5, y as f32 + 0.5) - a.truncate();
            let (mut u, mut v) = (from.dot(u_step), from.dot(v_step));
            for x in first_x..=last_x {
                if u >= 0.0 && v >= 0.0 && u + v <= 1.0 {
                    let depth = a.z + u * (b.z - a.z) + v * (c.z - a.z);
                    let seen = &mut self.nearest[y * self.rays + x];
                    if depth < seen.depth && self.scene.stops(triangle, [u, v], forward, Sight::Tree) {
                        *seen = Seen { depth, triangle: triangle as u32, at: [u, v] };
                    }
                }
                u += u_step.x;
                v += v_step.x;
            }
        }
    }

    /// What the ray of a column and row saw.
    pub(super) fn sample(&self, x: usize, y: usize) -> Option<Sample> {
        let seen = self.nearest[y * self.rays + x];
        (seen.depth < f32::INFINITY)
            .then(|| self.scene.hit(seen.triangle as usize, seen.at, 0.0).sample(seen.depth.clamp(0.0, 1.0)))
    }

    /// Records all rays on a square of a film, `per_texel` x `per_texel` to a texel.
    pub(super) fn expose(&self, film: &mut Film, left: usize, top: usize, per_texel: usize) {
        let share = 1.0 / (per_texel * per_texel) as f32;
        for y in 0..self.rays {
            let row = (top + y / per_texel) * film.width + left;
            for x in 0..self.rays {
                if let Some(sample) = self.sample(x, y) {
                    film.texels[row + x / per_texel].add(&sample, share);
                }
            }
        }
    }
}
