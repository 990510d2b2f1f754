//! All levels of trees together, of every species that is shipped; and what the tests of single levels share.

use super::{
    CrossedPolygons, DecimatedMeshes, EnvelopeLevel, EnvelopeSettings, ImpostorAtlas, LodBakeSettings, Scene,
    bake::texels::TexelGrid, crossed_polygons, decimate, settings::ImpostorSettings, thinned_meshes,
};
use crate::{
    texture::TextureData,
    tree::{
        Species, TreeModel,
        textures::{SpeciesTextures, species_textures},
    },
};
use bevy::math::UVec2;
use std::{fs, path::Path};

mod crown_density;
mod envelope;
mod impostor;
mod ray_oracles;
mod sway_frames;

/// A species that is shipped, at a share of its mature age, and its textures.
fn grown(name: &str, age: f32) -> (Species, TreeModel, SpeciesTextures) {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/species").join(format!("{name}.species.ron"));
    let species = Species::from_ron(&fs::read_to_string(file).unwrap()).unwrap();
    let model = TreeModel::bake(&species, age * species.age.mature_years, 1);
    let textures = species_textures(&species);
    (species, model, textures)
}

/// Small levels, for what has to be quick.
fn small() -> LodBakeSettings {
    LodBakeSettings {
        envelope: EnvelopeSettings { width_texels: 32, height_texels: 16, ..EnvelopeSettings::default() },
        impostor: ImpostorSettings { views_per_side: 4, tile_texels: 32, rays: 1 },
        ..LodBakeSettings::default()
    }
}

/// All lower levels of one model.
#[derive(Clone, Debug, PartialEq)]
struct AllLevels {
    decimated: Vec<DecimatedMeshes>,
    envelope: Option<EnvelopeLevel>,
    polygons: CrossedPolygons,
    impostors: ImpostorAtlas,
}

fn all_levels(
    species: &Species,
    model: &TreeModel,
    textures: &SpeciesTextures,
    settings: &LodBakeSettings,
) -> AllLevels {
    let scene = Scene::new(species, model, textures);
    let envelope = EnvelopeLevel::bake(&scene, species, model, &settings.envelope);
    AllLevels {
        decimated: settings.decimations.iter().map(|decimation| decimate(model, decimation)).collect(),
        polygons: crossed_polygons(&scene, model, envelope.as_ref()),
        impostors: ImpostorAtlas::bake(std::slice::from_ref(&scene), &settings.impostor),
        envelope,
    }
}

/// The texels of a tile in a mip of a texture, as bytes.
fn tile_of(texture: &TextureData, mip: usize, [left, top]: [usize; 2], [width, height]: [usize; 2]) -> Vec<[u8; 4]> {
    let across = texture.width as usize >> mip;
    let texels = (top..top + height).flat_map(|y| (left..left + width).map(move |x| y * across + x));
    texels.map(|index| std::array::from_fn(|channel| texture.mips[mip][4 * index + channel])).collect()
}

/// The tile of a view of a tree in a mip of an atlas: colours and surfaces.
fn view_of(atlas: &ImpostorAtlas, tree: u32, view: UVec2, mip: usize) -> [Vec<[u8; 4]>; 2] {
    let size = atlas.tile_texels / (1 << mip);
    let corner = (view + UVec2::new(0, tree * atlas.views_per_side)) * size;
    let texels = |size: UVec2| size.to_array().map(|texels| texels as usize);
    [&atlas.colour, &atlas.surface].map(|texture| tile_of(texture, mip, texels(corner), texels(size)))
}

/// Mean coverage of a tile.
fn coverage([colours, _]: &[Vec<[u8; 4]>; 2]) -> f32 {
    colours.iter().map(|texel| f32::from(texel[3]) / 255.0).sum::<f32>() / colours.len() as f32
}

#[test]
fn the_same_tree_has_the_same_levels() {
    let (species, model, textures) = grown("birch", 0.5);
    let bake = || all_levels(&species, &model, &textures, &small());
    assert_eq!(bake(), bake());
    let other = LodBakeSettings { envelope: EnvelopeSettings { seed: 1, ..small().envelope }, ..small() };
    let other = all_levels(&species, &model, &textures, &other);
    assert_ne!(other.envelope.unwrap().envelope.positions, bake().envelope.unwrap().envelope.positions);
}

#[test]
fn bare_and_empty_trees_have_levels() {
    let (species, mut model, textures) = grown("oak", 0.5);
    model.leaves = Default::default();
    let bare = all_levels(&species, &model, &textures, &small());
    assert!(bare.envelope.is_some() && bare.decimated[0].leaves.indices.is_empty());
    model.wood = Default::default();
    let empty = all_levels(&species, &model, &textures, &small());
    assert!(empty.envelope.is_none());
    assert_eq!(empty.polygons.indices.len(), 12, "two rectangles");
    assert_eq!(TexelGrid::new(2, 2).coverage(), 0.0);
}

#[test]
fn every_shipped_species_has_finite_levels() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/species");
    for file in fs::read_dir(folder).unwrap().map(|file| file.unwrap().file_name().into_string().unwrap()) {
        let name = file.strip_suffix(".species.ron").unwrap();
        for age in [0.02, 1.0] {
            let (species, model, textures) = grown(name, age);
            let all = all_levels(&species, &model, &textures, &small());
            let envelope = all.envelope.as_ref();
            let mut vectors: Vec<[f32; 3]> = [&all.polygons.positions, &all.polygons.normals, &all.polygons.colours]
                .into_iter()
                .chain(envelope.iter().flat_map(|level| [&level.envelope.positions, &level.envelope.normals]))
                .chain(envelope.iter().flat_map(|level| [&level.trunk.positions, &level.trunk.normals]))
                .flatten()
                .copied()
                .collect();
            vectors.extend(all.decimated.iter().flat_map(|meshes| meshes.leaves.positions.iter().copied()));
            assert!(vectors.iter().flatten().all(|value| value.is_finite()), "{name} at {age}");
            let drawn = coverage(&view_of(&all.impostors, 0, UVec2::ZERO, 0));
            assert!(drawn > 0.0, "{name} at {age} is not seen");
        }
    }
}

/// How high a tree is, by the length of its sprays, and how many of these it keeps in the coarsest level, as the share of their vertices.
fn kept_leaves(name: &str, age: f32) -> (f32, f32) {
    let (species, model, _) = grown(name, age);
    let levels = thinned_meshes(&species, &model, &LodBakeSettings::default());
    let kept = levels[1].meshes.leaves.positions.len() as f32 / model.leaves.positions.len() as f32;
    (model.height_m() / species.foliage.size_m, kept)
}

/// Sprays grow to a sixth of the height at most: fewer would not have the area of all. An oak bears what is asked for.
#[test]
fn shrubs_keep_the_sprays_that_enlarged_would_be_too_large() {
    for age in [0.35, 0.5] {
        let (sprays_high, kept) = kept_leaves("hazel", age);
        let least = (6.0 / sprays_high).powi(2).min(1.0);
        assert!(least > 0.22 && (kept - least).abs() < 0.03, "{sprays_high}: {kept}, and {least}");
    }
    let (_, oak) = kept_leaves("oak", 1.0);
    assert!((oak - 0.2).abs() < 0.02, "{oak}");
}
