//! A tree as OBJ with its materials as MTL and their textures as PNG.
//!
//! OBJ has no skeleton and no levels, and most readers know no colours of vertices: their mean is in the material.

use super::{
    error::ExportError,
    level::{Level, levels},
    look::SpeciesLook,
    picture::{Channels, png},
    settings::{ExportLevels, ExportSettings},
    surface::{Part, Surface},
    tree::{ExportedTree, GENERATOR},
    write::{ExportedFiles, require_file_name},
};
use crate::{setting::SettingError, texture::TextureData};
use bevy::math::Vec3;
use std::fmt::{self, Write};

/// A tree as `NAME.obj`, `NAME.mtl` and its pictures, y up, in metres. Numbers are written so that reading them gives the same ones.
///
/// # Errors
/// [`ExportError::Setting`] for the first setting outside its domain, the name, or levels other than [`ExportLevels::One`].
pub fn obj_files(tree: &ExportedTree, name: &str, settings: &ExportSettings) -> Result<ExportedFiles, ExportError> {
    settings.validate()?;
    require_file_name(name)?;
    if !matches!(settings.levels, ExportLevels::One(_)) {
        return Err(SettingError::new("levels", format!("{:?}", settings.levels), "One(..) for OBJ").into());
    }
    let look = SpeciesLook::new(tree, std::slice::from_ref(tree), settings);
    let mut files = ExportedFiles::default();
    let mut material_text = format!("# {GENERATOR}\n");
    let mut text = ObjText::new(name);
    for Level { parts, .. } in levels(tree, &look, settings) {
        for (part, surface) in parts {
            let pictures = part_pictures(&look, part, name)?;
            write_material(&mut material_text, part, mean_colour(&surface, &look, part), &pictures)?;
            files.0.extend(pictures);
            text.object(part.name(), part.name(), &surface)?;
        }
    }
    files.0.push((format!("{name}.mtl"), material_text.into_bytes()));
    files.0.push((format!("{name}.obj"), text.0.into_bytes()));
    Ok(files)
}

/// Colour, normals and mask of a part; what there is of them, in this order.
fn part_pictures(look: &SpeciesLook, part: Part, name: &str) -> Result<Vec<(String, Vec<u8>)>, ExportError> {
    let file = |what: &str| format!("{name}_{}_{what}.png", part.name());
    let colour = match part {
        Part::Wood => {
            return Ok(vec![
                (file("colour"), png("bark", &look.textures.bark.base_colour, Channels::Rgb)?),
                (file("normals"), png("bark normals", &look.textures.bark.normal, Channels::Rgb)?),
            ]);
        }
        Part::Leaves => look.leaves.texture(&look.textures.foliage, Vec3::ONE),
        Part::BareSprays => look.bare_texture(Vec3::ONE),
    };
    let mut pictures = vec![(file("colour"), png(part.name(), &colour, Channels::Rgb)?)];
    if let Some(normal) = look.normal_png(part) {
        pictures.push((file("normals"), normal?));
    }
    pictures.push((file("mask"), png("mask", &mask(&colour), Channels::Grey)?));
    Ok(pictures)
}

/// The alpha of the first mip, for readers that take a mask from brightness.
fn mask(texture: &TextureData) -> TextureData {
    let alpha = |mip: &Vec<u8>| mip.iter().skip(3).step_by(4).copied().collect();
    TextureData { mips: texture.mips.first().map(alpha).into_iter().collect(), ..*texture }
}

fn mean_colour(surface: &Surface, look: &SpeciesLook, part: Part) -> Vec3 {
    let gain = if part == Part::Wood { Vec3::splat(look.wood.gain) } else { look.leaves.gain() };
    let sum: Vec3 = surface
        .colours
        .iter()
        .map(|[red, green, blue, _]| Vec3::new(f32::from(*red), f32::from(*green), f32::from(*blue)))
        .sum();
    (gain * sum / (255.0 * surface.colours.len().max(1) as f32)).min(Vec3::ONE)
}

fn write_material(text: &mut String, part: Part, colour: Vec3, pictures: &[(String, Vec<u8>)]) -> fmt::Result {
    writeln!(text, "\nnewmtl {}\nillum 1\nKd {} {} {}\nKs 0 0 0", part.name(), colour.x, colour.y, colour.z)?;
    for (file, _) in pictures {
        let statement = match file {
            _ if file.ends_with("normals.png") => "norm",
            _ if file.ends_with("mask.png") => "map_d",
            _ => "map_Kd",
        };
        writeln!(text, "{statement} {file}")?;
    }
    Ok(())
}

/// The text of an OBJ.
pub(super) struct ObjText(pub String, usize);

impl ObjText {
    /// With the materials of `NAME.mtl`.
    pub fn new(name: &str) -> Self {
        Self(format!("# {GENERATOR}; metres, y up\nmtllib {name}.mtl\n"), 0)
    }

    /// Adds triangles of one material as an object.
    pub fn object(&mut self, object: &str, material: &str, surface: &Surface) -> fmt::Result {
        let text = &mut self.0;
        writeln!(text, "o {object}")?;
        for [x, y, z] in &surface.positions {
            writeln!(text, "v {x} {y} {z}")?;
        }
        // Here v runs up from the lower left corner.
        for [u, v] in &surface.uvs {
            writeln!(text, "vt {u} {}", 1.0 - v)?;
        }
        for [x, y, z] in &surface.normals {
            writeln!(text, "vn {x} {y} {z}")?;
        }
        writeln!(text, "usemtl {material}")?;
        for corners in surface.indices.chunks_exact(3) {
            let [a, b, c] = [0, 1, 2].map(|corner| self.1 + 1 + corners[corner] as usize);
            writeln!(text, "f {a}/{a}/{a} {b}/{b}/{b} {c}/{c}/{c}")?;
        }
        self.1 += surface.positions.len();
        Ok(())
    }
}
