//! The envelope of a crown: a solid of revolution about the trunk that branches do not leave.
//!
//! Reeves & Blau (1985, section 3.1) bound their trees by an ellipsoid or a cone. With `r` the radius and `h` half the
//! height about the centre `c`, a point `p` is in the ellipsoid where `|(p - c) / (r, h, r)| <= 1`; it is in the cone
//! with apex `a` and slope `k = r / (top - base)` where `x^2 + z^2 <= k^2 (a_y - y)^2` between base and apex.
//! The same distance from the surface shades the crown (their section 4): see [`Envelope::depth`].

use bevy::{math::Vec3, reflect::Reflect};
use serde::{Deserialize, Serialize};

use crate::tree::species::{SpeciesError, require};

/// What bounds a crown.
#[derive(Clone, Copy, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Envelope {
    /// Its shape.
    pub shape: EnvelopeShape,
    /// Height of its lower end above the ground, m: 0 to 100, below the top.
    pub base_m: f32,
    /// Height of its upper end, which is the tree's, m: 0.5 to 120.
    pub top_m: f32,
    /// Largest horizontal radius, m: 0.1 to 60.
    pub radius_m: f32,
}

/// Shapes of crowns.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Reflect, Serialize, Deserialize)]
pub enum EnvelopeShape {
    /// A broad-leaved tree's.
    #[default]
    Ellipsoid,
    /// A conifer's, its apex on top.
    Cone,
}

impl Default for Envelope {
    /// A pedunculate oak standing free.
    fn default() -> Self {
        Self { shape: EnvelopeShape::Ellipsoid, base_m: 2.2, top_m: 16.5, radius_m: 7.8 }
    }
}

impl Envelope {
    pub(super) fn validate(&self) -> Result<(), SpeciesError> {
        require("top_m", self.top_m, 0.5..=120.0)?;
        require("radius_m", self.radius_m, 0.1..=60.0)?;
        require("base_m", self.base_m, 0.0..=0.95 * self.top_m)
    }

    /// The same envelope `scale` times as large.
    #[must_use]
    pub fn scaled(self, scale: f32) -> Self {
        Self {
            shape: self.shape,
            base_m: self.base_m * scale,
            top_m: self.top_m * scale,
            radius_m: self.radius_m * scale,
        }
    }

    /// Distance along the unit vector `direction` from `from` to where the ray leaves the envelope for good, m;
    /// 0 where it never is inside.
    #[must_use]
    pub fn exit_distance_m(&self, from: Vec3, direction: Vec3) -> f32 {
        match self.shape {
            EnvelopeShape::Ellipsoid => self.ellipsoid_exit_m(from, direction),
            EnvelopeShape::Cone => self.cone_exit_m(from, direction),
        }
    }

    fn ellipsoid_exit_m(&self, from: Vec3, direction: Vec3) -> f32 {
        let p = (from - self.centre()) / self.semi_axes();
        let d = direction / self.semi_axes();
        let (a, b, c) = (d.length_squared(), p.dot(d), p.length_squared() - 1.0);
        let discriminant = b * b - a * c;
        if discriminant < 0.0 { 0.0 } else { ((discriminant.sqrt() - b) / a).max(0.0) }
    }

    fn cone_exit_m(&self, from: Vec3, direction: Vec3) -> f32 {
        let slope2 = self.slope() * self.slope();
        let below_apex = self.top_m - from.y;
        let a = direction.x * direction.x + direction.z * direction.z - slope2 * direction.y * direction.y;
        let b = from.x * direction.x + from.z * direction.z + slope2 * below_apex * direction.y;
        let c = from.x * from.x + from.z * from.z - slope2 * below_apex * below_apex;
        if below_apex < 0.0 || c > 0.0 {
            return 0.0;
        }
        let side = smallest_positive_root(a, b, c);
        let floor = if direction.y < 0.0 { ((self.base_m - from.y) / direction.y).max(0.0) } else { f32::INFINITY };
        let exit = side.min(floor).min(2.0 * self.top_m);
        if from.y + exit * direction.y < self.base_m - 1e-3 { 0.0 } else { exit }
    }

    /// How deep a point is in the crown: 0 at the surface and outside, 1 at the middle (of an ellipsoid) or on the
    /// axis (of a cone).
    #[must_use]
    pub fn depth(&self, point: Vec3) -> f32 {
        let outwards = match self.shape {
            EnvelopeShape::Ellipsoid => ((point - self.centre()) / self.semi_axes()).length(),
            EnvelopeShape::Cone => {
                let radius = (self.slope() * (self.top_m - point.y)).max(1e-3);
                if point.y < self.base_m { 1.0 } else { point.x.hypot(point.z) / radius }
            }
        };
        (1.0 - outwards).clamp(0.0, 1.0)
    }

    /// Unit vector out of the crown, towards the light.
    #[must_use]
    pub fn outward(&self, point: Vec3) -> Vec3 {
        let gradient = match self.shape {
            EnvelopeShape::Ellipsoid => (point - self.centre()) / (self.semi_axes() * self.semi_axes()),
            EnvelopeShape::Cone => {
                let radial = Vec3::new(point.x, 0.0, point.z).normalize_or_zero();
                radial + Vec3::Y * self.slope()
            }
        };
        gradient.try_normalize().unwrap_or(Vec3::Y)
    }

    /// Middle of the crown, m.
    #[must_use]
    pub fn centre(&self) -> Vec3 {
        Vec3::Y * (0.5 * (self.base_m + self.top_m))
    }

    fn semi_axes(&self) -> Vec3 {
        Vec3::new(self.radius_m, 0.5 * (self.top_m - self.base_m), self.radius_m)
    }

    fn slope(&self) -> f32 {
        self.radius_m / (self.top_m - self.base_m)
    }
}

/// Smallest positive `t` with `a t^2 + 2 b t + c = 0`, infinity where there is none.
fn smallest_positive_root(a: f32, b: f32, c: f32) -> f32 {
    let positive = |t: f32| if t > 0.0 { t } else { f32::INFINITY };
    if a.abs() < 1e-6 {
        return if b.abs() < 1e-9 { f32::INFINITY } else { positive(-c / (2.0 * b)) };
    }
    let discriminant = b * b - a * c;
    if discriminant < 0.0 {
        return f32::INFINITY;
    }
    let root = discriminant.sqrt();
    positive((-b - root) / a).min(positive((-b + root) / a))
}
