//! Who the cells are planted for.

use bevy::math::Vec3;

/// Where a viewer is, and where it looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewerPose {
    /// Where the eye is, m.
    pub eye_m: Vec3,
    /// Where it looks; its length does not matter, and zero is no direction.
    pub forward: Vec3,
}
