//! The materials of a species: bark, foliage, and what its lower levels wear.

use super::{
    cut::Cloth,
    draw::DrawPath,
    lighting::TreeLights,
    material::{LeafUniform, SeasonUniform, SwayExtension, SwayMaterial},
    painted::Painted,
    upload::StandBuffers,
};
use crate::tree::{Species, growth::Growth};
use bevy::{
    asset::RenderAssetUsages,
    ecs::system::SystemParam,
    prelude::*,
    render::render_resource::{Extent3d, TextureDimension, TextureFormat},
};

/// The material of a draw: swaying, or still where a tree cannot be posed.
#[derive(Clone)]
pub(super) struct Outfit {
    pub swaying: Option<Handle<SwayMaterial>>,
    pub still: Handle<StandardMaterial>,
}

/// What all trees of a species wear.
pub(super) struct SpeciesOutfits {
    bark: Outfit,
    fading_bark: Outfit,
    foliage: Outfit,
    /// What else is made for it reads the same tables.
    extension: SwayExtension,
    translucency: f32,
}

/// Makes materials.
#[derive(SystemParam)]
pub(super) struct Dyer<'w> {
    images: ResMut<'w, Assets<Image>>,
    swaying: ResMut<'w, Assets<SwayMaterial>>,
    still: ResMut<'w, Assets<StandardMaterial>>,
    shared: Res<'w, StandBuffers>,
    path: Res<'w, DrawPath>,
    lights: Res<'w, TreeLights>,
}

impl Dyer<'_> {
    /// What a species wears that is painted like this.
    pub fn outfits(&mut self, species: &Species, painted: Painted) -> SpeciesOutfits {
        let extension = SwayExtension {
            poses: self.shared.poses.clone(),
            beams: self.shared.beams.clone(),
            trees: self.shared.trees.clone(),
            frame: self.shared.frame.clone(),
            leaf: LeafUniform::new(&species.foliage.response, matches!(species.growth, Growth::Gardner(_))),
            season: SeasonUniform::new(&species.phenology, painted.foliage_colour),
            lights: *self.lights,
        };
        let surface = self.images.add(painted.bark_surface);
        let bark = StandardMaterial {
            base_color_texture: Some(self.images.add(painted.bark)),
            normal_map_texture: Some(self.images.add(painted.bark_normal)),
            occlusion_texture: Some(surface.clone()),
            metallic_roughness_texture: Some(surface),
            perceptual_roughness: 1.0,
            reflectance: 0.2,
            ..default()
        };
        let fading_bark = StandardMaterial { alpha_mode: AlphaMode::Mask(0.5), ..bark.clone() };
        let foliage = StandardMaterial {
            base_color_texture: Some(self.images.add(painted.foliage)),
            normal_map_texture: painted.foliage_normal.map(|normal| self.images.add(normal)),
            ..leafy(species.foliage.translucency)
        };
        SpeciesOutfits {
            bark: self.outfit(bark, &extension),
            fading_bark: self.outfit(fading_bark, &extension),
            foliage: self.outfit(foliage, &extension),
            extension,
            translucency: species.foliage.translucency,
        }
    }

    /// The outfit of a piece.
    pub fn of(&mut self, cloth: Cloth, outfits: &SpeciesOutfits) -> Outfit {
        match cloth {
            Cloth::Bark => outfits.bark.clone(),
            Cloth::FadingBark => outfits.fading_bark.clone(),
            Cloth::Foliage => outfits.foliage.clone(),
            Cloth::Envelope(colour) => {
                let colour = Some(self.images.add(*colour));
                let material = StandardMaterial { base_color_texture: colour, ..leafy(outfits.translucency) };
                self.outfit(material, &outfits.extension)
            }
            Cloth::Plain(colours) => {
                let material = self.plain(colours);
                self.outfit(material, &outfits.extension)
            }
        }
    }

    fn outfit(&mut self, base: StandardMaterial, extension: &SwayExtension) -> Outfit {
        let swaying = SwayMaterial { base: base.clone(), extension: extension.clone() };
        Outfit { swaying: self.path.sways.then(|| self.swaying.add(swaying)), still: self.still.add(base) }
    }

    /// Two texels, linear: of the trunk and of the crown.
    fn plain(&mut self, colours: [[f32; 3]; 2]) -> StandardMaterial {
        let texel = |colour: [f32; 3]| Color::linear_rgb(colour[0], colour[1], colour[2]).to_srgba().to_u8_array();
        let colours = Image::new(
            Extent3d { width: 2, height: 1, depth_or_array_layers: 1 },
            TextureDimension::D2,
            colours.map(texel).concat(),
            TextureFormat::Rgba8UnormSrgb,
            RenderAssetUsages::RENDER_WORLD,
        );
        StandardMaterial { base_color_texture: Some(self.images.add(colours)), ..leafy(0.0) }
    }
}

/// What all crowns have in common.
fn leafy(translucency: f32) -> StandardMaterial {
    StandardMaterial {
        alpha_mode: AlphaMode::Mask(0.5),
        // Normals lean out of the crown for soft shading: flipping them for the back of a card would spoil that.
        double_sided: false,
        cull_mode: None,
        perceptual_roughness: 0.8,
        // More gives white rims against the light.
        reflectance: 0.08,
        diffuse_transmission: translucency,
        ..default()
    }
}
