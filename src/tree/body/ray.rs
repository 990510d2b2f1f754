//! A way through a tree.

use bevy::math::Vec3;

/// A straight way through a tree: from `origin` along the unit vector `direction`, over `[from, to]`, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyRay {
    /// Where distances are measured from, m.
    pub origin: Vec3,
    /// Unit vector.
    pub direction: Vec3,
    /// The part of the way that counts, m.
    pub part_m: [f32; 2],
}
