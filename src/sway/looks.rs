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
use crate::shading::{ALL_MIPS, image};
use crate::tree::{
    Grove, Species, SpeciesBaked, TreeModel,
    bark::BarkTextures,
    growth::Growth,
    leaf_mesh::LeafVertices,
    mesh::WoodVertices,
    painting::{SpeciesTextures, paint},
};
use bevy::{
    asset::RenderAssetUsages,
    camera::primitives::Aabb,
    image::ImageAddressMode,
    mesh::{Indices, PrimitiveTopology},
    platform::collections::HashMap,
    prelude::*,
    tasks::{AsyncComputeTaskPool, Task, block_on, poll_once},
};

/// A species, ready to be put on trees.
pub(super) struct SpeciesLooks {
    /// Which of the species' generations bark and foliage are of.
    generation: u64,
    pub bark: Outfit,
    pub foliage: Outfit,
    pub variants: HashMap<AssetId<TreeModel>, VariantLook>,
}

/// The material of a draw: swaying, or still where a tree cannot be posed.
pub(super) struct Outfit {
    pub swaying: Option<Handle<SwayMaterial>>,
    pub still: Handle<StandardMaterial>,
}

/// One variant of a species at one age.
pub(super) struct VariantLook {
    step: i32,
    pub wood: Handle<Mesh>,
    pub leaves: Option<Handle<Mesh>>,
    pub bounds: Aabb,
}

/// What is prepared in the background.
struct Cut {
    /// Painted once for all ages.
    textures: Option<SpeciesTextures>,
    meshes: Vec<(Mesh, Option<Mesh>)>,
}

struct Tailored {
    species: AssetId<Species>,
    step: i32,
    generation: u64,
    task: Task<Cut>,
}

/// Looks that are being prepared.
#[derive(Resource, Default)]
pub(super) struct Tailoring {
    tasks: Vec<Tailored>,
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
    for &SpeciesBaked { species: id, step } in baked.read() {
        let Some(entry) = grove.get(id) else { continue };
        let Some(stage) = entry.stages.get(&step) else { continue };
        let species = entry.species.clone();
        let generation = stage.generation;
        let variants: Vec<TreeModel> = stage.models.iter().filter_map(|model| models.get(model).cloned()).collect();
        tailoring.tasks.retain(|other| (other.species, other.step) != (id, step));
        let painted = wardrobe.looks.get(&id).is_some_and(|looks| looks.generation == generation)
            || tailoring.tasks.iter().any(|other| (other.species, other.generation) == (id, generation));
        let task = AsyncComputeTaskPool::get().spawn(async move { cut(&species, !painted, variants) });
        tailoring.tasks.push(Tailored { species: id, step, generation, task });
    }
    for event in events.read() {
        if let AssetEvent::Removed { id } = event {
            tailoring.tasks.retain(|other| other.species != *id);
            if let Some(looks) = wardrobe.looks.remove(id) {
                looks.variants.into_keys().for_each(|model| stand.remove_model(model));
            }
        }
    }
}

fn cut(species: &Species, painting: bool, variants: Vec<TreeModel>) -> Cut {
    Cut {
        textures: painting.then(|| paint(species)),
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
    // In the order in which they were begun: the first of a species brings the textures for all.
    let mut waiting = Vec::new();
    for mut tailored in std::mem::take(&mut tailoring.tasks) {
        let Tailored { species, step, generation, .. } = tailored;
        let first_is_missing = waiting.iter().any(|other: &Tailored| other.species == species);
        let cut = if first_is_missing { None } else { block_on(poll_once(&mut tailored.task)) };
        let Some(cut) = cut else {
            waiting.push(tailored);
            continue;
        };
        let stage = grove.get(species).and_then(|entry| Some((entry, entry.stages.get(&step)?)));
        let Some((entry, stage)) = stage.filter(|(_, stage)| stage.generation == generation) else { continue };
        if let Some(textures) = cut.textures {
            let looks = atelier.outfits(&entry.species, generation, &textures);
            let old = wardrobe.looks.insert(species, looks);
            if let (Some(old), Some(looks)) = (old, wardrobe.looks.get_mut(&species)) {
                looks.variants = old.variants;
            }
        }
        let Some(looks) = wardrobe.looks.get_mut(&species) else { continue };
        atelier.sew(looks, step, &stage.models, cut.meshes);
        dressed.write(SpeciesDressed(species));
    }
    tailoring.tasks = waiting;
}

impl Atelier<'_> {
    /// Makes the meshes of one age, in place of those that were there.
    fn sew(
        &mut self,
        looks: &mut SpeciesLooks,
        step: i32,
        models: &[Handle<TreeModel>],
        meshes: Vec<(Mesh, Option<Mesh>)>,
    ) {
        looks.variants.retain(|model, variant| {
            let stays = variant.step != step;
            if !stays {
                self.stand.remove_model(*model);
            }
            stays
        });
        for (handle, (wood, leaves)) in models.iter().zip(meshes) {
            let Some(model) = self.models.get(handle) else { continue };
            self.stand.add_model(handle.id(), model.beams.iter().map(BeamRow::from));
            let variant = VariantLook {
                step,
                wood: self.meshes.add(wood),
                leaves: leaves.map(|leaves| self.meshes.add(leaves)),
                bounds: Aabb::from_min_max(model.bounds.min, model.bounds.max),
            };
            looks.variants.insert(handle.id(), variant);
        }
    }

    fn outfits(&mut self, species: &Species, generation: u64, textures: &SpeciesTextures) -> SpeciesLooks {
        let extension = SwayExtension {
            poses: self.shared.poses.clone(),
            beams: self.shared.beams.clone(),
            trees: self.shared.trees.clone(),
            frame: self.shared.frame.clone(),
            leaf: LeafUniform::new(&species.foliage.response, matches!(species.growth, Growth::Gardner(_))),
            season: SeasonUniform::new(&species.phenology, textures.foliage_colour()),
        };
        let bark = self.bark_material(&textures.bark);
        let foliage = self.foliage_material(species, textures);
        SpeciesLooks {
            generation,
            bark: self.outfit(bark, extension.clone()),
            foliage: self.outfit(foliage, extension),
            variants: HashMap::default(),
        }
    }

    fn outfit(&mut self, base: StandardMaterial, extension: SwayExtension) -> Outfit {
        let swaying = self.path.sways.then(|| self.swaying.add(SwayMaterial { base: base.clone(), extension }));
        Outfit { swaying, still: self.still.add(base) }
    }

    fn bark_material(&mut self, textures: &BarkTextures) -> StandardMaterial {
        let surface = self.images.add(image(&textures.surface, ImageAddressMode::Repeat, ALL_MIPS));
        StandardMaterial {
            base_color_texture: Some(self.images.add(image(&textures.base_colour, ImageAddressMode::Repeat, ALL_MIPS))),
            normal_map_texture: Some(self.images.add(image(&textures.normal, ImageAddressMode::Repeat, ALL_MIPS))),
            occlusion_texture: Some(surface.clone()),
            metallic_roughness_texture: Some(surface),
            perceptual_roughness: 1.0,
            reflectance: 0.2,
            ..default()
        }
    }

    fn foliage_material(&mut self, species: &Species, textures: &SpeciesTextures) -> StandardMaterial {
        let normals = textures.foliage_normal.as_ref();
        let normals =
            normals.map(|normals| self.images.add(image(normals, ImageAddressMode::ClampToEdge, FOLIAGE_LOD_LIMIT)));
        StandardMaterial {
            base_color_texture: Some(self.images.add(image(
                &textures.foliage,
                ImageAddressMode::ClampToEdge,
                FOLIAGE_LOD_LIMIT,
            ))),
            normal_map_texture: normals,
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
