//! Joints: how a branch flares into the wood that bears it.
//!
//! A generator of the branch, a line along its surface, leaves the parent's surface (a cylinder about the piece of its
//! axis at the joint) where
//!
//! ```text
//! |b + t a| = R,   a, b: direction and start of the line across the parent's axis.
//! ```
//!
//! From there a quarter of an ellipse, concave, leads to the branch's own surface. With `phi` from 0 at the foot to 90
//! degrees at the neck it is `spread (1 - sin phi)` wider than the branch and `rise (1 - cos phi)` up along it, and its
//! normal turns from the parent's to the branch's: no crease. The foot's ring is sunk to the parent polygon's inscribed
//! circle, so that no gap shows, and moves with the place on the parent where it stands, so that none opens.

use bevy::math::Vec3;

/// The wood that bears a branch, about the joint.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limb {
    /// A point on its axis, m.
    pub point: Vec3,
    /// Unit vector along it.
    pub axis: Vec3,
    /// Radius of the circle inscribed to its cross-section at `point`, m.
    pub radius_m: f32,
    /// How fast that radius shrinks along the axis, m/m.
    pub taper: f32,
    /// Its beam, the place of `point` on it, and its length.
    pub beam: u32,
    pub at: f32,
    pub length_m: f32,
}

impl Limb {
    /// How far along unit `direction` from `from` the surface is left, m; where the line misses the limb, how far it
    /// is to where it comes nearest.
    pub(super) fn exit_m(&self, from: Vec3, direction: Vec3) -> f32 {
        // A limb is a slender cone: its radius where the line leaves it is found by repetition.
        let mut exit_m = self.exit_of_cylinder_m(from, direction, self.radius_m);
        for _ in 0..2 {
            let beyond_m = (from + direction * exit_m - self.point).dot(self.axis);
            let radius_m = (self.radius_m - self.taper * beyond_m).clamp(0.5 * self.radius_m, 2.0 * self.radius_m);
            exit_m = self.exit_of_cylinder_m(from, direction, radius_m);
        }
        exit_m
    }

    fn exit_of_cylinder_m(&self, from: Vec3, direction: Vec3, radius_m: f32) -> f32 {
        let a = direction.reject_from_normalized(self.axis);
        let b = (from - self.point).reject_from_normalized(self.axis);
        let (across, half) = (a.length_squared().max(1e-6), a.dot(b));
        let discriminant = half * half - across * (b.length_squared() - radius_m * radius_m);
        (discriminant.max(0.0).sqrt() - half) / across
    }

    /// Unit normal of its surface at a point.
    pub(super) fn normal(&self, point: Vec3) -> Vec3 {
        (point - self.point).reject_from_normalized(self.axis).normalize_or(self.axis.any_orthonormal_vector())
    }

    /// The place on the limb's beam beside a point, 0 to 1.
    pub(super) fn place(&self, point: Vec3) -> f32 {
        (self.at + (point - self.point).dot(self.axis) / self.length_m).clamp(0.0, 1.0)
    }
}

/// One ring of the fillet around a joint.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fillet {
    pub limb: Limb,
    /// 0 at the foot to pi/2 at the neck.
    pub phi_rad: f32,
    /// How much wider than the branch the foot is, m.
    pub spread_m: f32,
    /// Height of the fillet along the branch, m.
    pub rise_m: f32,
}

/// A vertex of a fillet.
pub(super) struct FilletPoint {
    pub position: Vec3,
    pub normal: Vec3,
    /// How far along the branch from the plane through its root, m.
    pub along_m: f32,
    /// What it moves with, if not with the branch: beam and place on it.
    pub bound: Option<(u32, f32)>,
}

impl Fillet {
    /// The angles of a fillet's rings.
    pub(super) const PHI_RAD: [f32; 3] = [0.0, 0.7, std::f32::consts::FRAC_PI_2];

    /// Height of this ring above the limb's surface, m.
    pub(super) fn height_m(&self) -> f32 {
        self.rise_m * (1.0 - self.phi_rad.cos())
    }

    /// The vertex at unit `radial` of a branch with `radius_m`, rooted at `root` towards `tangent`.
    pub(super) fn point(&self, root: Vec3, tangent: Vec3, radial: Vec3, radius_m: f32) -> FilletPoint {
        let (sin, cos) = self.phi_rad.sin_cos();
        let start = root + radial * (radius_m + self.spread_m * (1.0 - sin));
        let along_m = self.limb.exit_m(start, tangent) + self.height_m();
        let position = start + tangent * along_m;
        let normal = (self.limb.normal(position) * cos + radial * sin).normalize_or(radial);
        let bound = (self.phi_rad == 0.0).then(|| (self.limb.beam, self.limb.place(position)));
        FilletPoint { position, normal, along_m, bound }
    }
}

#[cfg(test)]
mod tests;
