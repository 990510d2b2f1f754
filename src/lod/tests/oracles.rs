//! Rays and projections against slow oracles.

use super::*;
use crate::lod::{
    projection::Projection,
    scene::{Hit, Sight},
};
use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};

/// Tries every triangle of a scene.
fn tried_all(scene: &Scene, from: Vec3, direction: Vec3, reach_m: f32, sight: Sight) -> Option<Hit> {
    let mut nearest: Option<Hit> = None;
    for triangle in 0..scene.triangles().len() {
        let Some((distance_m, at)) = scene.meet(triangle, from, direction) else { continue };
        let is_nearer = distance_m < nearest.map_or(reach_m, |hit| hit.distance_m);
        if distance_m >= 0.0 && is_nearer && scene.stops(triangle, at, direction, sight) {
            nearest = Some(scene.hit(triangle, at, distance_m));
        }
    }
    nearest
}

#[test]
fn boxes_find_what_a_search_of_all_finds() {
    for name in ["oak", "birch", "billows"] {
        let (species, model, textures) = planted(name, 0.4);
        let scene = Scene::new(&species, &model, &textures);
        let mut random = Xoshiro256PlusPlus::seed_from_u64(5);
        let (mut hits, height_m) = (0, model.height_m());
        for index in 0..400 {
            let mut around = |size: f32| Vec3::from_array(std::array::from_fn(|_| random.random_range(-size..size)));
            let to = Vec3::Y * (0.6 * height_m) + around(0.3 * height_m);
            let from = to + around(1.0).normalize_or(Vec3::X) * (2.0 * height_m);
            let sight = [Sight::Tree, Sight::Crown, Sight::Wood][index % 3];
            let direction = (to - from).normalize();
            let (fast, slow) = (
                scene.cast(from, direction, 3.0 * height_m, sight),
                tried_all(&scene, from, direction, 3.0 * height_m, sight),
            );
            assert_eq!(fast, slow, "{name}");
            hits += usize::from(fast.is_some());
        }
        assert!(hits > 60, "{name}: {hits}");
    }
}

#[test]
fn a_projection_sees_what_single_rays_see() {
    let (species, model, textures) = planted("birch", 0.5);
    let scene = Scene::new(&species, &model, &textures);
    const RAYS: usize = 64;
    let mut projection = Projection::new(&scene, [RAYS, RAYS]);
    let (centre, half_m) = (Vec3::Y * (0.5 * model.height_m()), Vec3::splat(0.7 * model.height_m()));
    for (sight, least) in [(Sight::Tree, 300), (Sight::Wood, 30)] {
        let (mut unlike, mut hits) = (0, 0);
        for to_eye in [Vec3::Z, Vec3::new(0.6, 0.64, -0.48), Vec3::Y] {
            let basis = ViewBasis::towards(to_eye);
            projection.look(&basis, centre, half_m, sight);
            for (x, y) in (0..RAYS).flat_map(|y| (0..RAYS).map(move |x| (x, y))) {
                let place = 2.0 * (Vec2::new(x as f32, y as f32) + 0.5) / RAYS as f32 - 1.0;
                let from =
                    centre + basis.right * (place.x * half_m.x) - basis.up * (place.y * half_m.y) + to_eye * half_m.z;
                let ray = scene.cast(from, basis.forward, 2.0 * half_m.z, sight);
                let alike = match (projection.sample(x, y), ray) {
                    (Some(seen), Some(hit)) => (seen.depth - hit.distance_m / (2.0 * half_m.z)).abs() < 1e-4,
                    (seen, ray) => seen.is_none() == ray.is_none(),
                };
                unlike += usize::from(!alike);
                hits += usize::from(ray.is_some());
            }
        }
        // Rays along an edge, of a triangle or of a texel, may fall to either side.
        assert!(hits > least && unlike * 100 < hits, "{sight:?}: {unlike} of {hits}");
    }
}

/// Share of a tile's rays that the tree stops, by going through all triangles for each ray, without scene or projection.
fn projected_share(
    model: &TreeModel,
    textures: &SpeciesTextures,
    frame: &ViewFrame,
    basis: &ViewBasis,
    rays: usize,
) -> f32 {
    let mut stopped = vec![false; rays * rays];
    let mask = &textures.foliage.mips[3];
    let side = textures.foliage.width as usize >> 3;
    let mut stop = |corners: [Vec3; 3], uvs: Option<[Vec2; 3]>| {
        let [a, b, c] = corners.map(|corner| frame.place_in(basis, corner).truncate() * rays as f32);
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
    let (species, model, textures) = planted("oak", 0.12);
    let scene = Scene::new(&species, &model, &textures);
    let atlas = ViewAtlas::bake(&[scene], &ViewSettings { across: 4, view_texels: 32, rays: 1 });
    for view in [UVec2::ZERO, UVec2::new(1, 2), UVec2::new(3, 1)] {
        let basis = ViewBasis::of_view(view, atlas.across);
        let expected = projected_share(&model, &textures, &atlas.frame, &basis, 64);
        let share = cover(&view_of(&atlas, 0, view, 0));
        assert!(expected > 0.1 && (share - expected).abs() < 0.01, "{view}: {share} for {expected}");
    }
}
