//! Levels against slow oracles, and of every species that is shipped.

use super::{
    film::Film,
    profile::crown_points,
    projection::Projection,
    scene::{Hit, Sight},
    settings::ViewSettings,
    *,
};
use crate::{
    texture::{MASK_CUT_OFF, TextureData},
    tree::painting::paint,
};
use bevy::math::{UVec2, Vec2, Vec3};
use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};
use std::{fs, path::Path};

/// A species that is shipped, at a share of its mature age, and what it wears.
fn planted(name: &str, age: f32) -> (Species, TreeModel, SpeciesTextures) {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/species").join(format!("{name}.species.ron"));
    let species = Species::from_ron(&fs::read_to_string(file).unwrap()).unwrap();
    let model = TreeModel::bake(&species, age * species.age.mature_years, 1);
    let textures = paint(&species);
    (species, model, textures)
}

/// Small levels, for what has to be quick.
fn small() -> LevelSettings {
    LevelSettings {
        cylinder: CylinderSettings { width_texels: 32, height_texels: 16, ..CylinderSettings::default() },
        views: ViewSettings { across: 4, view_texels: 32, rays: 2 },
        ..LevelSettings::default()
    }
}

/// The share of texels of a tile that pass the mask.
fn drawn_share(texture: &TextureData, mip: usize, left: usize, top: usize, tile: [usize; 2]) -> f32 {
    let width = texture.width as usize >> mip;
    let rows = top..top + tile[1];
    let texels = rows.flat_map(|y| (left..left + tile[0]).map(move |x| y * width + x));
    let alpha = |index: usize| f32::from(texture.mips[mip][4 * index + 3]) / 255.0;
    texels.filter(|&index| alpha(index) > MASK_CUT_OFF).count() as f32 / (tile[0] * tile[1]) as f32
}

/// Tries every triangle of a scene.
fn tried_all(scene: &Scene, from: Vec3, direction: Vec3, reach_m: f32, sight: Sight) -> Option<Hit> {
    let mut nearest: Option<Hit> = None;
    for triangle in 0..scene.triangles.len() {
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
            let sight = if index % 2 == 0 { Sight::Tree } else { Sight::Crown };
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
    let mut projection = Projection::new(&scene, RAYS);
    let (centre, half_m) = (Vec3::Y * (0.5 * model.height_m()), Vec3::splat(0.7 * model.height_m()));
    let (mut unlike, mut hits) = (0, 0);
    for to_eye in [Vec3::Z, Vec3::new(0.6, 0.64, -0.48), Vec3::Y] {
        let basis = ViewBasis::towards(to_eye);
        projection.look(&basis, centre, half_m);
        for (x, y) in (0..RAYS).flat_map(|y| (0..RAYS).map(move |x| (x, y))) {
            let place = 2.0 * (Vec2::new(x as f32, y as f32) + 0.5) / RAYS as f32 - 1.0;
            let from =
                centre + basis.right * (place.x * half_m.x) - basis.up * (place.y * half_m.y) + to_eye * half_m.z;
            let ray = scene.cast(from, basis.forward, 2.0 * half_m.z, Sight::Tree);
            let alike = match (projection.sample(x, y), ray) {
                (Some(seen), Some(hit)) => (seen.depth - hit.distance_m / (2.0 * half_m.z)).abs() < 1e-4,
                (seen, ray) => seen.is_none() == ray.is_none(),
            };
            unlike += usize::from(!alike);
            hits += usize::from(ray.is_some());
        }
    }
    // Rays along an edge, of a triangle or of a texel, may fall to either side.
    assert!(hits > 300 && unlike * 100 < hits, "{unlike} of {hits}");
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
        for index in 0..rays * rays {
            let ray = Vec2::new((index % rays) as f32 + 0.5, (index / rays) as f32 + 0.5);
            let shares = [(c - b).perp_dot(ray - b), (a - c).perp_dot(ray - c), (b - a).perp_dot(ray - a)];
            let shares = shares.map(|share| share / whole);
            if whole != 0.0 && shares.iter().all(|&share| share >= 0.0) {
                let is_there = uvs.is_none_or(|uvs| {
                    let uv: Vec2 = shares.iter().zip(uvs).map(|(&share, uv)| share * uv).sum();
                    let texel = (uv * side as f32).as_uvec2().min(UVec2::splat(side as u32 - 1)).as_usizevec2();
                    f32::from(mask[4 * (texel.y * side + texel.x) + 3]) / 255.0 > MASK_CUT_OFF
                });
                stopped[index] |= is_there;
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
    let atlas = ViewAtlas::bake(&scene, &ViewSettings { across: 4, view_texels: 32, rays: 2 });
    for view in [UVec2::ZERO, UVec2::new(1, 2), UVec2::new(3, 1)] {
        let basis = ViewBasis::of_view(view, atlas.across);
        let expected = projected_share(&model, &textures, &atlas.frame, &basis, 64);
        let [left, top] = (view * atlas.view_texels).to_array().map(|texel| texel as usize);
        let share = drawn_share(&atlas.colour, 0, left, top, [32, 32]);
        // Equal coverages pass the mask together: some texels of 1024.
        assert!(expected > 0.1 && (share - expected).abs() < 0.01, "{view}: {share} for {expected}");
    }
}

#[test]
fn tiles_keep_their_coverage_in_all_mips_and_a_free_rim() {
    let (species, model, textures) = planted("birch", 1.0);
    let scene = Scene::new(&species, &model, &textures);
    let atlas = ViewAtlas::bake(&scene, &ViewSettings { across: 4, view_texels: 64, rays: 2 });
    assert_eq!(atlas.colour.mips.len(), 5, "64 to 4 texels");
    assert_eq!(atlas.surface.mips.len(), 5);
    for (column, row) in (0..4).flat_map(|row| (0..4).map(move |column| (column, row))) {
        let share = |mip: usize| {
            let tile = 64 >> mip;
            drawn_share(&atlas.colour, mip, column * tile, row * tile, [tile, tile])
        };
        for mip in 1..4 {
            // Half a texel of the mip, and ties of some texels.
            let least = 2.0 / (64 >> mip) as f32 / (64 >> mip) as f32;
            assert!((share(mip) - share(0)).abs() < 0.01 + least, "{column} {row}: {} for {}", share(mip), share(0));
        }
        for texel in 0..64 {
            let texels = [(texel, 0), (texel, 63), (0, texel), (63, texel)];
            for (x, y) in texels {
                let index = (row * 64 + y) * 256 + column * 64 + x;
                let alpha = atlas.colour.mips[0][4 * index + 3];
                assert!(f32::from(alpha) / 255.0 < MASK_CUT_OFF, "{column} {row}: {alpha} at {x} {y}");
            }
        }
    }
}

#[test]
fn an_atlas_leads_from_the_eye_to_the_tile() {
    let (species, model, textures) = planted("fir", 0.3);
    let scene = Scene::new(&species, &model, &textures);
    let atlas = ViewAtlas::bake(&scene, &small().views);
    for corner in scene.corners.iter().step_by(7) {
        for (basis, view, _) in atlas.towards(Vec3::new(0.3, 0.5, -0.8)) {
            let place = atlas.frame.place_in(&basis, corner.position);
            assert!(place.cmpge(Vec3::ZERO).all() && place.cmple(Vec3::ONE).all(), "{place}");
            let texel = atlas.atlas_place(view, place.truncate()) * atlas.across as f32;
            assert_eq!(texel.floor().as_uvec2(), view);
            assert!((basis.right.cross(basis.up) + basis.forward).length() < 1e-5);
        }
    }
    let own = view_direction(Vec2::new(1.0, 2.0) / 3.0);
    assert_eq!(atlas.nearest_view(own), UVec2::new(1, 2));
}

#[test]
fn the_smooth_envelope_holds_the_leaves_that_it_should() {
    for name in ["oak", "fir", "poplar", "hazel"] {
        let (species, model, textures) = planted(name, 1.0);
        let scene = Scene::new(&species, &model, &textures);
        let settings = CylinderSettings { roughness: 0.0, ..small().cylinder };
        let level = CylinderLevel::bake(&scene, &species, &model, &settings).unwrap();
        let points = crown_points(&model);
        let inside = points.iter().filter(|point| level.profile.encloses(**point)).count() as f32;
        assert!((inside / points.len() as f32 - settings.enclosed).abs() < 2e-3, "{name}: {inside}");
        assert!((0.2..=1.0).contains(&level.cover), "{name}: {}", level.cover);
        assert_eq!(level.profile.is_conical(), name == "fir", "{name}");
    }
}

#[test]
fn the_envelope_hangs_on_the_stem_and_closes() {
    let (species, model, textures) = planted("oak", 1.0);
    let scene = Scene::new(&species, &model, &textures);
    let level = CylinderLevel::bake(&scene, &species, &model, &small().cylinder).unwrap();
    let order = |sway: &[f32; 4]| model.skeleton.beams[sway[0] as usize].order;
    assert!(level.envelope.sway.iter().chain(&level.trunk.sway).all(|sway| order(sway) == 0));
    // The volume that a closed surface encloses, seen from outside counter-clockwise, is positive (divergence theorem).
    let volume = |positions: &[[f32; 3]], indices: &[u32]| -> f32 {
        let corner = |index: u32| Vec3::from_array(positions[index as usize]);
        indices
            .chunks_exact(3)
            .map(|triple| corner(triple[0]).dot(corner(triple[1]).cross(corner(triple[2]))) / 6.0)
            .sum()
    };
    let profile = &level.profile;
    let step_m = (profile.top_m - profile.base_m) / (profile.radii_m.len() - 1) as f32;
    let expected: f32 = profile
        .radii_m
        .windows(2)
        .map(|pair| std::f32::consts::PI * step_m * (pair[0] * pair[0] + pair[0] * pair[1] + pair[1] * pair[1]) / 3.0)
        .sum();
    let found = volume(&level.envelope.positions, &level.envelope.indices);
    assert!((found / expected - 1.0).abs() < 0.25, "{found} for {expected}");
    assert!(volume(&level.trunk.positions, &level.trunk.indices) > 0.0);
}

#[test]
fn the_same_tree_has_the_same_levels() {
    let (species, model, textures) = planted("birch", 0.5);
    let bake = || levels(&species, &model, &textures, &small());
    assert_eq!(bake(), bake());
    let other = LevelSettings { cylinder: CylinderSettings { seed: 1, ..small().cylinder }, ..small() };
    let other = levels(&species, &model, &textures, &other);
    assert_ne!(other.cylinder.unwrap().envelope.positions, bake().cylinder.unwrap().envelope.positions);
}

#[test]
fn bare_and_empty_trees_have_levels() {
    let (species, mut model, textures) = planted("oak", 0.5);
    model.leaves = Default::default();
    let bare = levels(&species, &model, &textures, &small());
    assert!(bare.cylinder.is_some() && bare.reduced[0].leaves.indices.is_empty());
    model.wood = Default::default();
    let empty = levels(&species, &model, &textures, &small());
    assert!(empty.cylinder.is_none());
    assert_eq!(empty.plain.indices.len(), 12, "two rectangles");
    assert_eq!(Film::new(2, 2).cover(), 0.0);
}

#[test]
fn every_shipped_species_has_levels() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/species");
    for file in fs::read_dir(folder).unwrap().map(|file| file.unwrap().file_name().into_string().unwrap()) {
        let name = file.strip_suffix(".species.ron").unwrap();
        for age in [0.02, 1.0] {
            let (species, model, textures) = planted(name, age);
            let all = levels(&species, &model, &textures, &small());
            let cylinder = all.cylinder.as_ref();
            let mut vectors: Vec<[f32; 3]> = [&all.plain.positions, &all.plain.normals, &all.plain.colours]
                .into_iter()
                .chain(cylinder.iter().flat_map(|level| [&level.envelope.positions, &level.envelope.normals]))
                .chain(cylinder.iter().flat_map(|level| [&level.trunk.positions, &level.trunk.normals]))
                .flatten()
                .copied()
                .collect();
            vectors.extend(all.reduced.iter().flat_map(|meshes| meshes.leaves.positions.iter().copied()));
            assert!(vectors.iter().flatten().all(|value| value.is_finite()), "{name} at {age}");
            let drawn = drawn_share(&all.views.colour, 0, 0, 0, [32, 32]);
            assert!(drawn > 0.0, "{name} at {age} is not seen");
        }
    }
}
