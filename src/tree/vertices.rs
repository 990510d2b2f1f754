//! Vertices of wood and foliage, as the meshes of a tree are made of them.

use super::skeleton::LeafCluster;
use bevy::math::Vec3;

/// Vertices of the wood, ready for a mesh of triangles, counter-clockwise from outside.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WoodVertices {
    /// Rest positions, local to the tree, m.
    pub positions: Vec<[f32; 3]>,
    /// Unit normals.
    pub normals: Vec<[f32; 3]>,
    /// Bark coordinates: u whole turns around, v along, one unit being [`Bark::tile_m`](super::bark::Bark::tile_m).
    pub uvs: Vec<[f32; 2]>,
    /// Beam index (whole), place on that beam 0..1, brightness of green wood (0 for bark), ambient light 0..1.
    pub sway: Vec<[f32; 4]>,
    /// Triangles.
    pub indices: Vec<u32>,
}

/// Vertices of the leaf cards.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LeafVertices {
    /// Rest positions, local to the tree, m.
    pub positions: Vec<[f32; 3]>,
    /// Unit normals, bent towards the crown's outside.
    pub normals: Vec<[f32; 3]>,
    /// Texture coordinates: the spray runs from (0, 1) to (1, 0).
    pub uvs: Vec<[f32; 2]>,
    /// Beam index (whole), place on that beam 0..1, flutter phase 0..1, ambient light 0..1.
    pub sway: Vec<[f32; 4]>,
    /// Main axis of the spray at rest (unit), and its tint 0..1.
    pub axis: Vec<[f32; 4]>,
    /// Where the spray is attached, m; the fourth is 0.
    pub anchor: Vec<[f32; 4]>,
    /// Triangles.
    pub indices: Vec<u32>,
}

impl LeafVertices {
    pub(super) fn with_capacity(vertices: usize) -> Self {
        Self {
            positions: Vec::with_capacity(vertices),
            normals: Vec::with_capacity(vertices),
            uvs: Vec::with_capacity(vertices),
            sway: Vec::with_capacity(vertices),
            axis: Vec::with_capacity(vertices),
            anchor: Vec::with_capacity(vertices),
            indices: Vec::with_capacity(3 * vertices),
        }
    }

    pub(super) fn push(&mut self, cluster: &LeafCluster, position: Vec3, normal: Vec3, uv: [f32; 2], light: f32) {
        self.positions.push(position.to_array());
        self.normals.push(normal.to_array());
        self.uvs.push(uv);
        self.sway.push([cluster.beam as f32, cluster.at, cluster.phase, light]);
        self.axis.push(cluster.axis.extend(cluster.tint).to_array());
        self.anchor.push(cluster.anchor.extend(0.0).to_array());
    }
}
