//! All that trees of one species in a file share: how they are shaded, and their pictures.

use super::{
    error::ExportError,
    leaf_look::LeafLook,
    picture::{Channels, png},
    settings::{ExportSettings, LeafSides},
    surface::{Part, WoodLook},
    tree::ExportedTree,
};
use crate::{
    texture::{TextureData, colour_bytes, linear},
    tree::{Species, textures::SpeciesTextures},
};
use bevy::math::Vec3;

/// How the trees of a species are shaded.
pub(super) struct SpeciesLook<'a> {
    pub species: &'a Species,
    pub textures: &'a SpeciesTextures,
    pub wood: WoodLook,
    pub leaves: LeafLook<'a>,
    pub leaf_sides: LeafSides,
}

impl<'a> SpeciesLook<'a> {
    /// Of trees of one species, of which there is at least one.
    pub fn new(first: &ExportedTree<'a>, trees: &[ExportedTree<'a>], settings: &ExportSettings) -> Self {
        let wood: Vec<_> = trees.iter().map(|tree| &*tree.model.wood).collect();
        let leaves: Vec<_> = trees.iter().map(|tree| &*tree.model.leaves).collect();
        Self {
            species: first.species,
            textures: first.textures,
            wood: WoodLook::new(&first.species.wood, &wood),
            leaves: LeafLook::new(first.species, first.textures, &leaves, (settings.year, settings.tint)),
            leaf_sides: settings.leaf_sides,
        }
    }

    /// Whether the material of a part has a map of normals, for which its vertices need tangents.
    pub fn has_normal_map(&self, part: Part) -> bool {
        part == Part::Wood || self.textures.foliage_normal.is_some()
    }

    /// The colours of a part, with the mask of leaves.
    pub fn colour_png(&self, part: Part) -> Result<Vec<u8>, ExportError> {
        let foliage = &self.textures.foliage;
        let (colour, channels) = match part {
            Part::Wood => (lightened(&self.textures.bark.base_colour, self.wood.gain), Channels::Rgb),
            Part::Leaves => (self.leaves.texture(foliage, self.leaves.gain()), Channels::Rgba),
            Part::BareSprays => (self.bare_texture(self.leaves.gain()), Channels::Rgba),
        };
        png(&format!("{} {}", self.species.name, part.name()), &colour, channels)
    }

    /// The texture of sprays without leaves, so many times as light.
    pub fn bare_texture(&self, gain: Vec3) -> TextureData {
        match &self.textures.bare_foliage {
            Some(twigs) => self.leaves.texture(twigs, gain),
            None => self.leaves.bare_texture(&self.textures.foliage, gain),
        }
    }

    /// The normals of a part; crowns of polygons and of ellipsoids have none.
    pub fn normal_png(&self, part: Part) -> Option<Result<Vec<u8>, ExportError>> {
        let normal = match part {
            Part::Wood => Some(&self.textures.bark.normal),
            Part::Leaves | Part::BareSprays => self.textures.foliage_normal.as_ref(),
        };
        normal.map(|normal| png(&format!("{} {} normals", self.species.name, part.name()), normal, Channels::Rgb))
    }

    /// The bark's occlusion in red, roughness in green, metal in blue.
    pub fn bark_surface_png(&self) -> Result<Vec<u8>, ExportError> {
        png(&format!("{} bark surface", self.species.name), &self.textures.bark.surface, Channels::Rgb)
    }
}

/// The first mip of a texture, `gain` times as light.
fn lightened(texture: &TextureData, gain: f32) -> TextureData {
    let light: [f32; 256] = std::array::from_fn(|byte| gain * linear([byte as f32 / 255.0; 3])[0]);
    let texel = |texel: &[u8]| {
        let [red, green, blue] = std::array::from_fn(|channel| light[usize::from(texel[channel])]);
        colour_bytes(&[red, green, blue, f32::from(texel[3]) / 255.0])
    };
    let mip = texture
        .mips
        .first()
        .map(|mip| if gain == 1.0 { mip.clone() } else { mip.chunks_exact(4).flat_map(texel).collect() });
    TextureData { mips: mip.into_iter().collect(), ..*texture }
}
