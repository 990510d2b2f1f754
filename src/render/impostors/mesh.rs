//! The mesh of many impostors: four corners a tree, which the vertex shader spreads to a quad that faces the view.

use bevy::{
    asset::RenderAssetUsages,
    camera::primitives::Aabb,
    mesh::{Indices, MeshVertexAttribute, PrimitiveTopology, VertexFormat},
    prelude::*,
};
use std::f32::consts::TAU;

/// Corner, turn, size, tint and variant of a tree: `code` of the shader, see [`ImpostorInstance::code`].
pub(crate) const ATTRIBUTE_IMPOSTOR: MeshVertexAttribute =
    MeshVertexAttribute::new("Impostor", 0x4641_5254, VertexFormat::Uint32);

/// Variants of a species that an atlas can show.
pub(crate) const MAX_VARIANTS: u32 = 4;

/// The greatest size that fits into a code.
pub(crate) const MAX_SIZE: u32 = 4;

/// A far tree.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ImpostorInstance {
    /// Where its stem leaves the ground, from the mesh's origin, m.
    pub foot: Vec3,
    /// Turn about the vertical, rad.
    pub turn_rad: f32,
    /// Its size, relative to the tree that the atlas shows.
    pub size: f32,
    /// A shade of its own, -1 to 1.
    pub tint: f32,
    /// The variant that the atlas shows, below [`MAX_VARIANTS`].
    pub variant: u32,
}

impl ImpostorInstance {
    /// Lowest bits first: corner 2, turn 8, size 12, tint 8, variant 2.
    fn code(&self, corner: u32) -> u32 {
        let turn = (self.turn_rad.rem_euclid(TAU) / TAU * 256.0) as u32 & 255;
        let size = (self.size.clamp(0.0, MAX_SIZE as f32) / MAX_SIZE as f32 * 4095.0).round() as u32;
        let tint = ((0.5 + 0.5 * self.tint.clamp(-1.0, 1.0)) * 255.0).round() as u32;
        corner | turn << 2 | size << 10 | tint << 22 | (self.variant % MAX_VARIANTS) << 30
    }
}

/// The mesh of far trees, and the box around them; `reach_m` is how far a tree of size 1 may reach from its foot.
pub(crate) fn impostor_mesh(trees: &[ImpostorInstance], reach_m: f32) -> (Mesh, Aabb) {
    let feet = trees.iter().flat_map(|tree| [tree.foot.to_array(); 4]).collect::<Vec<_>>();
    let codes = trees.iter().flat_map(|tree| [0, 1, 2, 3].map(|corner| tree.code(corner))).collect::<Vec<_>>();
    let corners = |tree: u32| [0, 1, 2, 2, 1, 3].map(|corner| 4 * tree + corner);
    let indices = (0..trees.len() as u32).flat_map(corners);
    let indices = if feet.len() <= usize::from(u16::MAX) {
        Indices::U16(indices.map(|index| index as u16).collect())
    } else {
        Indices::U32(indices.collect())
    };
    let around = trees.iter().fold(None, |around: Option<(Vec3, Vec3)>, tree| {
        let reach = Vec3::splat(reach_m * tree.size);
        let (min, max) = (tree.foot - reach, tree.foot + reach);
        Some(around.map_or((min, max), |(low, high)| (low.min(min), high.max(max))))
    });
    let (min, max) = around.unwrap_or_default();
    let mesh = Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::RENDER_WORLD)
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, feet)
        .with_inserted_attribute(ATTRIBUTE_IMPOSTOR, codes)
        .with_inserted_indices(indices);
    (mesh, Aabb::from_min_max(min, max))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_hold_turn_size_tint_and_variant() {
        let tree = ImpostorInstance { foot: Vec3::ZERO, turn_rad: 0.75 * TAU, size: 1.5, tint: -1.0, variant: 3 };
        let code = tree.code(2);
        assert_eq!((code & 3, code >> 2 & 255, code >> 22 & 255, code >> 30), (2, 192, 0, 3));
        let size = (code >> 10 & 4095) as f32 / 4095.0 * MAX_SIZE as f32;
        assert!((size - 1.5).abs() < 1e-3);
        let odd = ImpostorInstance { turn_rad: -0.001, size: 99.0, tint: 7.0, ..tree }.code(3);
        assert_eq!((odd & 3, odd >> 10 & 4095, odd >> 22 & 255), (3, 4095, 255));
    }

    #[test]
    fn bounds_hold_every_tree_and_a_tree_has_76_bytes() {
        let tree =
            |x| ImpostorInstance { foot: Vec3::new(x, 5.0, 1.0), turn_rad: 0.0, size: 0.5, tint: 0.0, variant: 0 };
        let trees: Vec<ImpostorInstance> = (0..100_u8).map(|x| tree(f32::from(x))).collect();
        let (mesh, bounds) = impostor_mesh(&trees, 20.0);
        assert_eq!((bounds.min().x, bounds.max().x), (-10.0, 109.0));
        assert_eq!(mesh.count_vertices(), 400);
        let bytes = mesh.get_vertex_buffer_size() + mesh.get_index_buffer_bytes().map_or(0, <[u8]>::len);
        assert_eq!(bytes, 76 * trees.len());
    }

    #[test]
    fn a_mesh_without_trees_is_empty() {
        let (mesh, _) = impostor_mesh(&[], 20.0);
        assert_eq!(mesh.count_vertices(), 0);
    }
}
