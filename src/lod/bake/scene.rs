//! A tree that rays can hit: its triangles, and what is seen where one is hit.
//!
//! Rays see what the swaying material shows of a tree at rest: the texture's colour times the vertices' shade, leaves cut
//! out at the mask's cut-off and lit from both sides by the normal of their vertices, bark from outside only. The sun and
//! the sky are left to the renderer.

use bevy::math::Vec3;
use std::sync::Arc;

use super::{
    texels::Sample,
    texture_lookup::{LinearMip, Opacity, interpolated, interpolated_vector},
};
use crate::{
    dynamics::beam_pose::BeamPose,
    tree::{
        Species, TreeModel,
        species::Wood,
        textures::SpeciesTextures,
        vertices::{LeafVertices, WoodVertices},
    },
};

/// The mip of the foliage that rays see: all have the same coverage, and this one still has the outlines of leaves.
const FOLIAGE_MIP: usize = 3;
/// The mip of the bark: texels of some centimetres.
const BARK_MIP: usize = 4;

/// The parts of a tree that rays can hit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::lod) enum TreeParts {
    /// All of the tree.
    All,
    /// All but the stems: leaves and branches.
    Crown,
    /// Stems, branches, and the twigs of sprays: the tree in winter.
    Bare,
}

/// A tree, ready for rays.
pub struct Scene {
    pub(in crate::lod) vertices: Vec<Vertex>,
    /// For each triangle its first corner, and the ways from there to the second and the third, m.
    pub(in crate::lod) edges: Vec<[Vec3; 3]>,
    surfaces: Arc<Surfaces>,
}

/// What stays as it is when a tree sways.
struct Surfaces {
    /// Of the wood first, then of the leaves.
    triangles: Vec<[u32; 3]>,
    wood_triangles: usize,
    /// For each triangle of the wood, whether it belongs to a stem.
    of_stem: Vec<bool>,
    bark: LinearMip,
    foliage: LinearMip,
    /// The sprays in winter, where they have twigs then.
    bare_foliage: Option<LinearMip>,
    /// Whether leaves grow transparent towards their outline: ellipsoids.
    has_soft_outlines: bool,
    sheds_leaves: bool,
}

impl Surfaces {
    /// What is on the sprays.
    fn foliage_of(&self, parts: TreeParts) -> Option<&LinearMip> {
        match parts {
            TreeParts::All | TreeParts::Crown => Some(&self.foliage),
            TreeParts::Bare => self.bare_foliage.as_ref(),
        }
    }
}

/// A vertex of either mesh.
#[derive(Clone, Copy)]
pub(in crate::lod) struct Vertex {
    pub position: Vec3,
    normal: Vec3,
    uv: [f32; 2],
    shade: [f32; 3],
}

impl Scene {
    /// A model of `species` at rest with its textures.
    #[must_use]
    pub fn new(species: &Species, model: &TreeModel, textures: &SpeciesTextures) -> Self {
        let mut vertices = wood_vertices(&model.wood, &species.wood);
        let first_leaf = vertices.len() as u32;
        vertices.extend(leaf_vertices(&model.leaves));
        let mut triangles: Vec<[u32; 3]> = triples(&model.wood.indices).collect();
        let wood_triangles = triangles.len();
        triangles.extend(triples(&model.leaves.indices).map(|triple| triple.map(|vertex| vertex + first_leaf)));
        let beams = &model.skeleton.beams;
        let is_stem = |vertex: &u32| beams[model.wood.sway[*vertex as usize][0] as usize].order == 0;
        let of_stem = triangles[..wood_triangles].iter().map(|triple| triple.iter().all(is_stem)).collect();
        let surfaces = Surfaces {
            triangles,
            wood_triangles,
            of_stem,
            bark: LinearMip::new(&textures.bark.base_colour, None, BARK_MIP),
            foliage: LinearMip::new(&textures.foliage, textures.foliage_normal.as_ref(), FOLIAGE_MIP),
            bare_foliage: textures.bare_foliage.as_ref().map(|twigs| LinearMip::new(twigs, None, FOLIAGE_MIP)),
            has_soft_outlines: species.has_ellipsoids(),
            sheds_leaves: !species.phenology.evergreen,
        };
        Self::with_vertices(vertices, Arc::new(surfaces))
    }

    fn with_vertices(vertices: Vec<Vertex>, surfaces: Arc<Surfaces>) -> Self {
        let edges = |triple: &[u32; 3]| {
            let [a, b, c] = triple.map(|vertex| vertices[vertex as usize].position);
            [a, b - a, c - a]
        };
        Self { edges: surfaces.triangles.iter().map(edges).collect(), vertices, surfaces }
    }

    /// The same tree with its beams in other poses, one for each beam of the `model` at rest that `self` is of. Leaves
    /// move with their beams.
    pub(in crate::lod) fn posed(&self, model: &TreeModel, poses: &[BeamPose]) -> Self {
        let carried = |(vertex, sway): (&Vertex, &[f32; 4])| {
            let beam = sway[0] as usize;
            let (position, rotation) = poses[beam].carry(&model.beams[beam], sway[1], vertex.position);
            Vertex { position, normal: rotation * vertex.normal, ..*vertex }
        };
        let bound_to = model.wood.sway.iter().chain(&model.leaves.sway);
        Self::with_vertices(self.vertices.iter().zip(bound_to).map(carried).collect(), Arc::clone(&self.surfaces))
    }

    pub(in crate::lod) fn triangles(&self) -> &[[u32; 3]] {
        &self.surfaces.triangles
    }

    /// Whether the tree is bare in winter.
    pub(in crate::lod) fn sheds_leaves(&self) -> bool {
        self.surfaces.sheds_leaves
    }

    /// How many triangles may be hit: those of the wood come first.
    pub(in crate::lod) fn triangles_in(&self, parts: TreeParts) -> usize {
        let has_no_sprays = parts == TreeParts::Bare && self.surfaces.bare_foliage.is_none();
        if has_no_sprays { self.surfaces.wood_triangles } else { self.surfaces.triangles.len() }
    }

    pub(in crate::lod) fn is_leaf(&self, triangle: usize) -> bool {
        triangle >= self.surfaces.wood_triangles
    }

    /// Whether a triangle stops rays, or lets them through a gap between leaves.
    pub(in crate::lod) fn opacity(&self, triangle: usize, parts: TreeParts) -> Opacity<'_> {
        if !self.is_leaf(triangle) {
            let is_hidden = parts == TreeParts::Crown && self.surfaces.of_stem[triangle];
            return if is_hidden { Opacity::Clear } else { Opacity::Opaque };
        }
        let corners = self.corners(triangle);
        let uvs = corners.map(|corner| corner.uv);
        let normals = self.surfaces.has_soft_outlines.then(|| corners.map(|corner| corner.normal));
        match self.surfaces.foliage_of(parts) {
            Some(mask) => Opacity::Masked { mask, uvs, normals },
            None => Opacity::Clear,
        }
    }

    /// What a ray sees of a triangle at a place: the shares of its second and third corner.
    pub(in crate::lod) fn sample(&self, triangle: usize, at: [f32; 2], depth: f32, parts: TreeParts) -> Sample {
        let corners = self.corners(triangle);
        let uv = interpolated(corners.map(|corner| corner.uv), at);
        let is_leaf = self.is_leaf(triangle);
        let foliage = self.surfaces.foliage_of(parts).filter(|_| is_leaf);
        let texture = foliage.unwrap_or(&self.surfaces.bark);
        let texel = if is_leaf { texture.clamped(uv) } else { texture.repeated(uv) };
        let shade = interpolated(corners.map(|corner| corner.shade), at);
        Sample {
            colour: std::array::from_fn(|channel| (texture.colour[texel][channel] * shade[channel]).min(1.0)),
            normal: interpolated_vector(corners.map(|corner| corner.normal), at).try_normalize().unwrap_or(Vec3::Y),
            translucency: if is_leaf && parts != TreeParts::Bare { texture.translucency[texel] } else { 0.0 },
            depth,
        }
    }

    /// Mean colour of the stems, linear.
    pub(in crate::lod) fn stem_colour(&self) -> [f32; 3] {
        let mut sum = [0.0; 3];
        let mut count = 0.0_f32;
        for (triple, _) in self.triangles().iter().zip(&self.surfaces.of_stem).filter(|(_, of_stem)| **of_stem) {
            let shade = self.vertices[triple[0] as usize].shade;
            (0..3).for_each(|channel| sum[channel] += shade[channel]);
            count += 1.0;
        }
        let bark = self.surfaces.bark.mean();
        std::array::from_fn(|channel| bark[channel] * sum[channel] / count.max(1.0))
    }

    fn corners(&self, triangle: usize) -> [&Vertex; 3] {
        self.surfaces.triangles[triangle].map(|vertex| &self.vertices[vertex as usize])
    }
}

fn triples(indices: &[u32]) -> impl Iterator<Item = [u32; 3]> {
    indices.chunks_exact(3).map(|triple| [triple[0], triple[1], triple[2]])
}

/// Shaded as the renderer's shader shades wood.
fn wood_vertices(wood: &WoodVertices, kind: &Wood) -> Vec<Vertex> {
    let tint = kind.green.tint(kind.bark.colour);
    let shade = |[_, _, green, light]: [f32; 4]| {
        let of_green = |tint| if green > 0.0 { tint * green } else { 1.0 };
        tint.map(|channel| (0.5 + 0.5 * light) * of_green(channel))
    };
    let vertex = |index: usize| Vertex {
        position: Vec3::from_array(wood.positions[index]),
        normal: Vec3::from_array(wood.normals[index]),
        uv: wood.uvs[index],
        shade: shade(wood.sway[index]),
    };
    (0..wood.positions.len()).map(vertex).collect()
}

/// Shaded as the renderer's shader shades leaves of a tree whose own tint is the middle one.
fn leaf_vertices(leaves: &LeafVertices) -> impl Iterator<Item = Vertex> {
    (0..leaves.positions.len()).map(|index| {
        let tint = leaves.axis[index][3];
        let light = (0.25 + 0.75 * leaves.sway[index][3]).sqrt() * (0.85 + 0.35 * tint);
        Vertex {
            position: Vec3::from_array(leaves.positions[index]),
            normal: Vec3::from_array(leaves.normals[index]),
            uv: leaves.uvs[index],
            shade: [0.92 + 0.2 * tint, 1.0, 1.05 - 0.25 * tint].map(|channel| light * channel),
        }
    })
}
