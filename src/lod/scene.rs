//! A tree that rays can hit: its triangles in a hierarchy of boxes, and what is seen where one is hit.
//!
//! Rays see what the swaying material shows of a tree at rest (`tree_vertex.wesl`, `tree_fragment.wesl`): the texture's colour times the
//! vertices' shade, leaves cut out at the mask's cut-off and lit from both sides by the normal of their vertices, bark
//! from outside only. The sun and the sky are left to the renderer.

use bevy::math::Vec3;
use obvhs::{
    BvhBuildParams,
    bvh2::{Bvh2, builder::build_bvh2_from_tris},
    ray::{Ray, RayHit},
    triangle::Triangle,
};
use std::{
    sync::{Arc, OnceLock},
    time::Duration,
};

use super::{
    film::Sample,
    paint::{Gate, Paint, blend, mixed},
};
use crate::{
    dynamics::pose::BeamPose,
    tree::{
        Species, TreeModel, growth::Growth, leaf_mesh::LeafVertices, mesh::WoodVertices, painting::SpeciesTextures,
    },
};

/// The mip of the foliage that is seen from afar: the coarsest that the renderer uses (`FOLIAGE_LOD_LIMIT` of
/// `sway/painted.rs`).
const FOLIAGE_MIP: usize = 3;
/// The mip of the bark: texels of some centimetres.
const BARK_MIP: usize = 4;

/// What a ray may see.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sight {
    /// All of the tree.
    Tree,
    /// All but the stems: leaves and branches.
    Crown,
    /// Stems and branches: the tree in winter.
    Wood,
}

/// Where a ray hits the tree.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Length of the ray up to there, m.
    pub distance_m: f32,
    /// Light that is scattered there of white light, linear, with the shade of the crown.
    pub colour: [f32; 3],
    /// Unit normal of the surface, tree-local: leaves face as their vertices do, whichever side is hit.
    pub normal: Vec3,
    /// Share of the species' translucency, 0 to 1; 0 for wood.
    pub translucency: f32,
    /// Whether it is a leaf.
    pub is_leaf: bool,
}

/// A tree, ready for rays.
pub struct Scene {
    pub(super) corners: Vec<Corner>,
    /// For each triangle its first corner, and the ways from there to the second and the third, m.
    pub(super) facets: Vec<[Vec3; 3]>,
    fabric: Arc<Fabric>,
    /// Sorted for the first single ray: whole projections need none.
    boxes: OnceLock<Bvh2>,
}

/// What stays as it is when a tree sways.
struct Fabric {
    /// Of the wood first, then of the leaves.
    triangles: Vec<[u32; 3]>,
    wood_triangles: usize,
    /// For each triangle of the wood, whether it belongs to a stem.
    of_stem: Vec<bool>,
    bark: Paint,
    foliage: Paint,
    /// Whether leaves grow transparent towards their outline: Gardner's ellipsoids.
    is_billow: bool,
    sheds_leaves: bool,
}

/// A vertex of either mesh.
#[derive(Clone, Copy)]
pub(super) struct Corner {
    pub position: Vec3,
    normal: Vec3,
    uv: [f32; 2],
    shade: [f32; 3],
}

impl Scene {
    /// A model of `species` at rest that wears `textures`.
    #[must_use]
    pub fn new(species: &Species, model: &TreeModel, textures: &SpeciesTextures) -> Self {
        let mut corners = wood_corners(&model.wood);
        let first_leaf = corners.len() as u32;
        corners.extend(leaf_corners(&model.leaves));
        let mut triangles: Vec<[u32; 3]> = triples(&model.wood.indices).collect();
        let wood_triangles = triangles.len();
        triangles.extend(triples(&model.leaves.indices).map(|triple| triple.map(|corner| corner + first_leaf)));
        let beams = &model.skeleton.beams;
        let is_stem = |corner: &u32| beams[model.wood.sway[*corner as usize][0] as usize].order == 0;
        let of_stem = triangles[..wood_triangles].iter().map(|triple| triple.iter().all(is_stem)).collect();
        let fabric = Fabric {
            triangles,
            wood_triangles,
            of_stem,
            bark: Paint::new(&textures.bark.base_colour, None, BARK_MIP),
            foliage: Paint::new(&textures.foliage, textures.foliage_normal.as_ref(), FOLIAGE_MIP),
            is_billow: matches!(species.growth, Growth::Gardner(_)),
            sheds_leaves: !species.phenology.evergreen,
        };
        Self::of_corners(corners, Arc::new(fabric))
    }

    fn of_corners(corners: Vec<Corner>, fabric: Arc<Fabric>) -> Self {
        let facet = |triple: &[u32; 3]| {
            let [a, b, c] = triple.map(|corner| corners[corner as usize].position);
            [a, b - a, c - a]
        };
        Self { facets: fabric.triangles.iter().map(facet).collect(), corners, fabric, boxes: OnceLock::new() }
    }

    /// The same tree with its beams in other poses, one for each beam of the `model` at rest that `self` is of. Leaves
    /// ride on their beams.
    pub(super) fn posed(&self, model: &TreeModel, poses: &[BeamPose]) -> Self {
        let carried = |(corner, sway): (&Corner, &[f32; 4])| {
            let beam = sway[0] as usize;
            let (position, rotation) = poses[beam].carry(&model.beams[beam], sway[1], corner.position);
            Corner { position, normal: rotation * corner.normal, ..*corner }
        };
        let bound_to = model.wood.sway.iter().chain(&model.leaves.sway);
        Self::of_corners(self.corners.iter().zip(bound_to).map(carried).collect(), Arc::clone(&self.fabric))
    }

    /// The first thing on a ray's way: from a point, along a unit vector, up to a distance, m.
    #[must_use]
    pub fn cast(&self, from: Vec3, direction: Vec3, reach_m: f32, sight: Sight) -> Option<Hit> {
        let ray = Ray::new(from.to_array().into(), direction.to_array().into(), 0.0, reach_m);
        let mut nearest = RayHit::none();
        let boxes = self.boxes.get_or_init(|| boxes(&self.facets));
        boxes.ray_traverse(ray, &mut nearest, |ray, slot| {
            let triangle = boxes.primitive_indices[slot] as usize;
            match self.meet(triangle, from, direction) {
                Some((distance_m, at))
                    if (0.0..ray.tmax).contains(&distance_m) && self.stops(triangle, at, direction, sight) =>
                {
                    distance_m
                }
                _ => f32::INFINITY,
            }
        });
        if nearest.t >= reach_m {
            return None;
        }
        let triangle = boxes.primitive_indices[nearest.primitive_id as usize] as usize;
        self.meet(triangle, from, direction).map(|(distance_m, at)| self.hit(triangle, at, distance_m))
    }

    pub(super) fn triangles(&self) -> &[[u32; 3]] {
        &self.fabric.triangles
    }

    /// Whether the tree is bare in winter.
    pub(super) fn sheds_leaves(&self) -> bool {
        self.fabric.sheds_leaves
    }

    /// How many triangles there are to see: those of the wood come first.
    pub(super) fn triangles_in(&self, sight: Sight) -> usize {
        if sight == Sight::Wood { self.fabric.wood_triangles } else { self.fabric.triangles.len() }
    }

    pub(super) fn is_leaf(&self, triangle: usize) -> bool {
        triangle >= self.fabric.wood_triangles
    }

    /// Where a ray meets the plane of a triangle inside it: the distance, m, and the shares of its second and third
    /// corner (Möller & Trumbore 1997).
    pub(super) fn meet(&self, triangle: usize, from: Vec3, direction: Vec3) -> Option<(f32, [f32; 2])> {
        let [a, ab, ac] = self.facets[triangle];
        let across = direction.cross(ac);
        let volume = ab.dot(across);
        // Bark has no inside.
        if volume == 0.0 || (volume < 0.0 && !self.is_leaf(triangle)) {
            return None;
        }
        let to = from - a;
        let u = to.dot(across) / volume;
        let along = to.cross(ab);
        let v = direction.dot(along) / volume;
        (u >= 0.0 && v >= 0.0 && u + v <= 1.0).then(|| (ac.dot(along) / volume, [u, v]))
    }

    /// What decides whether a triangle stops rays, or lets them through a gap between leaves.
    pub(super) fn gate(&self, triangle: usize, sight: Sight) -> Gate<'_> {
        if !self.is_leaf(triangle) {
            return if sight == Sight::Crown && self.fabric.of_stem[triangle] { Gate::Open } else { Gate::Shut };
        }
        if sight == Sight::Wood {
            return Gate::Open;
        }
        let corners = self.corners_of(triangle);
        let uvs = corners.map(|corner| corner.uv);
        let normals = self.fabric.is_billow.then(|| corners.map(|corner| corner.normal));
        Gate::Leaf { mask: &self.fabric.foliage, uvs, normals }
    }

    pub(super) fn stops(&self, triangle: usize, at: [f32; 2], direction: Vec3, sight: Sight) -> bool {
        self.gate(triangle, sight).stops(at, direction)
    }

    /// What is seen of a triangle at a place.
    pub(super) fn hit(&self, triangle: usize, at: [f32; 2], distance_m: f32) -> Hit {
        let corners = self.corners_of(triangle);
        let uv = blend(corners.map(|corner| corner.uv), at);
        let is_leaf = self.is_leaf(triangle);
        let paint = if is_leaf { &self.fabric.foliage } else { &self.fabric.bark };
        let texel = if is_leaf { paint.clamped(uv) } else { paint.repeated(uv) };
        let shade = blend(corners.map(|corner| corner.shade), at);
        Hit {
            distance_m,
            colour: std::array::from_fn(|channel| (paint.colour[texel][channel] * shade[channel]).min(1.0)),
            normal: mixed(corners.map(|corner| corner.normal), at).try_normalize().unwrap_or(Vec3::Y),
            translucency: if is_leaf { paint.translucency[texel] } else { 0.0 },
            is_leaf,
        }
    }

    /// Mean colour of the stems, linear.
    pub(super) fn stem_colour(&self) -> [f32; 3] {
        let mut sum = [0.0; 3];
        let mut count = 0.0_f32;
        for (triple, _) in self.triangles().iter().zip(&self.fabric.of_stem).filter(|(_, of_stem)| **of_stem) {
            let shade = self.corners[triple[0] as usize].shade;
            (0..3).for_each(|channel| sum[channel] += shade[channel]);
            count += 1.0;
        }
        let bark = self.fabric.bark.mean();
        std::array::from_fn(|channel| bark[channel] * sum[channel] / count.max(1.0))
    }

    fn corners_of(&self, triangle: usize) -> [&Corner; 3] {
        self.fabric.triangles[triangle].map(|corner| &self.corners[corner as usize])
    }
}

impl Hit {
    /// As a film records it, `depth` being 0 to 1.
    pub(super) fn sample(&self, depth: f32) -> Sample {
        Sample { colour: self.colour, normal: self.normal, translucency: self.translucency, depth }
    }
}

/// The fastest build that is not lazy: a tree is cast at for a few milliseconds only.
fn boxes(facets: &[[Vec3; 3]]) -> Bvh2 {
    let solids: Vec<Triangle> = facets
        .iter()
        .map(|[a, ab, ac]| [*a, *a + *ab, *a + *ac].map(|corner| corner.to_array().into()))
        .map(|[v0, v1, v2]| Triangle { v0, v1, v2 })
        .collect();
    build_bvh2_from_tris(&solids, BvhBuildParams::fast_build(), &mut Duration::default())
}

fn triples(indices: &[u32]) -> impl Iterator<Item = [u32; 3]> {
    indices.chunks_exact(3).map(|triple| [triple[0], triple[1], triple[2]])
}

/// `shade` of `tree_vertex.wesl`, for wood.
fn wood_corners(wood: &WoodVertices) -> Vec<Corner> {
    let corner = |index: usize| Corner {
        position: Vec3::from_array(wood.positions[index]),
        normal: Vec3::from_array(wood.normals[index]),
        uv: wood.uvs[index],
        shade: [0.5 + 0.5 * wood.sway[index][3]; 3],
    };
    (0..wood.positions.len()).map(corner).collect()
}

/// `shade` of `tree_vertex.wesl`, for leaves of a tree whose own tint is the middle one.
fn leaf_corners(leaves: &LeafVertices) -> impl Iterator<Item = Corner> {
    (0..leaves.positions.len()).map(|index| {
        let tint = leaves.axis[index][3];
        let light = (0.25 + 0.75 * leaves.sway[index][3]) * (0.85 + 0.35 * tint);
        Corner {
            position: Vec3::from_array(leaves.positions[index]),
            normal: Vec3::from_array(leaves.normals[index]),
            uv: leaves.uvs[index],
            shade: [0.92 + 0.2 * tint, 1.0, 1.05 - 0.25 * tint].map(|channel| light * channel),
        }
    })
}
