//! What the views of an impostor show: the upright cylinder around a tree, and the rectangle that a view sees of it.
//!
//! A view is a parallel projection of the cylinder: `radius_m` to each side, and `half_height_m cos e + radius_m sin e` up
//! and down where the eye stands at the elevation `e`. Slender trees so fill their tiles as well as round ones do.

use bevy::math::{UVec2, Vec3};

use super::octahedral::view_direction;
use crate::lod::bake::{rasterise::ViewBasis, scene::Scene};

/// Tiles are at most so many times as long as they are wide.
const GREATEST_ASPECT: f32 = 4.0;
/// How many texels are left free around the tree in a tile.
const MARGIN_TEXELS: f32 = 1.0;

/// The upright cylinder that views are of: around all trees of an atlas, if they stood in one place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImpostorFrame {
    /// Its middle, tree-local, m.
    pub centre: Vec3,
    /// Its radius, m.
    pub radius_m: f32,
    /// Half its height, m.
    pub half_height_m: f32,
}

impl ImpostorFrame {
    /// Around all vertices of trees.
    pub(super) fn around(scenes: &[Scene]) -> Self {
        let points = || scenes.iter().flat_map(|scene| &scene.vertices).map(|vertex| vertex.position);
        let (min, max) =
            points().fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(min, max), point| (min.min(point), max.max(point)));
        if min.cmpgt(max).any() {
            return Self { centre: Vec3::ZERO, radius_m: 0.01, half_height_m: 0.01 };
        }
        let centre = 0.5 * (min + max);
        let radius_m = points().map(|point| (point.x - centre.x).hypot(point.z - centre.z)).fold(0.01, f32::max);
        Self { centre, radius_m, half_height_m: (0.5 * (max.y - min.y)).max(0.01) }
    }

    /// The size of a tile, texels: powers of two, the longer side given, and about as slender as the tree.
    pub(super) fn tile_texels(self, longer: u32) -> UVec2 {
        let aspect = (self.half_height_m / self.radius_m).clamp(1.0 / GREATEST_ASPECT, GREATEST_ASPECT);
        let halvings = aspect.log2().round() as i32;
        UVec2::new(longer >> halvings.max(0), longer >> (-halvings).max(0))
    }

    /// The same, with room for a rim that is free of the tree on tiles of a size, texels.
    pub(super) fn with_margin(self, tile_texels: UVec2) -> Self {
        let wider = |texels: u32| texels as f32 / (texels as f32 - 2.0 * MARGIN_TEXELS);
        // From above, the radius is what is seen in both directions.
        Self {
            radius_m: self.radius_m * wider(tile_texels.min_element()),
            half_height_m: self.half_height_m * wider(tile_texels.y),
            ..self
        }
    }

    /// Half the width, height and depth of a view, m.
    pub(in crate::lod) fn half_m(&self, basis: &ViewBasis) -> Vec3 {
        let sin = basis.forward.y.abs();
        let cos = basis.up.y.abs();
        Vec3::new(
            self.radius_m,
            self.half_height_m * cos + self.radius_m * sin,
            self.half_height_m * sin + self.radius_m * cos,
        )
    }
}

/// The axes of a view by its column and row in the grid of directions.
pub(in crate::lod) fn view_basis(view: UVec2, views_per_side: u32) -> ViewBasis {
    ViewBasis::towards(view_direction(view.as_vec2() / (views_per_side - 1) as f32))
}
