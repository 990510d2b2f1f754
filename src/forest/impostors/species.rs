//! The impostor atlas of each species that grows in a forest, baked in the background.

use crate::{
    background::{Work, spawn_work},
    forest::{cells::ForestCells, tree_impostors::ImpostorSize},
    lod::{ImpostorAtlas, ImpostorSettings, ImpostorSway, Scene},
    render::{
        RenderCapabilities, SwayBuffers,
        impostors::{
            material::{AtlasImages, ImpostorMaterial, impostor_material},
            mesh::MAX_VARIANTS,
            near_mask::NearMasks,
        },
        lighting::{LitAsTrees, TreeLights},
        settings::ActiveLevelOfDetail,
    },
    tree::{Species, TreeModel, bake_variants, growth::age::Age, no_longer_used, textures::species_textures},
};
use bevy::{
    asset::LoadState,
    platform::collections::{HashMap, HashSet},
    prelude::*,
    tasks::{block_on, poll_once},
};

/// The species of which there are impostors.
#[derive(Resource, Default)]
pub(super) struct ImpostorSpeciesLibrary {
    species: HashMap<AssetId<Species>, ImpostorSpecies>,
    baking: Vec<(AssetId<Species>, Work<Baked>)>,
    /// Those that have no atlas, since its worker has panicked.
    failed: HashSet<AssetId<Species>>,
    /// What they are baked with.
    settings: ImpostorSettings,
    /// Whether the device reads compressed textures.
    compresses_textures: bool,
}

/// The impostors of a species.
pub(super) struct ImpostorSpecies {
    pub material: Handle<ImpostorMaterial>,
    /// How it ages: the atlas shows a mature tree, which is of size 1.
    pub age: Age,
    /// How far the mature tree reaches from its foot, m.
    pub reach_m: f32,
    /// Height of the mature tree's impostor, m.
    pub height_m: f32,
    /// How many variants the species has, and how many the atlas shows: the first ones.
    pub variants: u32,
    pub shown_variants: u32,
}

struct Baked {
    species: Species,
    atlas: AtlasImages,
}

impl ImpostorSpeciesLibrary {
    pub fn get(&self, id: AssetId<Species>) -> Option<&ImpostorSpecies> {
        self.species.get(&id)
    }

    /// How large its impostors are, where it has any.
    pub fn size_of(&self, id: AssetId<Species>) -> Option<ImpostorSize> {
        self.get(id).map(|species| ImpostorSize { age: species.age, mature_m: species.height_m })
    }

    /// Whether its atlas is baked, or cannot be, or the species cannot be loaded.
    pub fn is_settled(&self, species: &Handle<Species>, assets: &AssetServer) -> bool {
        self.species.contains_key(&species.id())
            || self.failed.contains(&species.id())
            || matches!(assets.get_load_state(species), Some(LoadState::Failed(_)))
    }

    /// Whether its atlas is baked or being baked, or cannot be.
    fn is_known(&self, id: AssetId<Species>) -> bool {
        self.species.contains_key(&id) || self.failed.contains(&id) || self.baking.iter().any(|(other, _)| *other == id)
    }

    fn remove(&mut self, id: AssetId<Species>) {
        self.species.remove(&id);
        self.failed.remove(&id);
        self.baking.retain(|(other, _)| *other != id);
    }

    /// The atlases have gone, with their device.
    pub fn forget_all(&mut self) {
        self.species.clear();
    }

    fn bake(&mut self, id: AssetId<Species>, species: &Species) {
        let (species, settings, compresses) = (species.clone(), self.settings, self.compresses_textures);
        self.baking.retain(|(other, _)| *other != id);
        self.failed.remove(&id);
        self.baking.push((id, spawn_work(move || bake(species, &settings, compresses))));
    }

    /// Takes settings over. Returns the species that have to be baked anew with them.
    fn set(&mut self, settings: ImpostorSettings) -> Vec<AssetId<Species>> {
        if std::mem::replace(&mut self.settings, settings) == settings {
            return Vec::new();
        }
        let baking = self.baking.iter().map(|(id, _)| *id);
        let mut known: Vec<AssetId<Species>> = self.species.keys().copied().chain(baking).collect();
        known.sort_unstable();
        known.dedup();
        known
    }
}

fn bake(species: Species, settings: &ImpostorSettings, compresses_textures: bool) -> Baked {
    let textures = species_textures(&species);
    let models: Vec<TreeModel> =
        bake_variants(&species, species.age.mature_years).take(MAX_VARIANTS as usize).collect();
    let scenes: Vec<Scene> = models.iter().map(|model| Scene::new(&species, model, &textures)).collect();
    let atlas = ImpostorAtlas::bake(&scenes, settings);
    let leans = scenes.iter().zip(&models).map(|(scene, model)| ImpostorSway::of(scene, model)).collect();
    Baked { atlas: AtlasImages::new(&atlas, leans, textures.foliage_colour(), compresses_textures), species }
}

/// Starts baking the atlas of species that have come or were changed, and of all if the settings were; takes over those that are baked.
pub(super) fn bake_impostor_species(
    mut library: ResMut<ImpostorSpeciesLibrary>,
    mut images: ResMut<Assets<Image>>,
    mut materials: ResMut<Assets<ImpostorMaterial>>,
    mut events: MessageReader<AssetEvent<Species>>,
    buffers: Res<SwayBuffers>,
    capabilities: Res<RenderCapabilities>,
    lights: Res<TreeLights>,
    near_masks: Res<NearMasks>,
    detail: Res<ActiveLevelOfDetail>,
    species: Res<Assets<Species>>,
    forests: Query<&ForestCells>,
) {
    if !capabilities.sways {
        // Without storage buffers not even the layout of their material can be made.
        return;
    }
    library.compresses_textures = capabilities.compresses_textures;
    for id in library.set(detail.0.bake.impostor) {
        if let Some(species) = species.get(id).filter(|species| species.validate().is_ok()) {
            library.bake(id, species);
        }
    }
    for event in events.read() {
        match event {
            // One that is being baked is baked anew: its atlas would be that of the species before.
            AssetEvent::Modified { id } if library.is_known(*id) => {
                if let Some(species) = species.get(*id).filter(|species| species.validate().is_ok()) {
                    library.bake(*id, species);
                }
            }
            _ => no_longer_used(event).into_iter().for_each(|id| library.remove(id)),
        }
    }
    for handle in forests.iter().flat_map(ForestCells::species) {
        let id = handle.id();
        let is_known = library.is_known(id);
        if let Some(species) = species.get(id).filter(|species| !is_known && species.validate().is_ok()) {
            library.bake(id, species);
        }
    }
    let ImpostorSpeciesLibrary { species: baked, baking, failed, .. } = &mut *library;
    baking.retain_mut(|(id, task)| {
        let Some(made) = block_on(poll_once(task)) else { return true };
        let Baked { species, atlas } = match made {
            Ok(made) => made,
            Err(panic) => {
                let name = species.get(*id).map_or("unknown", |species| species.name.as_str());
                error!("species `{name}`: {panic}; its last good impostors stay");
                failed.insert(*id);
                return false;
            }
        };
        let (frame, shown_variants) = (atlas.frame, atlas.variants);
        let mut material = impostor_material(&species, atlas, &mut images, &buffers, near_masks.buffer.clone());
        *material.extension.lights_mut() = *lights;
        // Wherever it leans.
        let reach_m = frame.centre.length() + frame.radius_m + frame.half_height_m;
        let handle = match baked.get(id) {
            Some(before) => {
                if let Some(mut in_use) = materials.get_mut(&before.material) {
                    *in_use = material;
                }
                before.material.clone()
            }
            None => materials.add(material),
        };
        // As the shader takes it: `height_m` of `impostor_vertex.wesl`.
        let height_m = frame.centre.y + frame.half_height_m;
        let (age, variants) = (species.age, species.variants);
        baked.insert(*id, ImpostorSpecies { material: handle, age, reach_m, height_m, variants, shown_variants });
        false
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_atlas_fits_into_a_texture_of_any_device_with_storage_buffers() {
        let species = Species::default();
        let textures = species_textures(&species);
        let model = TreeModel::bake(&species, 3.0, 1);
        let scenes: Vec<Scene> = (0..MAX_VARIANTS).map(|_| Scene::new(&species, &model, &textures)).collect();
        let atlas = ImpostorAtlas::bake(&scenes, &ImpostorSettings::default());
        assert!(atlas.has_bare, "it sheds its leaves: most views that there are");
        // `maxTextureDimension2D` of WebGPU.
        assert!(atlas.coverage.width.max(atlas.coverage.height) <= 8192, "{:?}", atlas.coverage.height);
    }
}
