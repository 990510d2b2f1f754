//! Vertices as files have them: colours baked in, tangents, and the place on a beam that each is bound to.

use super::leaf_look::{LeafLook, LeafState};
use crate::{
    dynamics::BeamDynamics,
    tree::{
        species::Wood,
        vertices::{LeafVertices, WoodVertices},
    },
};
use bevy::math::Vec3;

/// Any direction that few beams have.
const ASIDE: Vec3 = Vec3::new(0.36, 0.48, 0.8);

/// A place on a beam: its index, and 0 at its root to 1 at its tip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct BeamPlace {
    pub beam: u32,
    pub at: f32,
}

/// What a surface is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Part {
    Wood,
    Leaves,
    /// Sprays without leaves.
    BareSprays,
}

impl Part {
    /// What its material is called.
    pub fn name(self) -> &'static str {
        match self {
            Self::Wood => "bark",
            Self::Leaves => "leaves",
            Self::BareSprays => "twigs",
        }
    }
}

/// Triangles of one material.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Surface {
    /// Tree-local, m, y up.
    pub positions: Vec<[f32; 3]>,
    /// Unit normals.
    pub normals: Vec<[f32; 3]>,
    /// Unit tangents along u, and the hand of the third axis, which is 1.
    pub tangents: Vec<[f32; 4]>,
    /// From the upper left corner of the texture.
    pub uvs: Vec<[f32; 2]>,
    /// Linear, 0 to 255; the fourth is 255.
    pub colours: Vec<[u8; 4]>,
    pub places: Vec<BeamPlace>,
    /// Counter-clockwise from outside.
    pub indices: Vec<u32>,
}

/// How bark is shaded: all trees of a file that share a texture share it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct WoodLook {
    green: Vec3,
    /// Factor of the texture, 1 or more, which the colours of vertices leave room for.
    pub gain: f32,
}

impl WoodLook {
    pub fn new(wood: &Wood, meshes: &[&WoodVertices]) -> Self {
        let mut look = Self { green: Vec3::from_array(wood.green.tint(wood.bark.colour)), gain: 1.0 };
        let factors = meshes.iter().flat_map(|mesh| &mesh.sway).map(|sway| look.factor(sway).max_element());
        look.gain = factors.fold(1.0, f32::max);
        look
    }

    /// As the renderer's shader shades wood: light in the crown, and green branches.
    fn factor(&self, sway: &[f32; 4]) -> Vec3 {
        let green = if sway[2] > 0.0 { self.green * sway[2] } else { Vec3::ONE };
        (0.5 + 0.5 * sway[3]) * green
    }
}

impl Surface {
    /// Trunk and branches.
    pub fn of_wood(wood: &WoodVertices, beams: &[BeamDynamics], look: &WoodLook) -> Self {
        let mut surface = Self { indices: wood.indices.clone(), ..Self::default() };
        for index in 0..wood.positions.len() {
            let place = place(&wood.sway[index]);
            let normal = unit(wood.normals[index]);
            let along = beams.get(place.beam as usize).map_or(Vec3::Y, |beam| beam.direction);
            // Bark is wound around its beam: u runs around, v along.
            let around =
                along.cross(normal).try_normalize().unwrap_or_else(|| normal.cross(ASIDE).normalize_or(Vec3::X));
            surface.push(
                wood.positions[index],
                normal,
                around,
                wood.uvs[index],
                look.factor(&wood.sway[index]) / look.gain,
            );
            surface.places.push(place);
        }
        surface
    }

    /// The leaves, and the sprays that are bare.
    pub fn of_leaves(leaves: &LeafVertices, look: &LeafLook) -> [Self; 2] {
        let mut surfaces = [Self::default(), Self::default()];
        // Where a vertex is in its surface.
        let mut places = vec![u32::MAX; leaves.positions.len()];
        for corners in leaves.indices.chunks_exact(3) {
            let first = corners[0] as usize;
            let (kind, size) = match look.state(&leaves.sway[first], &leaves.axis[first]) {
                LeafState::InLeaf => (0, 1.0),
                LeafState::Bare => (1, 1.0),
                LeafState::Shrunk(size) => (0, size),
                LeafState::Gone => continue,
            };
            let surface = &mut surfaces[kind];
            for &corner in corners {
                let vertex = corner as usize;
                if places[vertex] == u32::MAX {
                    places[vertex] = surface.positions.len() as u32;
                    surface.push_leaf(leaves, vertex, size, look);
                }
                surface.indices.push(places[vertex]);
            }
        }
        surfaces
    }

    fn push_leaf(&mut self, leaves: &LeafVertices, vertex: usize, size: f32, look: &LeafLook) {
        let (sway, axis) = (&leaves.sway[vertex], &leaves.axis[vertex]);
        let anchor = Vec3::from_slice(&leaves.anchor[vertex]);
        let position = match size {
            1.0 => leaves.positions[vertex],
            _ => anchor.lerp(Vec3::from_array(leaves.positions[vertex]), size).to_array(),
        };
        let normal = unit(leaves.normals[vertex]);
        // The twig runs along the diagonal of its texture, so u is halfway between the twig and its side.
        let along = Vec3::from_slice(axis);
        let diagonal = along + (along.cross(normal) + 1e-6 * ASIDE).normalize_or(Vec3::X);
        let across = normal.any_orthonormal_vector();
        let tangent = (diagonal - normal * diagonal.dot(normal)).try_normalize().unwrap_or(across);
        self.push(position, normal, tangent, leaves.uvs[vertex], look.colour(sway, axis));
        self.places.push(place(sway));
    }

    fn push(&mut self, position: [f32; 3], normal: Vec3, tangent: Vec3, uv: [f32; 2], colour: Vec3) {
        self.positions.push(position);
        self.normals.push(normal.to_array());
        self.tangents.push(tangent.extend(1.0).to_array());
        self.uvs.push(uv);
        let [red, green, blue] = colour.to_array().map(crate::texture::byte);
        self.colours.push([red, green, blue, 255]);
    }
}

fn place(sway: &[f32; 4]) -> BeamPlace {
    BeamPlace { beam: sway[0] as u32, at: sway[1] }
}

fn unit(normal: [f32; 3]) -> Vec3 {
    Vec3::from_array(normal).normalize_or(Vec3::Y)
}
