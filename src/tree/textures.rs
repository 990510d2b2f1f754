//! The textures of a species: its bark, and the sprays, polygons or ellipsoids of its crown.

use super::{
    bark::{BarkTextures, bark_textures},
    crown::{gardner, impressionist},
    ellipsoid,
    generator::Growth,
    leaf::{LeafKind, LeafTextures, bare_spray_texture, leaf_textures},
    species::Species,
};
use crate::texture::TextureData;

/// All textures of a species.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SpeciesTextures {
    /// Of trunk and branches.
    pub bark: BarkTextures,
    /// Colour and mask of what the crown is made of.
    pub foliage: TextureData,
    /// Its normals, and in alpha its share of the species' translucency; crowns of polygons and ellipsoids have none.
    pub foliage_normal: Option<TextureData>,
    /// The same sprays when their leaves have fallen: colour and mask of their twigs. None where leaves stay, or are no sprays.
    pub bare_foliage: Option<TextureData>,
}

/// Renders the textures of a species. It takes some 50 ms: call it in the background.
#[must_use]
pub fn species_textures(species: &Species) -> SpeciesTextures {
    let (foliage, foliage_normal) = match &species.growth {
        Growth::Impressionist(crown) => (impressionist::texture(crown, species.seed), None),
        Growth::Gardner(crown) => (gardner::texture(crown, species.seed), None),
        Growth::ReevesBlau(_) | Growth::Oak(_) | Growth::Fir(_) | Growth::AonoKunii(_) => match &species.foliage.kind {
            LeafKind::Sprays => {
                let LeafTextures { base_colour, normal } =
                    leaf_textures(&species.foliage, &species.wood.green, species.seed);
                (base_colour, Some(normal))
            }
            LeafKind::Ellipsoids(leaves) => (ellipsoid::texture(&leaves.surface, species.seed), None),
        },
    };
    let is_bare_in_winter = foliage_normal.is_some() && !species.phenology.evergreen;
    let bare_foliage =
        is_bare_in_winter.then(|| bare_spray_texture(&species.foliage, &species.wood.green, species.seed));
    SpeciesTextures { bark: bark_textures(&species.wood.bark, species.seed), foliage, foliage_normal, bare_foliage }
}

impl SpeciesTextures {
    /// Mean colour of the foliage, sRGB 0 to 1.
    #[must_use]
    pub fn foliage_colour(&self) -> [f32; 3] {
        let texel = self.foliage.mips.last().and_then(|mip| mip.first_chunk::<3>()).copied().unwrap_or([128; 3]);
        texel.map(|byte| f32::from(byte) / 255.0)
    }
}
