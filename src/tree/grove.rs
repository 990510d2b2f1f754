//! From species to models, in the background, and from models to trees.

use super::{
    components::{Grown, Tree},
    model::TreeModel,
    species::Species,
};
use bevy::{
    platform::collections::HashMap,
    prelude::*,
    tasks::{AsyncComputeTaskPool, Task, block_on, poll_once},
};
use rand::{Rng, SeedableRng, rngs::Xoshiro256PlusPlus};

/// The baked species. An entry lives as long as its species asset.
#[derive(Resource, Default)]
pub struct Grove {
    species: HashMap<AssetId<Species>, BakedSpecies>,
    baking: Vec<Baking>,
}

/// A species and its models.
pub struct BakedSpecies {
    /// The species as it was baked; a change on disk bakes it anew.
    pub species: Species,
    /// One model a variant.
    pub models: Vec<Handle<TreeModel>>,
    /// Differs between bakes, so that what was made from an older one can be told.
    pub generation: u64,
}

struct Baking {
    id: AssetId<Species>,
    task: Task<(Species, Vec<TreeModel>)>,
}

impl Grove {
    /// A species that has been baked.
    pub fn get(&self, id: AssetId<Species>) -> Option<&BakedSpecies> {
        self.species.get(&id)
    }

    /// Whether species are being baked.
    pub fn is_baking(&self) -> bool {
        !self.baking.is_empty()
    }

    /// Number of baked species.
    pub fn len(&self) -> usize {
        self.species.len()
    }

    /// Whether nothing has been baked.
    pub fn is_empty(&self) -> bool {
        self.species.is_empty()
    }
}

/// Message: a species has been baked, for the first time or anew.
#[derive(Message, Clone, Copy, Debug)]
pub struct SpeciesBaked(pub AssetId<Species>);

/// Starts a bake for every species that was loaded or changed, and forgets those whose asset is gone.
pub(super) fn bake_species(
    mut events: MessageReader<AssetEvent<Species>>,
    species: Res<Assets<Species>>,
    mut grove: ResMut<Grove>,
) {
    for event in events.read() {
        match *event {
            AssetEvent::Added { id } | AssetEvent::Modified { id } => {
                let Some(species) = species.get(id).cloned() else { continue };
                if let Err(error) = species.validate() {
                    warn!("species `{}`: {error}; the last good one stays", species.name);
                    continue;
                }
                // Of two bakes of one species the newer counts.
                grove.baking.retain(|baking| baking.id != id);
                let task = AsyncComputeTaskPool::get().spawn(async move {
                    let models = bake_variants(&species);
                    (species, models)
                });
                grove.baking.push(Baking { id, task });
            }
            AssetEvent::Removed { id } => {
                grove.baking.retain(|baking| baking.id != id);
                grove.species.remove(&id);
            }
            AssetEvent::Unused { .. } | AssetEvent::LoadedWithDependencies { .. } => {}
        }
    }
}

/// Bakes all variants of a species; each has its own seed, drawn from the species' own.
pub fn bake_variants(species: &Species) -> Vec<TreeModel> {
    let mut seeds = Xoshiro256PlusPlus::seed_from_u64(species.seed);
    (0..species.variants).map(|_| TreeModel::bake(species, seeds.next_u64())).collect()
}

/// Takes over what has been baked.
pub(crate) fn receive_models(
    mut grove: ResMut<Grove>,
    mut models: ResMut<Assets<TreeModel>>,
    mut baked: MessageWriter<SpeciesBaked>,
    mut generation: Local<u64>,
) {
    if grove.baking.is_empty() {
        return;
    }
    let mut finished = Vec::new();
    grove.baking.retain_mut(|baking| match block_on(poll_once(&mut baking.task)) {
        Some(output) => {
            finished.push((baking.id, output));
            false
        }
        None => true,
    });
    for (id, (species, variants)) in finished {
        *generation += 1;
        let models = variants.into_iter().map(|model| models.add(model)).collect();
        grove.species.insert(id, BakedSpecies { species, models, generation: *generation });
        baked.write(SpeciesBaked(id));
    }
}

/// Gives new trees their model, and trees of a species that was baked anew their new one.
pub(super) fn grow_trees(
    mut commands: Commands,
    grove: Res<Grove>,
    mut baked: MessageReader<SpeciesBaked>,
    trees: Query<(Entity, &Tree, &Transform)>,
    young: Query<Entity, (With<Tree>, Or<(Changed<Tree>, Without<Grown>)>)>,
) {
    let renewed: Vec<AssetId<Species>> = baked.read().map(|message| message.0).collect();
    let mut grow = |(entity, tree, transform): (Entity, &Tree, &Transform)| {
        let Some(species) = grove.get(tree.species.id()) else { return };
        let seed = tree.seed_at(transform.translation);
        let Some(variant) = seed.checked_rem(species.models.len() as u64).map(|variant| variant as usize) else {
            return;
        };
        commands.entity(entity).insert(Grown { model: species.models[variant].clone(), variant, seed });
    };
    if renewed.is_empty() {
        young.iter().filter_map(|entity| trees.get(entity).ok()).for_each(&mut grow);
    } else {
        let due = |tree: &Tree, entity| renewed.contains(&tree.species.id()) || young.contains(entity);
        trees.iter().filter(|(entity, tree, _)| due(tree, *entity)).for_each(&mut grow);
    }
}
