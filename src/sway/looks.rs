//! What a species looks like to the renderer: meshes, textures, materials and beam rows, prepared off the frame.

use super::{
    draw::{DrawPath, SpeciesDressed, Wardrobe},
    material::{
        ATTRIBUTE_LEAF_ANCHOR, ATTRIBUTE_LEAF_AXIS, ATTRIBUTE_SWAY, LeafUniform, SeasonUniform, SwayExtension,
        SwayMaterial,
    },
    rows::BeamRow,
    stand::Stand,
    upload::StandBuffers,
};
use crate::tree::{
    BakedSpecies, Grove, Species, SpeciesBaked, TreeModel,
    bark::{BarkTextures, bark_textures},
    leaf_mesh::LeafVertices,
    leaf_texture::leaf_texture,
    mesh::WoodVertices,
    texture::TextureData,
};
use bevy::{
    asset::RenderAssetUsages,
    camera::primitives::Aabb,
    image::{ImageAddressMode, ImageFilterMode, ImageSampler, ImageSamplerDescriptor},
    mesh::{Indices, PrimitiveTopology},
    prelude::*,
    render::render_resource::{Extent3d, TextureDimension, TextureFormat},
    tasks::{AsyncComputeTaskPool, Task, block_on, poll_once},
};

/// A species, ready to be put on trees.
pub(super) struct SpeciesLooks {
    pub bark: Outfit,
    pub foliage: Outfit,
    pub variants: Vec<VariantLook>,
}

/// The material of a draw: swaying, or still where a tree cannot be posed.
pub(super) struct Outfit {
    pub swaying: Option<Handle<SwayMaterial>>,
    pub still: Handle<StandardMaterial>,
}

/// One variant of a species.
pub(super) struct VariantLook {
    pub model: AssetId<TreeModel>,
    pub wood: Handle<Mesh>,
    pub leaves: Option<Handle<Mesh>>,
    pub bounds: Aabb,
}

/// What is prepared in the background.
struct Cut {
    bark: BarkTextures,
    leaf: TextureData,
    meshes: Vec<(Mesh, Option<Mesh>)>,
}

/// Looks that are being prepared.
#[derive(Resource, Default)]
pub(super) struct Tailoring {
    tasks: Vec<(AssetId<Species>, u64, Task<Cut>)>,
}

/// Starts preparing the looks of species that were baked, and forgets those that are gone.
pub(super) fn start_tailoring(
    mut baked: MessageReader<SpeciesBaked>,
    mut events: MessageReader<AssetEvent<Species>>,
    grove: Res<Grove>,
    models: Res<Assets<TreeModel>>,
    mut tailoring: ResMut<Tailoring>,
    mut wardrobe: ResMut<Wardrobe>,
    mut stand: ResMut<Stand>,
) {
    for &SpeciesBaked(id) in baked.read() {
        let Some(entry) = grove.get(id) else { continue };
        let species = entry.species.clone();
        let variants: Vec<TreeModel> = entry.models.iter().filter_map(|model| models.get(model).cloned()).collect();
        tailoring.tasks.retain(|(other, ..)| *other != id);
        let task = AsyncComputeTaskPool::get().spawn(async move { cut(&species, variants) });
        tailoring.tasks.push((id, entry.generation, task));
    }
    for event in events.read() {
        if let AssetEvent::Removed { id } = event {
            tailoring.tasks.retain(|(other, ..)| other != id);
            if let Some(looks) = wardrobe.looks.remove(id) {
                looks.variants.iter().for_each(|variant| stand.remove_model(variant.model));
            }
        }
    }
}

fn cut(species: &Species, variants: Vec<TreeModel>) -> Cut {
    Cut {
        bark: bark_textures(&species.wood.bark, species.seed),
        leaf: leaf_texture(&species.foliage, species.seed),
        meshes: variants.into_iter().map(|model| (wood_mesh(model.wood), leaf_mesh(model.leaves))).collect(),
    }
}

/// Makes assets of looks that are prepared.
#[derive(bevy::ecs::system::SystemParam)]
pub(super) struct Atelier<'w> {
    meshes: ResMut<'w, Assets<Mesh>>,
    images: ResMut<'w, Assets<Image>>,
    swaying: ResMut<'w, Assets<SwayMaterial>>,
    still: ResMut<'w, Assets<StandardMaterial>>,
    models: Res<'w, Assets<TreeModel>>,
    shared: Res<'w, StandBuffers>,
    stand: ResMut<'w, Stand>,
    path: Res<'w, DrawPath>,
}

/// Takes over looks that are prepared.
pub(super) fn finish_tailoring(
    mut tailoring: ResMut<Tailoring>,
    grove: Res<Grove>,
    mut wardrobe: ResMut<Wardrobe>,
    mut atelier: Atelier,
    mut dressed: MessageWriter<SpeciesDressed>,
) {
    if tailoring.tasks.is_empty() {
        return;
    }
    tailoring.tasks.retain_mut(|(id, generation, task)| {
        let Some(cut) = block_on(poll_once(task)) else { return true };
        if let Some(entry) = grove.get(*id).filter(|entry| entry.generation == *generation) {
            let looks = atelier.sew(entry, cut);
            if let Some(old) = wardrobe.looks.insert(*id, looks) {
                old.variants.iter().for_each(|variant| atelier.stand.remove_model(variant.model));
            }
            dressed.write(SpeciesDressed(*id));
        }
        false
    });
}

impl Atelier<'_> {
    fn sew(&mut self, entry: &BakedSpecies, cut: Cut) -> SpeciesLooks {
        let mut variants = Vec::new();
        for (handle, (wood, leaves)) in entry.models.iter().zip(cut.meshes) {
            let Some(model) = self.models.get(handle) else { continue };
            self.stand.add_model(handle.id(), model.beams.iter().map(BeamRow::from));
            variants.push(VariantLook {
                model: handle.id(),
                wood: self.meshes.add(wood),
                leaves: leaves.map(|leaves| self.meshes.add(leaves)),
                bounds: Aabb::from_min_max(model.bounds.min, model.bounds.max),
            });
        }
        let extension = SwayExtension {
            poses: self.shared.poses.clone(),
            beams: self.shared.beams.clone(),
            trees: self.shared.trees.clone(),
            frame: self.shared.frame.clone(),
            leaf: LeafUniform::from(&entry.species.foliage.response),
            season: SeasonUniform::new(&entry.species.phenology, entry.species.foliage.leaf.colour),
        };
        let bark = self.bark_material(&cut.bark);
        let foliage = self.foliage_material(&entry.species, &cut.leaf);
        SpeciesLooks { bark: self.outfit(bark, extension.clone()), foliage: self.outfit(foliage, extension), variants }
    }

    fn outfit(&mut self, base: StandardMaterial, extension: SwayExtension) -> Outfit {
        let swaying = self.path.sways.then(|| self.swaying.add(SwayMaterial { base: base.clone(), extension }));
        Outfit { swaying, still: self.still.add(base) }
    }

    fn bark_material(&mut self, textures: &BarkTextures) -> StandardMaterial {
        StandardMaterial {
            base_color_texture: Some(self.images.add(image(&textures.base_colour, ImageAddressMode::Repeat))),
            normal_map_texture: Some(self.images.add(image(&textures.normal, ImageAddressMode::Repeat))),
            perceptual_roughness: 0.92,
            reflectance: 0.2,
            ..default()
        }
    }

    fn foliage_material(&mut self, species: &Species, texture: &TextureData) -> StandardMaterial {
        StandardMaterial {
            base_color_texture: Some(self.images.add(image(texture, ImageAddressMode::ClampToEdge))),
            alpha_mode: AlphaMode::Mask(0.5),
            // Normals lean out of the crown for soft shading: flipping them for the back of a card would spoil that.
            double_sided: false,
            cull_mode: None,
            perceptual_roughness: 0.8,
            // More gives white rims against the light.
            reflectance: 0.08,
            diffuse_transmission: species.foliage.translucency,
            ..default()
        }
    }
}

/// Coarsest mip of masked foliage that is used: beyond it a spray is a few texels, between which no alpha passes the mask,
/// and distant crowns would go bare.
const FOLIAGE_LOD_LIMIT: f32 = 3.0;

fn image(texture: &TextureData, address_mode: ImageAddressMode) -> Image {
    let format = if texture.srgb { TextureFormat::Rgba8UnormSrgb } else { TextureFormat::Rgba8Unorm };
    let size = Extent3d { width: texture.width, height: texture.height, depth_or_array_layers: 1 };
    let mut image = Image::new_uninit(size, TextureDimension::D2, format, RenderAssetUsages::RENDER_WORLD);
    image.texture_descriptor.mip_level_count = texture.mips.len() as u32;
    image.data = Some(texture.mips.concat());
    image.sampler = ImageSampler::Descriptor(ImageSamplerDescriptor {
        address_mode_u: address_mode,
        address_mode_v: address_mode,
        mag_filter: ImageFilterMode::Linear,
        min_filter: ImageFilterMode::Linear,
        mipmap_filter: ImageFilterMode::Linear,
        // Only foliage is clamped at its edges, and only foliage is masked.
        lod_max_clamp: if address_mode == ImageAddressMode::ClampToEdge { FOLIAGE_LOD_LIMIT } else { 32.0 },
        ..default()
    });
    image
}

fn wood_mesh(wood: WoodVertices) -> Mesh {
    Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::RENDER_WORLD)
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, wood.positions)
        .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, wood.normals)
        .with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, wood.uvs)
        .with_inserted_attribute(ATTRIBUTE_SWAY, wood.sway)
        .with_inserted_indices(Indices::U32(wood.indices))
}

fn leaf_mesh(leaves: LeafVertices) -> Option<Mesh> {
    if leaves.indices.is_empty() {
        return None;
    }
    let mesh = Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::RENDER_WORLD)
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, leaves.positions)
        .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, leaves.normals)
        .with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, leaves.uvs)
        .with_inserted_attribute(ATTRIBUTE_SWAY, leaves.sway)
        .with_inserted_attribute(ATTRIBUTE_LEAF_AXIS, leaves.axis)
        .with_inserted_attribute(ATTRIBUTE_LEAF_ANCHOR, leaves.anchor)
        .with_inserted_indices(Indices::U32(leaves.indices));
    Some(mesh)
}
