//! An atlas of impostors: pictures of a tree from all over the upper hemisphere, and a text that says what each shows.

use super::{
    error::ExportError,
    look::SpeciesLook,
    picture::{Channels, png},
    settings::ExportSettings,
    tree::ExportedTree,
    write::{ExportedFiles, require_file_name},
};
use crate::{
    lod::{ImpostorAtlas, ImpostorView, Scene},
    texture::MASK_CUT_OFF,
    tree::textures::SpeciesTextures,
};
use bevy::math::Vec3;
use serde_json::{Value, json};

/// The atlas of a tree: `NAME_colour.png` (sRGB, spread beyond the tree; alpha the share of each texel that it covers), `NAME_surface.png`
/// (half the tree-local normal and a half; alpha the translucency), `NAME_coverage.png` (the share of each texel, twice as fine) and
/// `NAME.json`, which says what is where. Leaves have their colour of `settings.year`. Below the grid of the tree in leaf, one of the
/// bare tree follows where leaves are shed.
///
/// # Errors
/// [`ExportError::Setting`] for the first setting outside its domain, or the name.
pub fn impostor_files(
    tree: &ExportedTree,
    name: &str,
    settings: &ExportSettings,
) -> Result<ExportedFiles, ExportError> {
    settings.validate()?;
    require_file_name(name)?;
    let look = SpeciesLook::new(tree, std::slice::from_ref(tree), settings);
    let foliage = look.leaves.texture(&tree.textures.foliage, Vec3::ONE);
    let textures = SpeciesTextures { foliage, ..tree.textures.clone() };
    let atlas = ImpostorAtlas::bake(&[Scene::new(tree.species, tree.model, &textures)], &settings.bake.impostor);
    let file = |what: &str| format!("{name}_{what}.png");
    let pictures = [
        (file("colour"), png("impostor colours", &atlas.colour, Channels::Rgba)?),
        (file("surface"), png("impostor surface", &atlas.surface, Channels::Rgba)?),
        (file("coverage"), png("impostor coverage", &atlas.coverage, Channels::Grey)?),
    ];
    let text = serde_json::to_vec_pretty(&description(
        tree,
        &atlas,
        settings.year,
        &pictures.each_ref().map(|(name, _)| name),
    ))?;
    Ok(ExportedFiles(pictures.into_iter().chain([(format!("{name}.json"), text)]).collect()))
}

fn description(tree: &ExportedTree, atlas: &ImpostorAtlas, year: f32, files: &[&String; 3]) -> Value {
    let per_side = atlas.views_per_side;
    let grids = ["in_leaf", "bare"].iter().zip((0..atlas.view_grids()).map(|grid| grid * per_side));
    let view = |(number, view): (u32, ImpostorView)| {
        let ImpostorView { to_eye, right, up, half_m } = view;
        json!({
            "column": number % per_side,
            "row": number / per_side,
            "to_eye": to_eye.to_array(),
            "right": right.to_array(),
            "up": up.to_array(),
            "half_size_m": half_m.to_array(),
        })
    };
    json!({
        "tree": tree.extras(year),
        "files": { "colour": files[0], "surface": files[1], "coverage": files[2] },
        "tile_texels": atlas.tile_texels.to_array(),
        "views_per_side": per_side,
        "grids": grids.map(|(season, first_row)| json!({ "season": season, "first_row": first_row })).collect::<Vec<_>>(),
        "centre_m": atlas.frame.centre.to_array(),
        "mask_cut_off": MASK_CUT_OFF,
        "projection": "parallel; a point p is at (dot(p - centre_m, right), dot(p - centre_m, up)) / half_size_m on the tile, -1 to 1, y up",
        "mapping": "with d / (|x| + |y| + |z|) = (x, y, z) for the unit vector d to the eye, its view is at column and row (0.5 + 0.5 (x + z), 0.5 + 0.5 (x - z)) (views_per_side - 1), rounded",
        "views": (0..).zip(atlas.views()).map(view).collect::<Vec<_>>(),
    })
}
