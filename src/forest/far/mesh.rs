//! The mesh of a block: four corners a tree, which the vertex shader spreads to a card.

use bevy::{
    asset::RenderAssetUsages,
    camera::primitives::Aabb,
    mesh::{Indices, MeshVertexAttribute, PrimitiveTopology, VertexFormat},
    prelude::*,
};
use std::f32::consts::TAU;

/// Corner, turn, size, tint and looks of a tree: `code` of the shader, see [`FarTree::code`].
pub(super) const ATTRIBUTE_FAR: MeshVertexAttribute =
    MeshVertexAttribute::new("FarTree", 0x4641_5254, VertexFormat::Uint32);

/// Most trees of a species that there can be views of.
pub(super) const MOST_TREES: u32 = 4;

/// The greatest size that fits into a code.
pub(super) const GREATEST_SIZE: f32 = 4.0;

/// A tree of a block.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct FarTree {
    /// Where its stem leaves the ground, from the block's corner, m.
    pub foot: Vec3,
    /// Turn about the vertical, rad.
    pub turn_rad: f32,
    /// Its size, relative to the tree that the views are of.
    pub size: f32,
    /// A shade of its own, -1 to 1.
    pub tint: f32,
    /// Whose views it wears, below [`MOST_TREES`].
    pub tree: u32,
}

impl FarTree {
    /// Lowest bits first: corner 2, turn 8, size 12, tint 8, tree 2.
    fn code(&self, corner: u32) -> u32 {
        let turn = (self.turn_rad.rem_euclid(TAU) / TAU * 256.0) as u32 & 255;
        let size = (self.size.clamp(0.0, GREATEST_SIZE) / GREATEST_SIZE * 4095.0).round() as u32;
        let tint = ((0.5 + 0.5 * self.tint.clamp(-1.0, 1.0)) * 255.0).round() as u32;
        corner | turn << 2 | size << 10 | tint << 22 | (self.tree % MOST_TREES) << 30
    }
}

/// The mesh of a block's trees, and the box around them; `reach_m` is how far a tree of size 1 may reach from its foot.
pub(super) fn block_mesh(trees: &[FarTree], reach_m: f32) -> (Mesh, Aabb) {
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
        .with_inserted_attribute(ATTRIBUTE_FAR, codes)
        .with_inserted_indices(indices);
    (mesh, Aabb::from_min_max(min, max))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_code_holds_turn_size_tint_and_tree() {
        let tree = FarTree { foot: Vec3::ZERO, turn_rad: 0.75 * TAU, size: 1.5, tint: -1.0, tree: 3 };
        let code = tree.code(2);
        assert_eq!((code & 3, code >> 2 & 255, code >> 22 & 255, code >> 30), (2, 192, 0, 3));
        let size = (code >> 10 & 4095) as f32 / 4095.0 * GREATEST_SIZE;
        assert!((size - 1.5).abs() < 1e-3);
        let odd = FarTree { turn_rad: -0.001, size: 99.0, tint: 7.0, ..tree }.code(3);
        assert_eq!((odd & 3, odd >> 10 & 4095, odd >> 22 & 255), (3, 4095, 255));
    }

    #[test]
    fn the_box_holds_every_tree_and_a_tree_costs_76_bytes() {
        let tree = |x| FarTree { foot: Vec3::new(x, 5.0, 1.0), turn_rad: 0.0, size: 0.5, tint: 0.0, tree: 0 };
        let trees: Vec<FarTree> = (0..100_u8).map(|x| tree(f32::from(x))).collect();
        let (mesh, bounds) = block_mesh(&trees, 20.0);
        assert_eq!((bounds.min().x, bounds.max().x), (-10.0, 109.0));
        assert_eq!(mesh.count_vertices(), 400);
        let bytes = mesh.get_vertex_buffer_size() + mesh.get_index_buffer_bytes().map_or(0, <[u8]>::len);
        assert_eq!(bytes, 76 * trees.len());
    }

    #[test]
    fn a_block_without_trees_is_no_trouble() {
        let (mesh, _) = block_mesh(&[], 20.0);
        assert_eq!(mesh.count_vertices(), 0);
    }
}
