//! The pictures of a species as the renderer takes them: megabytes, laid out in the background.

use crate::{
    shading::{ALL_MIPS, image},
    texture::TextureData,
    tree::{bark::BarkTextures, painting::SpeciesTextures},
};
use bevy::{image::ImageAddressMode, prelude::*};

/// Coarsest mip of masked foliage that is used: beyond it a spray is a few texels, between which no alpha passes the mask,
/// and distant crowns would go bare.
const FOLIAGE_LOD_LIMIT: f32 = 3.0;

/// What a species wears, as images.
pub(super) struct Painted {
    pub bark: Image,
    pub bark_normal: Image,
    pub bark_surface: Image,
    pub foliage: Image,
    pub foliage_normal: Option<Image>,
    /// Mean colour of the foliage, sRGB 0 to 1.
    pub foliage_colour: [f32; 3],
}

impl From<&SpeciesTextures> for Painted {
    fn from(textures: &SpeciesTextures) -> Self {
        let BarkTextures { base_colour, normal, surface } = &textures.bark;
        let leafy = |texture| image(texture, ImageAddressMode::ClampToEdge, FOLIAGE_LOD_LIMIT);
        Self {
            bark: wrapped(base_colour),
            bark_normal: wrapped(normal),
            bark_surface: wrapped(surface),
            foliage: leafy(&textures.foliage),
            foliage_normal: textures.foliage_normal.as_ref().map(leafy),
            foliage_colour: textures.foliage_colour(),
        }
    }
}

/// A picture that is wrapped around something.
pub(super) fn wrapped(texture: &TextureData) -> Image {
    image(texture, ImageAddressMode::Repeat, ALL_MIPS)
}
