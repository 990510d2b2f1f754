//! Makes the meshes that trees want, in the background, and puts them on the GPU.
//!
//! Only the coarsest level of a model is always there. Trees want others when they come near (`render/lod/want_parts.rs`), or when they are
//! drawn (`render/draw/waiting.rs`).

use super::{
    library::SpeciesLibrary,
    lod_meshes::{LevelRecipe, LodMeshes, remade_level},
    mesh_copies::MeshCopies,
    part_set::{LevelPart, PartSet},
};
use crate::{
    background::{Work, spawn_work},
    lod::MOST_LEVELS,
    tree::{Species, TreeModel},
};
use bevy::{
    prelude::*,
    tasks::{block_on, poll_once},
};
use std::sync::Arc;

/// Models whose meshes go to the GPU in a frame, at most: each has up to a megabyte.
const FINISHED_PER_FRAME: usize = 8;

/// Meshes that are being made.
#[derive(Resource, Default)]
pub(crate) struct PartLoads(Vec<PartLoad>);

struct PartLoad {
    species: AssetId<Species>,
    model: AssetId<TreeModel>,
    recipe: Arc<LevelRecipe>,
    parts: PartSet,
    task: Work<Vec<(usize, LodMeshes)>>,
}

/// Starts to make what trees have asked for.
pub(crate) fn start_loading_parts(
    mut library: ResMut<SpeciesLibrary>,
    mut loads: ResMut<PartLoads>,
    models: Res<Assets<TreeModel>>,
) {
    let SpeciesLibrary { species: all, asked } = library.bypass_change_detection();
    asked.retain(|(species, id)| {
        let variant = all.get_mut(species).and_then(|prepared| prepared.variants.get_mut(id));
        let Some(variant) = variant else { return false };
        let Some(model) = models.get(*id) else { return true };
        let parts = variant.demand.start(variant.parts_there(), variant.all_parts());
        if parts.is_empty() {
            return false;
        }
        let model = model.clone();
        let recipe = variant.recipe.clone();
        let own = recipe.clone();
        let task = spawn_work(move || {
            let levels = (0..MOST_LEVELS).filter(|level| parts.has_level(*level));
            levels.map(|level| (level, remade_level(&own, &model, level, parts))).collect::<Vec<_>>()
        });
        loads.0.push(PartLoad { species: *species, model: *id, recipe, parts, task });
        false
    });
}

/// Takes over what has been made, so much a frame.
pub(crate) fn finish_loading_parts(
    mut library: ResMut<SpeciesLibrary>,
    mut loads: ResMut<PartLoads>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut copies: ResMut<MeshCopies>,
) {
    let mut left = FINISHED_PER_FRAME;
    let library = library.bypass_change_detection();
    loads.bypass_change_detection().0.retain_mut(|load| {
        if left == 0 {
            return true;
        }
        let Some(levels) = block_on(poll_once(&mut load.task)) else { return true };
        let levels = match levels {
            Ok(levels) => levels,
            Err(panic) => {
                // They count as on their way for ever, so that nobody asks for them again.
                error!("meshes of a tree: {panic}; coarser ones stand for them");
                return false;
            }
        };
        // A variant that was prepared anew in the meantime has another recipe.
        let variant = library.variant_mut(load.species, load.model);
        let Some(variant) = variant.filter(|variant| Arc::ptr_eq(&variant.recipe, &load.recipe)) else { return false };
        left -= 1;
        variant.demand.finish(load.parts);
        for (level, LodMeshes { wood, bare_wood, leaves, .. }) in levels {
            let parts = [(LevelPart::Wood, Some(wood)), (LevelPart::BareWood, bare_wood), (LevelPart::Leaves, leaves)];
            for (part, mesh) in parts {
                if let Some(mesh) = mesh.and_then(|part| part.mesh) {
                    variant.set_mesh(level, part, Some(copies.add(mesh, &mut meshes)));
                }
            }
        }
        false
    });
}
