//! Boxes along the axes, and on which side of a plane they are.

use super::{block::SIDE, cell::Spread, view::TreeExtent};
use bevy::math::{IVec2, Vec2, Vec3, Vec4, Vec4Swizzles};

/// Places are rounded by less than this within 100 km of the origin, m.
const ROUNDING_M: f32 = 0.02;

/// A length from 0 to `most_m`, m; what is no number is 0.
pub(super) fn bounded(length_m: f32, most_m: f32) -> f32 {
    if length_m > 0.0 { length_m.min(most_m) } else { 0.0 }
}

/// A box along the axes, m.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    pub centre: Vec3,
    pub half: Vec3,
}

impl Bounds {
    /// Of plants that stand in a square, with their crowns.
    fn of_plants(corner_m: Vec2, side_m: f32, spread: Spread, extent: TreeExtent) -> Self {
        let reach_m = spread.largest * extent.reach_m + ROUNDING_M;
        let top_m = spread.highest_m + spread.largest * extent.height_m + ROUNDING_M;
        let bottom_m = spread.lowest_m - ROUNDING_M;
        let centre = corner_m + 0.5 * side_m;
        Self {
            centre: Vec3::new(centre.x, 0.5 * (bottom_m + top_m), centre.y),
            half: Vec3::new(0.5 * side_m + reach_m, 0.5 * (top_m - bottom_m), 0.5 * side_m + reach_m),
        }
    }

    pub(super) fn of_cell(cell: IVec2, cell_m: f32, spread: Spread, extent: TreeExtent) -> Self {
        Self::of_plants(cell.as_vec2() * cell_m, cell_m, spread, extent)
    }

    pub(super) fn of_block(block: IVec2, cell_m: f32, spread: Spread, extent: TreeExtent) -> Self {
        let side_m = cell_m * SIDE as f32;
        Self::of_plants(block.as_vec2() * side_m, side_m, spread, extent)
    }

    pub(super) fn top_m(&self) -> f32 {
        self.centre.y + self.half.y
    }

    /// Distance of its nearest point, 0 within.
    pub(super) fn distance(&self, point: Vec3) -> f32 {
        ((point - self.centre).abs() - self.half).max(Vec3::ZERO).length()
    }

    /// The least and the greatest height of its points over a plane (below 0: behind it).
    pub(super) fn heights(&self, plane: Vec4) -> [f32; 2] {
        let middle = plane.xyz().dot(self.centre) + plane.w;
        let spread = plane.xyz().abs().dot(self.half);
        [middle - spread, middle + spread]
    }

    /// The box about it and itself moved along `path`.
    pub(super) fn swept(&self, path: Vec3) -> Self {
        Self { centre: self.centre + 0.5 * path, half: self.half + 0.5 * path.abs() }
    }
}
