//! Prepares species in the background, when they have been baked.

use super::{
    library::{
        PreparedLod, PreparedMesh, PreparedSpecies, PreparedVariant, SpeciesLibrary, SpeciesPrepared, VariantRemoved,
    },
    lod_meshes::{LevelRecipe, LodMeshes, MeshPart, SpeciesMeshes, VariantMeshes, species_meshes},
    materials::{MaterialAssets, SpeciesMaterials},
    mesh_copies::MeshCopies,
    part_demand::PartDemand,
    part_set::PartSet,
};
use crate::{
    background::{Work, spawn_work},
    lod::LodBakeSettings,
    render::{
        capabilities::RenderCapabilities,
        settings::{ActiveLevelOfDetail, LevelStyle},
        wind_exposure::WindExposure,
    },
    tree::{Species, SpeciesBaked, SpeciesModels, TreeModel, no_longer_used},
};
use bevy::{
    ecs::system::SystemParam,
    prelude::*,
    tasks::{block_on, poll_once},
};
use std::{collections::VecDeque, sync::Arc};

/// Species that are being prepared.
#[derive(Resource, Default)]
pub(crate) struct PreparationQueue {
    /// Species and steps of age that wait to be started.
    waiting: VecDeque<(AssetId<Species>, i32)>,
    running: Vec<Preparation>,
    /// What they are prepared with.
    style: LevelStyle,
    bake: LodBakeSettings,
}

impl PreparationQueue {
    /// Has all species prepared anew, at all ages of their trees.
    pub fn start_again(&mut self, species_models: &SpeciesModels) {
        self.running.clear();
        self.wait_for_all(species_models);
    }

    fn wait_for_all(&mut self, species_models: &SpeciesModels) {
        self.waiting.clear();
        self.waiting.extend(species_models.stages());
        self.waiting.make_contiguous().sort_unstable();
    }
}

struct Preparation {
    species: AssetId<Species>,
    age_step: i32,
    generation: u64,
    recipe: Arc<LevelRecipe>,
    task: Work<SpeciesMeshes>,
}

/// Starts preparing species that were baked, or all of them when the settings of their levels have changed, one a frame.
pub(crate) fn start_preparing_species(
    mut baked: MessageReader<SpeciesBaked>,
    species_models: Res<SpeciesModels>,
    models: Res<Assets<TreeModel>>,
    settings: Res<ActiveLevelOfDetail>,
    capabilities: Option<Res<RenderCapabilities>>,
    library: Res<SpeciesLibrary>,
    mut queue: ResMut<PreparationQueue>,
) {
    let queue = queue.bypass_change_detection();
    queue.waiting.extend(baked.read().map(|&SpeciesBaked { species, step }| (species, step)));
    if queue.style != settings.0.style || queue.bake != settings.0.bake {
        queue.style = settings.0.style;
        queue.bake.clone_from(&settings.0.bake);
        queue.wait_for_all(&species_models);
    }
    let PreparationQueue { waiting, running, style, bake } = queue;
    let Some((id, age_step)) = waiting.pop_front() else { return };
    let Some(entry) = species_models.get(id) else { return };
    let Some(stage) = entry.stages.get(&age_step) else { return };
    let generation = stage.generation;
    let recipe = Arc::new(LevelRecipe {
        species: entry.species.clone(),
        style: *style,
        bake: bake.clone(),
        compresses_textures: capabilities.is_some_and(|it| it.compresses_textures),
    });
    let variants: Vec<TreeModel> = stage.models.iter().filter_map(|model| models.get(model).cloned()).collect();
    running.retain(|other| (other.species, other.age_step) != (id, age_step));
    let has_images = library.species.get(&id).is_some_and(|prepared| prepared.generation == generation)
        || running.iter().any(|other| (other.species, other.generation) == (id, generation));
    let (own, wanted) = (recipe.clone(), parts_in_use(&library, id, age_step));
    let task = spawn_work(move || species_meshes(&own, !has_images, &variants, wanted));
    running.push(Preparation { species: id, age_step, generation, recipe, task });
}

/// The meshes that trees of a species and an age have on the GPU. Those that follow them have to be there at once.
fn parts_in_use(library: &SpeciesLibrary, species: AssetId<Species>, age_step: i32) -> PartSet {
    let variants = library.species.get(&species).into_iter().flat_map(|prepared| prepared.variants.values());
    let of_age = variants.filter(|variant| variant.age_step == age_step);
    of_age.fold(PartSet::EMPTY, |parts, variant| parts.and(variant.parts_there()))
}

/// Forgets species that nobody has any longer.
pub(crate) fn remove_prepared_species(
    mut events: MessageReader<AssetEvent<Species>>,
    mut queue: ResMut<PreparationQueue>,
    mut library: ResMut<SpeciesLibrary>,
    mut removed: MessageWriter<VariantRemoved>,
) {
    for event in events.read() {
        if let Some(id) = no_longer_used(event) {
            queue.running.retain(|other| other.species != id);
            let prepared = library.species.remove(&id);
            removed.write_batch(prepared.into_iter().flat_map(|it| it.variants.into_keys()).map(VariantRemoved));
        }
    }
}

/// Adds meshes and materials as assets.
#[derive(SystemParam)]
pub(crate) struct PreparedAssets<'w> {
    meshes: ResMut<'w, Assets<Mesh>>,
    copies: ResMut<'w, MeshCopies>,
    models: Res<'w, Assets<TreeModel>>,
    exposure: Res<'w, WindExposure>,
    materials: MaterialAssets<'w>,
}

/// Takes over what has been prepared, one species at one age a frame.
pub(crate) fn finish_preparing_species(
    mut queue: ResMut<PreparationQueue>,
    species_models: Res<SpeciesModels>,
    mut library: ResMut<SpeciesLibrary>,
    mut assets: PreparedAssets,
    mut prepared: MessageWriter<SpeciesPrepared>,
    mut removed: MessageWriter<VariantRemoved>,
) {
    let running = &queue.running;
    // The first of a species brings the textures for all.
    let is_first = |number: usize| running[..number].iter().all(|other| other.species != running[number].species);
    let ready = (0..running.len()).find(|&number| is_first(number) && running[number].task.is_finished());
    let Some(number) = ready else { return };
    let Preparation { species, age_step, generation, recipe, mut task } = queue.running.remove(number);
    let Some(meshes) = block_on(poll_once(&mut task)) else { return };
    let Some(entry) = species_models.get(species) else { return };
    let meshes = match meshes {
        Ok(meshes) => meshes,
        Err(panic) => {
            error!("species `{}`: {panic}; its last good meshes stay", entry.species.name);
            return;
        }
    };
    let Some(stage) = entry.stages.get(&age_step).filter(|stage| stage.generation == generation) else { return };
    if let Some(images) = meshes.images {
        let materials = assets.materials.add_species(&entry.species, images);
        let variants = library.species.remove(&species).map(|old| old.variants).unwrap_or_default();
        let phenology = entry.species.phenology;
        library.species.insert(species, PreparedSpecies { generation, phenology, materials, variants });
    }
    let Some(in_library) = library.species.get_mut(&species) else { return };
    let is_replaced = in_library.variants.values().any(|variant| variant.age_step == age_step);
    in_library.variants.retain(|id, variant| {
        let stays = variant.age_step != age_step;
        if !stays && stage.models.iter().all(|model| model.id() != *id) {
            removed.write(VariantRemoved(*id));
        }
        stays
    });
    for (handle, VariantMeshes { lods, height_m, coarse_beams }) in stage.models.iter().zip(meshes.variants) {
        let Some(model) = assets.models.get(handle) else { continue };
        let bounds = assets.exposure.aabb(model, &in_library.phenology);
        let lods = lods.into_iter().map(|lod| assets.add_lod(lod, &in_library.materials)).collect();
        let demand = PartDemand::default();
        let mut variant = PreparedVariant {
            age_step,
            lods,
            bounds,
            height_m,
            coarse_beams,
            recipe: recipe.clone(),
            kept: PartSet::EMPTY,
            demand,
        };
        variant.kept = match recipe.style {
            LevelStyle::Thinned => PartSet::in_leaf(variant.lods.len() - 1),
            LevelStyle::Paper | LevelStyle::Full => variant.all_parts(),
        };
        in_library.variants.insert(handle.id(), variant);
    }
    prepared.write(SpeciesPrepared { species, age_step, is_replaced });
}

impl PreparedAssets<'_> {
    fn add_lod(&mut self, lod: LodMeshes, species: &SpeciesMaterials) -> PreparedLod {
        let LodMeshes { wood, bare_wood, leaves, is_wood_nested } = lod;
        let mut add = |MeshPart { mesh, material }: MeshPart| PreparedMesh {
            mesh: mesh.map(|mesh| self.copies.add(mesh, &mut self.meshes)),
            can_fade: material.can_fade(),
            bare_materials: self.materials.when_bare(&material, species),
            materials: self.materials.of_mesh(material, species),
        };
        PreparedLod { wood: add(wood), bare_wood: bare_wood.map(&mut add), leaves: leaves.map(add), is_wood_nested }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        lod::Decimation,
        tree::{Tree, TreePlugin},
    };
    use bevy::ecs::system::SystemId;

    /// An app in which one sapling has been baked, and the system that starts to prepare it.
    fn app() -> (App, SystemId) {
        let mut app = App::new();
        app.add_plugins((TaskPoolPlugin::default(), AssetPlugin::default(), TreePlugin))
            .init_resource::<ActiveLevelOfDetail>()
            .init_resource::<SpeciesLibrary>()
            .init_resource::<PreparationQueue>();
        let species = Species { variants: 1, ..Species::default() };
        let species = app.world_mut().resource_mut::<Assets<Species>>().add(species);
        app.world_mut().spawn(Tree { age_years: Some(3.0), ..Tree::new(species) });
        for _ in 0..10_000 {
            app.update();
            if app.world().resource::<SpeciesModels>().stages().next().is_some() {
                break;
            }
            std::thread::sleep(std::time::Duration::from_millis(1));
        }
        let system = app.register_system(start_preparing_species);
        (app, system)
    }

    /// Starts what is due, and returns the number of levels of each tree that is then prepared.
    fn prepared_levels((app, system): &mut (App, SystemId)) -> Vec<usize> {
        app.world_mut().run_system(*system).expect("it runs");
        let running = std::mem::take(&mut app.world_mut().resource_mut::<PreparationQueue>().running);
        running
            .into_iter()
            .flat_map(|it| block_on(it.task).expect("no panic").variants)
            .map(|variant| variant.lods.len())
            .collect()
    }

    #[test]
    fn changed_bake_settings_prepare_all_species_anew() {
        let mut app = app();
        assert_eq!(prepared_levels(&mut app), [3]);
        assert!(prepared_levels(&mut app).is_empty(), "nothing has changed");
        let thinned_once = vec![Decimation { leaf_share: 0.5, ..default() }];
        app.0.world_mut().resource_mut::<ActiveLevelOfDetail>().0.bake.decimations = thinned_once;
        assert_eq!(prepared_levels(&mut app), [2]);
        app.0.world_mut().resource_mut::<ActiveLevelOfDetail>().0.fade = 0.2;
        assert!(prepared_levels(&mut app).is_empty(), "no mesh depends on this");
    }
}
