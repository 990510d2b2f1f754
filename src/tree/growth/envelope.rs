//! The envelope of a crown: a solid of revolution about the trunk that branches do not leave.
//!
//! Reeves & Blau (1985, section 3.1) bound their trees by an ellipsoid or a cone; a column, a dome, a vase and a paraboloid are
//! added for the habits of poplars, pines and shrubs. All are one quadric between two heights: with a point's coordinates
//! `x, z` in units of the radius and `y` in units of the height from the place given in the table,
//!
//! ```text
//! x^2 + z^2 + k y^2 + l y <= m,   base <= height <= top
//!
//! shape           k   l   m   y = 0       unit of y
//! ellipsoid       1   0   1   the middle  half the height
//! dome            1   0   1   the base    the height
//! cylinder        0   0   1   the middle  half the height
//! cone           -1   0   0   the top     the height
//! paraboloid      0   1   0   the top     the height
//! inverted cone  -1   0   0   the base    the height
//! ```
//!
//! Every one is convex, so that a ray leaves it once. The same distance from the surface shades the crown (their
//! section 4): see [`Envelope::depth`].

use bevy::{math::Vec3, reflect::Reflect};
use serde::{Deserialize, Serialize};

use crate::setting::{SettingError, require};

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
    /// Fuller and blunt on top, a juniper's: half way up it has 0.71 of the radius, where a cone has 0.5.
    Paraboloid,
    /// A column: a lombardy poplar's.
    Cylinder,
    /// The upper half of an ellipsoid, flat below: the umbrella of an old pine.
    Dome,
    /// A cone on its apex: the vase of an elm or of a shrub's stems.
    InvertedCone,
}

impl Default for Envelope {
    /// A pedunculate oak standing free.
    fn default() -> Self {
        Self { shape: EnvelopeShape::Ellipsoid, base_m: 2.2, top_m: 16.5, radius_m: 7.8 }
    }
}

impl Envelope {
    pub(super) fn validate(&self) -> Result<(), SettingError> {
        require("top_m", self.top_m, 0.5..=120.0)?;
        require("radius_m", self.radius_m, 0.1..=60.0)?;
        require("base_m", self.base_m, 0.0..=0.95 * self.top_m)
    }

    /// The same envelope, `height` times as high and `width` times as wide.
    #[must_use]
    pub fn scaled(self, height: f32, width: f32) -> Self {
        Self {
            shape: self.shape,
            base_m: self.base_m * height,
            top_m: self.top_m * height,
            radius_m: self.radius_m * width,
        }
    }

    /// The envelope of this shape around points that have grown without one.
    #[must_use]
    pub fn around(shape: EnvelopeShape, points: impl IntoIterator<Item = Vec3>) -> Self {
        let least = Self { shape, base_m: f32::MAX, top_m: 0.02, radius_m: 0.01 };
        let envelope = points.into_iter().fold(least, |envelope, point| Self {
            shape,
            base_m: envelope.base_m.min(point.y),
            top_m: envelope.top_m.max(point.y),
            radius_m: envelope.radius_m.max(point.x.hypot(point.z)),
        });
        Self { base_m: envelope.base_m.clamp(0.0, 0.95 * envelope.top_m), ..envelope }
    }

    /// Distance along the unit vector `direction` from `from` to where the ray leaves the envelope for good, m;
    /// 0 where it never is inside.
    #[must_use]
    pub fn exit_distance_m(&self, from: Vec3, direction: Vec3) -> f32 {
        let quadric = self.quadric();
        let (p, d) = (quadric.local(from), direction / quadric.unit);
        // x^2 + z^2 + k y^2 + l y - m along the ray: a t^2 + 2 b t + c.
        let a = d.x * d.x + d.z * d.z + quadric.k * d.y * d.y;
        let b = p.x * d.x + p.z * d.z + quadric.k * p.y * d.y + 0.5 * quadric.l * d.y;
        let c = p.x * p.x + p.z * p.z + quadric.k * p.y * p.y + quadric.l * p.y - quadric.m;
        let between = slab(from.y, direction.y, self.base_m, self.top_m);
        let pieces = below_zero(a, b, c).map(|piece| meet(piece, between));
        // Of the two nappes of a cone one lies between the heights, and the other touches it in the apex at most.
        let longest = if length(pieces[1]) > length(pieces[0]) { pieces[1] } else { pieces[0] };
        if length(longest) < 0.0 { 0.0 } else { longest.1.max(0.0) }
    }

    /// How deep a point is in the crown: 0 at the surface and outside, 1 in the middle or on the axis. Below a cone or a paraboloid it
    /// is 1.
    #[must_use]
    pub fn depth(&self, point: Vec3) -> f32 {
        let quadric = self.quadric();
        let local = quadric.local(point);
        let across = local.x.hypot(local.z);
        let outwards = match self.shape {
            EnvelopeShape::Ellipsoid => local.length(),
            EnvelopeShape::Dome if local.y >= 0.0 => local.length(),
            EnvelopeShape::Cone | EnvelopeShape::Paraboloid if point.y < self.base_m => 0.0,
            EnvelopeShape::Cone => across / (-local.y).max(1e-4),
            EnvelopeShape::Paraboloid => across / (-local.y).max(1e-8).sqrt(),
            EnvelopeShape::Cylinder => across.max(local.y.abs()),
            // The light falls in from above.
            EnvelopeShape::InvertedCone if local.y > 0.0 => (across / local.y.max(1e-4)).max(local.y),
            EnvelopeShape::Dome | EnvelopeShape::InvertedCone => 1.0,
        };
        (1.0 - outwards).clamp(0.0, 1.0)
    }

    /// Unit vector out of the crown, towards the light: the normal of the level surface through the point; in an inverted
    /// cone, whose side faces the ground, the way from its apex.
    #[must_use]
    pub fn outward(&self, point: Vec3) -> Vec3 {
        let quadric = self.quadric();
        let local = quadric.local(point);
        let gradient = match self.shape {
            EnvelopeShape::Ellipsoid | EnvelopeShape::Dome => local / quadric.unit,
            EnvelopeShape::Cylinder => Vec3::new(local.x, 0.0, local.z),
            EnvelopeShape::Cone => {
                Vec3::new(point.x, 0.0, point.z).normalize_or_zero() + Vec3::Y * (self.radius_m / quadric.unit.y)
            }
            EnvelopeShape::Paraboloid => Vec3::new(2.0 * local.x, 1.0, 2.0 * local.z) / quadric.unit,
            EnvelopeShape::InvertedCone => Vec3::new(point.x, (point.y - self.base_m).max(0.0), point.z),
        };
        gradient.try_normalize().unwrap_or(Vec3::Y)
    }

    /// Horizontal radius at a height, m: 0 above the top and below the base.
    #[must_use]
    pub fn girth_m(&self, height_m: f32) -> f32 {
        if !(self.base_m..=self.top_m).contains(&height_m) {
            return 0.0;
        }
        let quadric = self.quadric();
        let y = (height_m - quadric.origin_m) / quadric.unit.y;
        self.radius_m * (quadric.m - quadric.k * y * y - quadric.l * y).max(0.0).sqrt()
    }

    /// Middle of the crown, m.
    #[must_use]
    pub fn centre(&self) -> Vec3 {
        Vec3::Y * (0.5 * (self.base_m + self.top_m))
    }

    fn quadric(&self) -> Quadric {
        let height_m = self.top_m - self.base_m;
        let middle_m = 0.5 * (self.base_m + self.top_m);
        let (k, l, m, origin_m, unit_m) = match self.shape {
            EnvelopeShape::Ellipsoid => (1.0, 0.0, 1.0, middle_m, 0.5 * height_m),
            EnvelopeShape::Dome => (1.0, 0.0, 1.0, self.base_m, height_m),
            EnvelopeShape::Cylinder => (0.0, 0.0, 1.0, middle_m, 0.5 * height_m),
            EnvelopeShape::Cone => (-1.0, 0.0, 0.0, self.top_m, height_m),
            EnvelopeShape::Paraboloid => (0.0, 1.0, 0.0, self.top_m, height_m),
            EnvelopeShape::InvertedCone => (-1.0, 0.0, 0.0, self.base_m, height_m),
        };
        Quadric { k, l, m, origin_m, unit: Vec3::new(self.radius_m, unit_m, self.radius_m) }
    }
}

/// A row of the table at the top of this file.
struct Quadric {
    k: f32,
    l: f32,
    m: f32,
    origin_m: f32,
    unit: Vec3,
}

impl Quadric {
    fn local(&self, point: Vec3) -> Vec3 {
        (point - Vec3::Y * self.origin_m) / self.unit
    }
}

/// A stretch of a ray, from and to; empty where the second is the smaller.
type Stretch = (f32, f32);

const NOWHERE: Stretch = (f32::INFINITY, f32::NEG_INFINITY);
const EVERYWHERE: Stretch = (f32::NEG_INFINITY, f32::INFINITY);

fn meet(one: Stretch, other: Stretch) -> Stretch {
    (one.0.max(other.0), one.1.min(other.1))
}

fn length(stretch: Stretch) -> f32 {
    stretch.1 - stretch.0
}

/// Where a ray is between two heights.
fn slab(from_m: f32, climb: f32, base_m: f32, top_m: f32) -> Stretch {
    if climb.abs() < 1e-6 {
        return if (base_m..=top_m).contains(&from_m) { EVERYWHERE } else { NOWHERE };
    }
    let (base, top) = ((base_m - from_m) / climb, (top_m - from_m) / climb);
    (base.min(top), base.max(top))
}

/// Where `a t^2 + 2 b t + c <= 0`: at most two stretches.
fn below_zero(a: f32, b: f32, c: f32) -> [Stretch; 2] {
    let discriminant = b * b - a * c;
    if a.abs() < 1e-7 {
        let stretch = match b {
            b if b.abs() < 1e-9 => return if c <= 0.0 { [EVERYWHERE, NOWHERE] } else { [NOWHERE; 2] },
            b if b > 0.0 => (f32::NEG_INFINITY, -c / (2.0 * b)),
            b => (-c / (2.0 * b), f32::INFINITY),
        };
        return [stretch, NOWHERE];
    }
    if discriminant < 0.0 {
        return if a > 0.0 { [NOWHERE; 2] } else { [EVERYWHERE, NOWHERE] };
    }
    // Both roots without cancellation: their product is c/a.
    let sum = -(b + discriminant.sqrt().copysign(b));
    let (one, other) = (sum / a, if sum == 0.0 { 0.0 } else { c / sum });
    let (near, far) = (one.min(other), one.max(other));
    if a > 0.0 { [(near, far), NOWHERE] } else { [(f32::NEG_INFINITY, near), (far, f32::INFINITY)] }
}

#[cfg(test)]
mod tests;
