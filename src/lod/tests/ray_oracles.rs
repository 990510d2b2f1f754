//! Rasters against single rays, and single rays against a search of all triangles.

use super::{coverage, grown, impostor::place_on_tile, view_of};
use crate::{
    lod::{
        ImpostorAtlas, ImpostorFrame, ImpostorSettings, Scene,
        bake::{
            rasterise::{ParallelRaster, ViewBasis},
            scene::TreeParts,
            texels::Sample,
        },
        impostor::frame::view_basis,
    },
    texture::MASK_CUT_OFF,
    tree::{TreeModel, textures::SpeciesTextures},
};
use bevy::math::{UVec2, Vec2, Vec3};
use obvhs::{
    BvhBuildParams,
    bvh2::{Bvh2, builder::build_bvh2_from_tris},
    ray::{Ray, RayHit},
    triangle::Triangle,
};
use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};
use std::time::Duration;

/// Where a ray hits the tree.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Hit {
    /// Length of the ray up to there, m.
    pub distance_m: f32,
    pub surface: Sample,
}

/// Casts single rays at a scene.
pub(super) struct RayCaster<'a> {
    scene: &'a Scene,
    boxes: Bvh2,
}

impl<'a> RayCaster<'a> {
    pub(super) fn new(scene: &'a Scene) -> Self {
        let solids: Vec<Triangle> = scene
            .edges
            .iter()
            .map(|[a, ab, ac]| [*a, *a + *ab, *a + *ac].map(|corner| corner.to_array().into()))
            .map(|[v0, v1, v2]| Triangle { v0, v1, v2 })
            .collect();
        Self { scene, boxes: build_bvh2_from_tris(&solids, BvhBuildParams::fast_build(), &mut Duration::default()) }
    }

    /// The first thing on a ray's way: from a point, along a unit vector, up to a distance, m.
    pub(super) fn cast(&self, from: Vec3, direction: Vec3, reach_m: f32, parts: TreeParts) -> Option<Hit> {
        let ray = Ray::new(from.to_array().into(), direction.to_array().into(), 0.0, reach_m);
        let mut nearest = RayHit::none();
        self.boxes.ray_traverse(ray, &mut nearest, |ray, slot| {
            let triangle = self.boxes.primitive_indices[slot] as usize;
            match meet(self.scene, triangle, from, direction) {
                Some((distance_m, at))
                    if (0.0..ray.tmax).contains(&distance_m)
                        && self.scene.opacity(triangle, parts).stops(at, direction) =>
                {
                    distance_m
                }
                _ => f32::INFINITY,
            }
        });
        if nearest.t >= reach_m {
            return None;
        }
        let triangle = self.boxes.primitive_indices[nearest.primitive_id as usize] as usize;
        let (distance_m, at) = meet(self.scene, triangle, from, direction)?;
        Some(Hit { distance_m, surface: self.scene.sample(triangle, at, 0.0, parts) })
    }
}

/// Where a ray meets the plane of a triangle inside it: the distance, m, and the shares of its second and third corner
/// (Möller & Trumbore 1997).
fn meet(scene: &Scene, triangle: usize, from: Vec3, direction: Vec3) -> Option<(f32, [f32; 2])> {
    let [a, ab, ac] = scene.edges[triangle];
    let across = direction.cross(ac);
    let volume = ab.dot(across);
    // Bark has no inside.
    if volume == 0.0 || (volume < 0.0 && !scene.is_leaf(triangle)) {
        return None;
    }
    let to = from - a;
    let u = to.dot(across) / volume;
    let along = to.cross(ab);
    let v = direction.dot(along) / volume;
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0).then(|| (ac.dot(along) / volume, [u, v]))
}

/// Tries every triangle of a scene.
fn try_all(scene: &Scene, from: Vec3, direction: Vec3, reach_m: f32, parts: TreeParts) -> Option<Hit> {
    let mut nearest: Option<Hit> = None;
    for triangle in 0..scene.triangles().len() {
        let Some((distance_m, at)) = meet(scene, triangle, from, direction) else { continue };
        let is_nearer = distance_m < nearest.map_or(reach_m, |hit| hit.distance_m);
        if distance_m >= 0.0 && is_nearer && scene.opacity(triangle, parts).stops(at, direction) {
            nearest = Some(Hit { distance_m, surface: scene.sample(triangle, at, 0.0, parts) });
        }
    }
    nearest
}

#[test]
fn a_ray_caster_finds_what_a_search_of_all_finds() {
    for name in ["oak", "birch", "billows"] {
        let (species, model, textures) = grown(name, 0.4);
        let scene = Scene::new(&species, &model, &textures);
        let caster = RayCaster::new(&scene);
        let mut random = Xoshiro256PlusPlus::seed_from_u64(5);
        let (mut hits, height_m) = (0, model.height_m());
        for index in 0..400 {
            let mut around = |size: f32| Vec3::from_array(std::array::from_fn(|_| random.random_range(-size..size)));
            let to = Vec3::Y * (0.6 * height_m) + around(0.3 * height_m);
            let from = to + around(1.0).normalize_or(Vec3::X) * (2.0 * height_m);
            let parts = [TreeParts::All, TreeParts::Crown, TreeParts::Bare][index % 3];
            let direction = (to - from).normalize();
            let (fast, slow) = (
                caster.cast(from, direction, 3.0 * height_m, parts),
                try_all(&scene, from, direction, 3.0 * height_m, parts),
            );
            assert_eq!(fast, slow, "{name}");
            hits += usize::from(fast.is_some());
        }
        assert!(hits > 60, "{name}: {hits}");
    }
}

#[test]
fn a_parallel_raster_equals_single_rays() {
    let (species, model, textures) = grown("birch", 0.5);
    let scene = Scene::new(&species, &model, &textures);
    let caster = RayCaster::new(&scene);
    const RAYS: usize = 64;
    let mut raster = ParallelRaster::new(&scene, [RAYS, RAYS]);
    let (centre, half_m) = (Vec3::Y * (0.5 * model.height_m()), Vec3::splat(0.7 * model.height_m()));
    for (parts, least) in [(TreeParts::All, 300), (TreeParts::Bare, 30)] {
        let (mut unlike, mut hits) = (0, 0);
        for to_eye in [Vec3::Z, Vec3::new(0.6, 0.64, -0.48), Vec3::Y] {
            let basis = ViewBasis::towards(to_eye);
            raster.project(&basis, centre, half_m, parts);
            for (x, y) in (0..RAYS).flat_map(|y| (0..RAYS).map(move |x| (x, y))) {
                let place = 2.0 * (Vec2::new(x as f32, y as f32) + 0.5) / RAYS as f32 - 1.0;
                let from =
                    centre + basis.right * (place.x * half_m.x) - basis.up * (place.y * half_m.y) + to_eye * half_m.z;
                let ray = caster.cast(from, basis.forward, 2.0 * half_m.z, parts);
                let alike = match (raster.sample(x, y), ray) {
                    (Some(seen), Some(hit)) => (seen.depth - hit.distance_m / (2.0 * half_m.z)).abs() < 1e-4,
                    (seen, ray) => seen.is_none() == ray.is_none(),
                };
                unlike += usize::from(!alike);
                hits += usize::from(ray.is_some());
            }
        }
        // Rays along an edge, of a triangle or of a texel, may fall to either side.
        assert!(hits > least && unlike * 100 < hits, "{parts:?}: {unlike} of {hits}");
    }
}

/// Share of a tile's rays that the tree stops, by going through all triangles for each ray, without scene or raster.
fn projected_share(
    model: &TreeModel,
    textures: &SpeciesTextures,
    frame: &ImpostorFrame,
    basis: &ViewBasis,
    rays: usize,
) -> f32 {
    let mut stopped = vec![false; rays * rays];
    let mask = &textures.foliage.mips[3];
    let side = textures.foliage.width as usize >> 3;
    let mut stop = |corners: [Vec3; 3], uvs: Option<[Vec2; 3]>| {
        let [a, b, c] = corners.map(|corner| place_on_tile(frame, basis, corner).truncate() * rays as f32);
        let whole = (b - a).perp_dot(c - a);
        for (index, stopped) in stopped.iter_mut().enumerate() {
            let ray = Vec2::new((index % rays) as f32 + 0.5, (index / rays) as f32 + 0.5);
            let shares = [(c - b).perp_dot(ray - b), (a - c).perp_dot(ray - c), (b - a).perp_dot(ray - a)];
            let shares = shares.map(|share| share / whole);
            if whole != 0.0 && shares.iter().all(|&share| share >= 0.0) {
                let is_there = uvs.is_none_or(|uvs| {
                    let uv: Vec2 = shares.iter().zip(uvs).map(|(&share, uv)| share * uv).sum();
                    let texel = (uv * side as f32).as_uvec2().min(UVec2::splat(side as u32 - 1));
                    f32::from(mask[4 * (texel.y as usize * side + texel.x as usize) + 3]) / 255.0 > MASK_CUT_OFF
                });
                *stopped |= is_there;
            }
        }
    };
    let triples = |indices: &[u32]| -> Vec<[usize; 3]> {
        indices.chunks_exact(3).map(|triple| std::array::from_fn(|corner| triple[corner] as usize)).collect()
    };
    for triple in triples(&model.wood.indices) {
        stop(triple.map(|corner| Vec3::from_array(model.wood.positions[corner])), None);
    }
    for triple in triples(&model.leaves.indices) {
        let uvs = triple.map(|corner| Vec2::from_array(model.leaves.uvs[corner]));
        stop(triple.map(|corner| Vec3::from_array(model.leaves.positions[corner])), Some(uvs));
    }
    stopped.iter().filter(|&&stopped| stopped).count() as f32 / stopped.len() as f32
}

#[test]
fn a_tile_covers_as_much_as_the_tree_does() {
    let (species, model, textures) = grown("oak", 0.12);
    let scene = Scene::new(&species, &model, &textures);
    let atlas = ImpostorAtlas::bake(&[scene], &ImpostorSettings { views_per_side: 4, tile_texels: 32, rays: 1 });
    for view in [UVec2::ZERO, UVec2::new(1, 2), UVec2::new(3, 1)] {
        let basis = view_basis(view, atlas.views_per_side);
        let expected = projected_share(&model, &textures, &atlas.frame, &basis, 64);
        let share = coverage(&view_of(&atlas, 0, view, 0));
        assert!(expected > 0.1 && (share - expected).abs() < 0.01, "{view}: {share} for {expected}");
    }
}
