//! A tube: rings of vertices along a path, joined by triangles and closed at the tip.
//!
//! Each ring is turned from the one before by the shortest rotation between their tangents, so that the tube does
//! not twist. The first vertex of a ring is repeated at its end, where the bark's u coordinate has made whole turns.

use bevy::math::{Quat, Vec3};

use super::{joint::Fillet, vertices::WoodVertices};

/// A cross-section of a branch.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ring {
    pub centre: Vec3,
    /// Unit vector towards the tip.
    pub tangent: Vec3,
    /// Mean radius, m; 0 closes the tube in a point.
    pub radius_m: f32,
    /// Number of buttresses and their height as a share of the radius.
    pub lobes: (u32, f32),
    pub beam: u32,
    pub s: f32,
    /// Where the ring belongs to a joint: `centre` is then on the line from the branch's root, `joint.1`.
    pub joint: Option<(Fillet, Vec3)>,
}

impl Ring {
    /// Radius at an angle: buttresses are rounded ridges with sharper valleys between.
    fn radius_at(&self, angle_rad: f32) -> f32 {
        let (count, height) = self.lobes;
        self.radius_m * (1.0 + height * lobe(count, angle_rad))
    }

    /// Slope of the surface around the ring: (dr/dangle) / r.
    fn slope_at(&self, angle_rad: f32) -> f32 {
        const STEP_RAD: f32 = 0.02;
        if self.lobes.0 == 0 || self.radius_m <= 0.0 {
            return 0.0;
        }
        let rise_m = self.radius_at(angle_rad + STEP_RAD) - self.radius_at(angle_rad - STEP_RAD);
        rise_m / (2.0 * STEP_RAD * self.radius_at(angle_rad))
    }
}

/// Uneven buttresses, about -1 to 1: a wave of `count` crests, modulated by one that makes them differ.
fn lobe(count: u32, angle_rad: f32) -> f32 {
    if count == 0 {
        return 0.0;
    }
    let crests = (count as f32 * angle_rad + 0.9 * (2.0 * angle_rad + 1.0).sin()).cos();
    crests * (0.75 + 0.25 * (angle_rad + 0.5).sin())
}

/// The rings of one branch.
pub(super) struct Tube {
    rings: Vec<Ring>,
    sides: usize,
    /// Whole turns of the bark around the branch.
    turns: f32,
    tile_m: f32,
    /// Factor of all radii.
    widening: f32,
}

impl Tube {
    /// A tube whose base has `base_radius_m`, in bark that repeats every `tile_m` metres.
    pub(super) fn new(base_radius_m: f32, tile_m: f32) -> Self {
        let around_m = std::f32::consts::TAU * base_radius_m;
        let turns = (around_m / tile_m).round().max(1.0);
        let tile_m = tile_m.min(4.0 * around_m / turns);
        Self { rings: Vec::new(), sides: sides(base_radius_m), turns, tile_m, widening: 1.0 }
    }

    /// The same with fewer sides, and as wide to the eye: those of a tube that is so many times as thin.
    pub(super) fn coarsened(self, thinner: f32, base_radius_m: f32) -> Self {
        let few = sides(base_radius_m / thinner);
        // The mean width of a convex shape is its circumference over pi (Cauchy).
        let circumference = |sides: usize| sides as f32 * (std::f32::consts::PI / sides as f32).sin();
        Self { sides: few, widening: circumference(self.sides) / circumference(few), ..self }
    }

    pub(super) fn push(&mut self, ring: Ring) {
        self.rings.push(Ring { radius_m: ring.radius_m * self.widening, ..ring });
    }

    /// Appends the tube; `green` is its brightness if it is green, and else 0, `light` the ambient light at a point.
    pub(super) fn write(&self, out: &mut WoodVertices, green: f32, light: impl Fn(Vec3) -> f32) {
        let mut across = self.rings[0].tangent.any_orthonormal_vector();
        let mut along_m = 0.0;
        for (index, ring) in self.rings.iter().enumerate() {
            if index > 0 {
                let before = &self.rings[index - 1];
                across = Quat::from_rotation_arc(before.tangent, ring.tangent) * across;
                along_m += before.centre.distance(ring.centre);
            }
            let (v, taper) = (along_m / self.tile_m, self.taper(index));
            let frame = Frame { across, v, taper, green, light: light(ring.centre) };
            let start = out.positions.len() as u32;
            if ring.radius_m > 0.0 {
                self.write_ring(ring, &frame, out);
                if self.rings.get(index + 1).is_some_and(|next| next.radius_m > 0.0) {
                    self.join_rings(start, &mut out.indices);
                }
            } else {
                self.write_apex(ring, &frame, out);
                self.join_apex(start, &mut out.indices);
            }
        }
    }

    /// How fast the radius shrinks towards the tip, from the neighbouring rings.
    fn taper(&self, index: usize) -> f32 {
        let before = &self.rings[index.saturating_sub(1)];
        let after = &self.rings[(index + 1).min(self.rings.len() - 1)];
        let step_m = before.centre.distance(after.centre).max(1e-4);
        ((before.radius_m - after.radius_m) / step_m).clamp(-1.5, 1.5)
    }

    fn write_ring(&self, ring: &Ring, frame: &Frame, out: &mut WoodVertices) {
        let around = ring.tangent.cross(frame.across);
        for side in 0..=self.sides {
            let share = side as f32 / self.sides as f32;
            // The seam's two vertices must be one point: the whole turn is taken as none.
            let angle_rad = std::f32::consts::TAU * if side == self.sides { 0.0 } else { share };
            let (sin, cos) = angle_rad.sin_cos();
            let radial = frame.across * cos + around * sin;
            let tangential = around * cos - frame.across * sin;
            let mut bound = (ring.beam, ring.s);
            let mut v = frame.v;
            let (position, normal) = if let Some((fillet, root)) = &ring.joint {
                let point = fillet.point(*root, ring.tangent, radial, ring.radius_m);
                v += (point.along_m - ring.centre.distance(*root)) / self.tile_m;
                bound = point.bound.unwrap_or(bound);
                (point.position, point.normal)
            } else {
                let slope = tangential * ring.slope_at(angle_rad);
                (ring.centre + radial * ring.radius_at(angle_rad), radial - slope + ring.tangent * frame.taper)
            };
            out.positions.push(position.to_array());
            out.normals.push(normal.normalize().to_array());
            out.uvs.push([share * self.turns, v]);
            out.sway.push([bound.0 as f32, bound.1, frame.green, frame.light]);
        }
    }

    fn write_apex(&self, ring: &Ring, frame: &Frame, out: &mut WoodVertices) {
        out.positions.push(ring.centre.to_array());
        out.normals.push(ring.tangent.to_array());
        out.uvs.push([0.5 * self.turns, frame.v]);
        out.sway.push([ring.beam as f32, ring.s, frame.green, frame.light]);
    }

    /// Triangles between the ring that starts at `start` and the next.
    fn join_rings(&self, start: u32, indices: &mut Vec<u32>) {
        let stride = self.sides as u32 + 1;
        for side in 0..self.sides as u32 {
            let (low, high) = (start + side, start + side + stride);
            indices.extend([low, low + 1, high, high, low + 1, high + 1]);
        }
    }

    /// Triangles between the ring before `apex` and the apex.
    fn join_apex(&self, apex: u32, indices: &mut Vec<u32>) {
        let stride = self.sides as u32 + 1;
        for side in 0..self.sides as u32 {
            let low = apex - stride + side;
            indices.extend([low, low + 1, apex]);
        }
    }
}

struct Frame {
    across: Vec3,
    v: f32,
    taper: f32,
    green: f32,
    light: f32,
}

/// Radius of the circle that fits into a tube of this base radius, as a share of the tube's radius.
pub(super) fn inradius(base_radius_m: f32) -> f32 {
    (std::f32::consts::PI / sides(base_radius_m) as f32).cos()
}

/// Sides of a tube: 3 for twigs to 16 for the thickest trunk, so that edges stay about as visible on all.
fn sides(radius_m: f32) -> usize {
    (3.0 + 24.0 * radius_m.powf(0.8)).clamp(3.0, 16.0) as usize
}
