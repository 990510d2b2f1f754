//! Levels of trees, and of every species that is shipped.

use super::{
    film::{Alpha, Film, Sample},
    profile::crown_points,
    settings::ViewSettings,
    *,
};
use crate::{
    texture::{MASK_CUT_OFF, TextureData, linear},
    tree::painting::paint,
};
use bevy::math::{UVec2, Vec2, Vec3};
use std::{fs, path::Path};

mod images;
mod oracles;

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
        views: ViewSettings { across: 4, view_texels: 32, rays: 1 },
        ..LevelSettings::default()
    }
}

/// The texels of a tile in a mip of a texture, as bytes.
fn tile_of(texture: &TextureData, mip: usize, [left, top]: [usize; 2], [width, height]: [usize; 2]) -> Vec<[u8; 4]> {
    let across = texture.width as usize >> mip;
    let texels = (top..top + height).flat_map(|y| (left..left + width).map(move |x| y * across + x));
    texels.map(|index| std::array::from_fn(|channel| texture.mips[mip][4 * index + channel])).collect()
}

/// The tile of a view of a tree in a mip of an atlas: colours and surfaces.
fn view_of(atlas: &ViewAtlas, tree: u32, view: UVec2, mip: usize) -> [Vec<[u8; 4]>; 2] {
    let size = atlas.view_texels / (1 << mip);
    let corner = (view + UVec2::new(0, tree * atlas.across)) * size;
    let texels = |size: UVec2| size.to_array().map(|texels| texels as usize);
    [&atlas.colour, &atlas.surface].map(|texture| tile_of(texture, mip, texels(corner), texels(size)))
}

/// Mean coverage of a tile.
fn cover([colours, _]: &[Vec<[u8; 4]>; 2]) -> f32 {
    colours.iter().map(|texel| f32::from(texel[3]) / 255.0).sum::<f32>() / colours.len() as f32
}

/// Mean light, normal and translucency of what is seen on a tile.
fn mean([colours, surfaces]: &[Vec<[u8; 4]>; 2]) -> [Vec3; 3] {
    let share = |bytes: [u8; 4]| bytes.map(|byte| f32::from(byte) / 255.0);
    let (mut sums, mut whole) = ([Vec3::ZERO; 3], 0.0);
    for (&colour, &surface) in colours.iter().zip(surfaces) {
        let ([r, g, b, alpha], [x, y, z, leaf]) = (share(colour), share(surface));
        sums[0] += alpha * Vec3::from_array(linear([r, g, b]));
        sums[1] += alpha * (2.0 * Vec3::new(x, y, z) - 1.0);
        sums[2] += alpha * leaf;
        whole += alpha;
    }
    sums.map(|sum| sum / whole)
}

fn views_of(atlas: &ViewAtlas) -> impl Iterator<Item = (u32, UVec2)> {
    let across = atlas.across;
    (0..atlas.trees * across * across)
        .map(move |tile| (tile / across / across, UVec2::new(tile % across, tile / across % across)))
}

#[test]
fn mips_keep_what_is_seen_of_a_tile_and_tiles_have_a_free_rim() {
    for (name, size) in [("birch", UVec2::new(32, 64)), ("fir", UVec2::new(16, 64)), ("hazel", UVec2::new(64, 64))] {
        let (species, model, textures) = planted(name, 1.0);
        let scene = Scene::new(&species, &model, &textures);
        let atlas = ViewAtlas::bake(&[scene], &ViewSettings { across: 4, view_texels: 64, rays: 1 });
        assert_eq!(atlas.view_texels, size, "{name}");
        let mips = size.min_element().ilog2() as usize;
        assert_eq!([atlas.colour.mips.len(), atlas.surface.mips.len()], [mips; 2], "{name}: to 2 texels");
        for (tree, view) in views_of(&atlas) {
            let finest = view_of(&atlas, tree, view, 0);
            let (seen, means) = (cover(&finest), mean(&finest));
            assert!(seen > 0.1, "{name} {view}: {seen}");
            for mip in 1..mips {
                let coarser = view_of(&atlas, tree, view, mip);
                assert!((cover(&coarser) - seen).abs() < 0.5 / 255.0, "{name} {view} {mip}: {}", cover(&coarser));
                // Half a step of all bytes: of dark colours, where the steps of sRGB are finest, and of normals.
                for (mean, finest) in mean(&coarser).into_iter().zip(means) {
                    assert!(mean.distance(finest) < 2.0 / 255.0, "{name} {view} {mip}: {mean} for {finest}");
                }
            }
            let (width, height) = (size.x as usize, size.y as usize);
            for (index, texel) in finest[0].iter().enumerate() {
                let (x, y) = (index % width, index / width);
                let is_rim = x == 0 || y == 0 || x == width - 1 || y == height - 1;
                assert!(!is_rim || texel[3] < 128, "{name} {view}: {} at {x} {y}", texel[3]);
            }
        }
    }
}

#[test]
fn normals_of_one_place_that_differ_are_short() {
    let sample = |normal| Sample { colour: [0.5; 3], normal, translucency: 1.0, depth: 0.0 };
    let mut film = Film::new(4, 4);
    film.texels[0].add(&sample(Vec3::X), 0.5);
    film.texels[0].add(&sample(Vec3::Z), 0.5);
    film.texels[1].add(&sample(Vec3::NEG_Y), 0.25);
    let surface = film.developed([4, 4], 2, Alpha::Share).surface;
    let normal = |mip: usize, index: usize| {
        let [x, y, z] = std::array::from_fn(|channel| f32::from(surface.mips[mip][4 * index + channel]) / 127.5 - 1.0);
        Vec3::new(x, y, z)
    };
    for (mip, index, expected) in
        [(0, 0, Vec3::new(0.5, 0.0, 0.5)), (0, 1, Vec3::NEG_Y), (1, 0, Vec3::new(0.4, -0.2, 0.4))]
    {
        assert!(normal(mip, index).distance(expected) < 0.01, "{mip} {index}: {}", normal(mip, index));
    }
}

#[test]
fn trees_of_an_atlas_have_views_as_if_alone() {
    let (species, model, textures) = planted("birch", 0.5);
    let other = TreeModel::bake(&species, 0.5 * species.age.mature_years, 2);
    let scenes = [&model, &other, &model].map(|model| Scene::new(&species, model, &textures));
    let atlas = ViewAtlas::bake(&scenes, &small().views);
    let tall = scenes.iter().flat_map(|scene| &scene.corners).map(|corner| corner.position.y).fold(0.0, f32::max);
    assert!((atlas.frame.centre.y + atlas.frame.half_height_m) > tall);
    assert_eq!(atlas.colour.height, 2 * 3 * 4 * atlas.view_texels.y);
    for view in views_of(&atlas).filter(|(tree, _)| *tree == 0).map(|(_, view)| view) {
        let [one, other, again] = [0, 1, 2].map(|tree| view_of(&atlas, tree, view, 0));
        assert!(one == again && one != other, "{view}");
    }
    let place = atlas.atlas_place(1, UVec2::new(2, 3), Vec2::new(0.5, 0.25));
    assert!(place.distance(Vec2::new(2.5 / 4.0, 7.25 / 24.0)) < 1e-6, "{place}");
}

#[test]
fn what_sheds_its_leaves_has_views_of_its_wood_alone() {
    let (species, model, textures) = planted("birch", 1.0);
    let atlas = ViewAtlas::bake(&[Scene::new(&species, &model, &textures)], &small().views);
    assert!(atlas.has_bare && atlas.blocks() == 2);
    for (_, view) in views_of(&atlas) {
        let [leafy, bare] = [0, 1].map(|tree| view_of(&atlas, tree, view, 0));
        assert!(cover(&bare) > 0.0 && cover(&bare) < 0.7 * cover(&leafy), "{view}: {}", cover(&bare));
        let seen = bare[0].iter().zip(&bare[1]).filter(|(colour, _)| colour[3] > 0);
        assert!(seen.clone().count() > 20 && seen.clone().all(|(_, surface)| surface[3] == 0), "{view}: leaves");
        // A ray that hits wood alone hits the tree.
        assert!(bare[0].iter().zip(&leafy[0]).all(|(bare, leafy)| bare[3] <= leafy[3]), "{view}");
    }
    let (fir, model, textures) = planted("fir", 0.3);
    let evergreen = ViewAtlas::bake(&[Scene::new(&fir, &model, &textures)], &small().views);
    assert!(!evergreen.has_bare && evergreen.blocks() == 1);
}

#[test]
fn an_atlas_leads_from_the_eye_to_the_tile() {
    let (species, model, textures) = planted("fir", 0.3);
    let scene = Scene::new(&species, &model, &textures);
    let corners = scene.corners.clone();
    let atlas = ViewAtlas::bake(&[scene], &small().views);
    for corner in corners.iter().step_by(7) {
        for (basis, view, _) in atlas.towards(Vec3::new(0.3, 0.5, -0.8)) {
            let place = atlas.frame.place_in(&basis, corner.position);
            assert!(place.cmpge(Vec3::ZERO).all() && place.cmple(Vec3::ONE).all(), "{place}");
            let texel = atlas.atlas_place(0, view, place.truncate()) * atlas.across as f32;
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
            let drawn = cover(&view_of(&all.views, 0, UVec2::ZERO, 0));
            assert!(drawn > 0.0, "{name} at {age} is not seen");
        }
    }
}

#[test]
fn a_picture_leans_where_the_tree_does() {
    // Slender trees bend as a whole; what moves of an oak are its branches, which no lean shows.
    for (name, most) in [("fir", 0.1), ("norway_spruce", 0.1), ("birch", 0.2), ("oak", 0.8)] {
        let (species, model, textures) = planted(name, 1.0);
        let scene = Scene::new(&species, &model, &textures);
        let lean = Lean::of(&scene, &model);
        // As `impostor_vertex.wesl` does, in a fresh breeze of 9.4 m/s.
        let free = lean.gain * 9.4 * 9.4;
        let sine = free / (1.0 + (free / 1.1_f32.sin()).powi(2)).sqrt();
        let leaning = |p: Vec3| Vec3::new(p.x + p.y * sine, p.y * (1.0 - sine * sine).sqrt(), p.z);
        let (mut off, mut moved) = (0.0, 0.0);
        for (rest, bent) in scene.corners.iter().zip(&lean::bent(&scene, &model, Vec3::X).corners) {
            off += leaning(rest.position).distance_squared(bent.position);
            moved += rest.position.distance_squared(bent.position);
        }
        assert!(sine > 0.01 && off < most * moved, "{name}: {sine}, {}", off / moved);
        assert_eq!(lean.class, model.beams[0].class, "{name}");
    }
    let (species, mut model, textures) = planted("birch", 0.1);
    model.beams.clear();
    assert_eq!(Lean::of(&Scene::new(&species, &model, &textures), &model), Lean::default());
}

#[test]
fn an_outline_has_the_coverage_of_its_colours() {
    let (species, model, textures) = planted("birch", 0.5);
    for rays in [1, 2] {
        let settings = ViewSettings { rays, ..small().views };
        let atlas = ViewAtlas::bake(&[Scene::new(&species, &model, &textures)], &settings);
        let (fine, coarse) = (&atlas.outline, &atlas.colour);
        assert_eq!((fine.width, fine.height), (2 * coarse.width, 2 * coarse.height));
        assert_eq!(fine.mips.len(), coarse.mips.len() + 1);
        let (across, width) = (fine.width as usize, coarse.width as usize);
        for (index, texel) in coarse.mips[0].chunks_exact(4).enumerate() {
            let first = 2 * (index / width) * across + 2 * (index % width);
            let four = [0, 1, across, across + 1].map(|step| f32::from(fine.mips[0][first + step]));
            let mean = four.iter().sum::<f32>() / 4.0;
            assert!((mean - f32::from(texel[3])).abs() <= 1.0, "{rays} {index}: {mean} for {}", texel[3]);
        }
    }
}
