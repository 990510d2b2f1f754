//! Levels of trees, and of every species that is shipped.

use super::{film::Film, profile::crown_points, settings::ViewSettings, *};
use crate::{
    texture::{MASK_CUT_OFF, TextureData},
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
