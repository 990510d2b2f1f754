//! The textures of a species as Bevy images: megabytes, laid out in the background.

use crate::{
    render::texture_image::{ALL_MIPS, Channels, device_image},
    tree::{Species, bark::BarkTextures, textures::SpeciesTextures},
};
use bevy::{image::ImageAddressMode, prelude::*};

/// Coarsest mip of masked foliage that is used: beyond its 16 x 16 texels a spray is a blot.
const FOLIAGE_LOD_LIMIT: f32 = 5.0;
/// The same of ellipsoids. All their mips have the same alphas, but in coarser ones no two neighbours have the same, and what is interpolated
/// between them fills the gaps.
const ELLIPSOID_LOD_LIMIT: f32 = 3.0;

/// All textures of a species.
pub(crate) struct SpeciesImages {
    pub bark: Image,
    pub bark_normal: Image,
    pub bark_surface: Image,
    pub foliage: Image,
    pub foliage_normal: Option<Image>,
    pub bare_foliage: Option<Image>,
    /// Mean colour of the foliage, sRGB 0 to 1.
    pub foliage_colour: [f32; 3],
}

impl SpeciesImages {
    /// With `compresses`, in blocks, where the device reads these: a fifth as many bytes.
    pub fn new(species: &Species, textures: &SpeciesTextures, compresses: bool) -> Self {
        let BarkTextures { base_colour, normal, surface } = &textures.bark;
        let repeating =
            |texture, channels| device_image(texture, channels, compresses, ImageAddressMode::Repeat, ALL_MIPS);
        let coarsest = if species.has_ellipsoids() { ELLIPSOID_LOD_LIMIT } else { FOLIAGE_LOD_LIMIT };
        let masked =
            |texture| device_image(texture, Channels::Rgba, compresses, ImageAddressMode::ClampToEdge, coarsest);
        Self {
            bark: repeating(base_colour, Channels::Rgb),
            bark_normal: repeating(normal, Channels::Normal),
            bark_surface: repeating(surface, Channels::Rgb),
            foliage: masked(&textures.foliage),
            foliage_normal: textures.foliage_normal.as_ref().map(masked),
            bare_foliage: textures.bare_foliage.as_ref().map(masked),
            foliage_colour: textures.foliage_colour(),
        }
    }
}
