//! Boxes along the axes, and on which side of a plane they are.

use bevy::math::{Vec3, Vec4, Vec4Swizzles};

/// A length from 0 to `most_m`, m; what is no number is 0.
pub(super) fn clamped_length(length_m: f32, most_m: f32) -> f32 {
    if length_m > 0.0 { length_m.min(most_m) } else { 0.0 }
}

/// A box along the axes, m.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    pub centre: Vec3,
    pub half: Vec3,
}

impl Bounds {
    pub(super) fn from_min_max(min: Vec3, max: Vec3) -> Self {
        Self { centre: 0.5 * (min + max), half: 0.5 * (max - min) }
    }

    pub(super) fn top_m(&self) -> f32 {
        self.centre.y + self.half.y
    }

    /// Distance of its nearest point, 0 within.
    pub(super) fn distance(&self, point: Vec3) -> f32 {
        ((point - self.centre).abs() - self.half).max(Vec3::ZERO).length()
    }

    /// The greatest height of its points over a plane (below 0: all of it is behind).
    pub(super) fn greatest_height(&self, plane: Vec4) -> f32 {
        plane.xyz().dot(self.centre) + plane.w + plane.xyz().abs().dot(self.half)
    }

    /// The box about it and itself moved along `path`.
    pub(super) fn swept(&self, path: Vec3) -> Self {
        Self { centre: self.centre + 0.5 * path, half: self.half + 0.5 * path.abs() }
    }
}
