//! The materials of a species: bark, foliage, and those of its lower LOD levels.

use super::{
    images::SpeciesImages,
    lod_meshes::MaterialKind,
    tree_material::{GreenWoodUniform, LeafUniform, SeasonUniform, SwayExtension, SwayMaterial},
};
use crate::{
    render::{buffers::sway_buffers::SwayBuffers, capabilities::RenderCapabilities, lighting::TreeLights},
    tree::Species,
};
use bevy::{
    asset::RenderAssetUsages,
    ecs::system::SystemParam,
    prelude::*,
    render::render_resource::{Extent3d, TextureDimension, TextureFormat},
};

/// The material of a mesh: swaying, or still where a tree cannot be posed.
#[derive(Clone)]
pub(crate) struct MeshMaterials {
    pub swaying: Option<Handle<SwayMaterial>>,
    pub still: Handle<StandardMaterial>,
}

/// The materials that all trees of a species share.
pub(crate) struct SpeciesMaterials {
    bark: MeshMaterials,
    fading_bark: MeshMaterials,
    foliage: MeshMaterials,
    bare_foliage: Option<MeshMaterials>,
    /// Materials of single variants read the same tables.
    extension: SwayExtension,
    translucency: f32,
}

/// Makes materials.
#[derive(SystemParam)]
pub(crate) struct MaterialAssets<'w> {
    images: ResMut<'w, Assets<Image>>,
    swaying: ResMut<'w, Assets<SwayMaterial>>,
    still: ResMut<'w, Assets<StandardMaterial>>,
    buffers: Res<'w, SwayBuffers>,
    capabilities: Res<'w, RenderCapabilities>,
    lights: Res<'w, TreeLights>,
}

impl MaterialAssets<'_> {
    /// The materials of a species with these textures.
    pub fn add_species(&mut self, species: &Species, images: SpeciesImages) -> SpeciesMaterials {
        let extension = SwayExtension {
            poses: self.buffers.poses.clone(),
            beams: self.buffers.beams.clone(),
            trees: self.buffers.trees.clone(),
            frame: self.buffers.frame.clone(),
            leaf: LeafUniform::new(&species.foliage.response, species.has_ellipsoids()),
            season: SeasonUniform::new(&species.phenology, images.foliage_colour),
            green_wood: GreenWoodUniform::new(&species.wood),
            lights: *self.lights,
        };
        let surface = self.images.add(images.bark_surface);
        let bark = StandardMaterial {
            base_color_texture: Some(self.images.add(images.bark)),
            normal_map_texture: Some(self.images.add(images.bark_normal)),
            occlusion_texture: Some(surface.clone()),
            metallic_roughness_texture: Some(surface),
            perceptual_roughness: 1.0,
            reflectance: 0.2,
            ..default()
        };
        let fading_bark = StandardMaterial { alpha_mode: AlphaMode::Mask(0.5), ..bark.clone() };
        let foliage = StandardMaterial {
            base_color_texture: Some(self.images.add(images.foliage)),
            normal_map_texture: images.foliage_normal.map(|normal| self.images.add(normal)),
            ..leaf_material(species.foliage.translucency)
        };
        let bare_foliage = images.bare_foliage.map(|twigs| {
            let twigs = StandardMaterial { base_color_texture: Some(self.images.add(twigs)), ..leaf_material(0.0) };
            self.add(twigs, &SwayExtension { leaf: extension.leaf.bare(), ..extension.clone() })
        });
        SpeciesMaterials {
            bare_foliage,
            bark: self.add(bark, &extension),
            fading_bark: self.add(fading_bark, &extension),
            foliage: self.add(foliage, &extension),
            extension,
            translucency: species.foliage.translucency,
        }
    }

    /// The material of a mesh.
    pub fn of_mesh(&mut self, kind: MaterialKind, species: &SpeciesMaterials) -> MeshMaterials {
        match kind {
            MaterialKind::Bark => species.bark.clone(),
            MaterialKind::FadingBark => species.fading_bark.clone(),
            MaterialKind::Foliage => species.foliage.clone(),
            MaterialKind::Envelope(colour) => {
                let colour = Some(self.images.add(*colour));
                let material = StandardMaterial { base_color_texture: colour, ..leaf_material(species.translucency) };
                self.add(material, &species.extension)
            }
            MaterialKind::TwoColours(colours) => {
                let material = self.two_colours(colours);
                self.add(material, &species.extension)
            }
        }
    }

    /// What takes the place of a mesh's material while the tree is bare.
    pub fn when_bare(&self, kind: &MaterialKind, species: &SpeciesMaterials) -> Option<MeshMaterials> {
        species.bare_foliage.clone().filter(|_| matches!(kind, MaterialKind::Foliage))
    }

    fn add(&mut self, base: StandardMaterial, extension: &SwayExtension) -> MeshMaterials {
        let swaying = SwayMaterial { base: base.clone(), extension: extension.clone() };
        MeshMaterials {
            swaying: self.capabilities.sways.then(|| self.swaying.add(swaying)),
            still: self.still.add(base),
        }
    }

    /// A texture of two texels: linear colours of the trunk and of the crown.
    fn two_colours(&mut self, colours: [[f32; 3]; 2]) -> StandardMaterial {
        let texel = |colour: [f32; 3]| Color::linear_rgb(colour[0], colour[1], colour[2]).to_srgba().to_u8_array();
        let colours = Image::new(
            Extent3d { width: 2, height: 1, depth_or_array_layers: 1 },
            TextureDimension::D2,
            colours.map(texel).concat(),
            TextureFormat::Rgba8UnormSrgb,
            RenderAssetUsages::RENDER_WORLD,
        );
        StandardMaterial { base_color_texture: Some(self.images.add(colours)), ..leaf_material(0.0) }
    }
}

/// What the leaves of all species have in common.
fn leaf_material(translucency: f32) -> StandardMaterial {
    StandardMaterial {
        alpha_mode: AlphaMode::Mask(0.5),
        // Normals lean out of the crown for soft shading: flipping them for the back of a spray would spoil that.
        double_sided: false,
        cull_mode: None,
        perceptual_roughness: 0.8,
        // More gives white rims against the light.
        reflectance: 0.08,
        diffuse_transmission: translucency,
        ..default()
    }
}
