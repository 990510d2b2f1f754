//! The views of each species that grows in a forest, made in the background.

use super::{
    material::{FarMaterial, FarViews, far_material},
    mesh::MOST_TREES,
    near::NearCells,
};
use crate::{
    forest::cells::ForestCells,
    lod::{Lean, LevelSettings, Scene, ViewAtlas},
    sway::{DrawPath, LitAsTrees, StandTables, TreeLights},
    tree::{Species, TreeModel, bake_variants, growth::age::Age, painting::paint},
};
use bevy::{
    platform::collections::HashMap,
    prelude::*,
    tasks::{AsyncComputeTaskPool, Task, block_on, poll_once},
};

/// How species look from afar.
#[derive(Resource, Default)]
pub(super) struct FarLooks {
    looks: HashMap<AssetId<Species>, FarLook>,
    baking: Vec<(AssetId<Species>, Task<Baked>)>,
}

/// How one species looks from afar.
pub(super) struct FarLook {
    pub material: Handle<FarMaterial>,
    /// How it ages: the views are of a mature tree, which is of size 1.
    pub age: Age,
    /// How far the mature tree reaches from its foot, m.
    pub reach_m: f32,
    /// How many variants the species has, and of how many there are views: of the first ones.
    pub variants: u32,
    pub trees: u32,
}

struct Baked {
    species: Species,
    views: FarViews,
}

impl FarLooks {
    pub fn get(&self, id: AssetId<Species>) -> Option<&FarLook> {
        self.looks.get(&id)
    }

    fn bake(&mut self, id: AssetId<Species>, species: &Species) {
        let species = species.clone();
        self.baking.retain(|(other, _)| *other != id);
        self.baking.push((id, AsyncComputeTaskPool::get().spawn(async move { bake(species) })));
    }
}

fn bake(species: Species) -> Baked {
    let textures = paint(&species);
    let models: Vec<TreeModel> = bake_variants(&species, species.age.mature_years).take(MOST_TREES as usize).collect();
    let scenes: Vec<Scene> = models.iter().map(|model| Scene::new(&species, model, &textures)).collect();
    let atlas = ViewAtlas::bake(&scenes, &LevelSettings::default().views);
    let leans = scenes.iter().zip(&models).map(|(scene, model)| Lean::of(scene, model)).collect();
    Baked { views: FarViews::new(&atlas, leans, textures.foliage_colour()), species }
}

/// Starts making the views of species that have come or were changed, and takes over those that are made.
pub(super) fn bake_far_looks(
    mut looks: ResMut<FarLooks>,
    mut images: ResMut<Assets<Image>>,
    mut materials: ResMut<Assets<FarMaterial>>,
    mut events: MessageReader<AssetEvent<Species>>,
    tables: Res<StandTables>,
    path: Res<DrawPath>,
    lights: Res<TreeLights>,
    near: Res<NearCells>,
    species: Res<Assets<Species>>,
    forests: Query<&ForestCells>,
) {
    if !path.sways {
        // Without storage buffers not even the layout of their material can be made.
        return;
    }
    let changed = events.read().filter_map(|event| match event {
        AssetEvent::Modified { id } => Some(*id),
        _ => None,
    });
    for id in changed {
        if let Some(species) = species.get(id).filter(|species| species.validate().is_ok() && looks.get(id).is_some()) {
            looks.bake(id, species);
        }
    }
    for handle in forests.iter().flat_map(ForestCells::species) {
        let id = handle.id();
        let is_known = looks.looks.contains_key(&id) || looks.baking.iter().any(|(other, _)| *other == id);
        if let Some(species) = species.get(id).filter(|species| !is_known && species.validate().is_ok()) {
            looks.bake(id, species);
        }
    }
    let FarLooks { looks, baking } = &mut *looks;
    baking.retain_mut(|(id, task)| {
        let Some(Baked { species, views }) = block_on(poll_once(task)) else { return true };
        let (frame, trees) = (views.frame, views.trees);
        let mut material = far_material(&species, views, &mut images, &tables, near.buffer.clone());
        *material.extension.lights_mut() = *lights;
        // Wherever it leans.
        let reach_m = frame.centre.length() + frame.radius_m + frame.half_height_m;
        let handle = match looks.get(id) {
            Some(look) => {
                if let Some(mut worn) = materials.get_mut(&look.material) {
                    *worn = material;
                }
                look.material.clone()
            }
            None => materials.add(material),
        };
        looks.insert(*id, FarLook { material: handle, age: species.age, reach_m, variants: species.variants, trees });
        false
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_views_of_a_species_fit_a_texture_of_any_device_with_storage_buffers() {
        let species = Species::default();
        let textures = paint(&species);
        let model = TreeModel::bake(&species, 3.0, 1);
        let scenes: Vec<Scene> = (0..MOST_TREES).map(|_| Scene::new(&species, &model, &textures)).collect();
        let atlas = ViewAtlas::bake(&scenes, &LevelSettings::default().views);
        assert!(atlas.has_bare, "it sheds its leaves: most views that there are");
        // `maxTextureDimension2D` of WebGPU.
        assert!(atlas.outline.width.max(atlas.outline.height) <= 8192, "{:?}", atlas.outline.height);
    }
}
