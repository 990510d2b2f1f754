//! The baked models of all species, and the systems that bake them in the background.
//!
//! Trees of a species share models: one for each variant at each step of age. Only the steps that trees ask for are
//! baked.

use crate::{
    background::{Work, spawn_work},
    tree::{growth::age::Age, model::TreeModel, species::Species},
};
use bevy::{
    platform::collections::HashMap,
    prelude::*,
    tasks::{block_on, poll_once},
};
use rand::{Rng, SeedableRng, rngs::Xoshiro256PlusPlus};
use std::collections::BTreeMap;

/// Ratio of one step of age to the one before. A tree is drawn at most 16% older or younger than it is, which is less than
/// trees of one age differ.
const AGE_STEP: f32 = 1.35;

/// The species that are baked. An entry lives as long as anyone has a handle of its species: one whose asset is removed before that stays as
/// it last was.
#[derive(Resource, Default)]
pub struct SpeciesModels {
    species: HashMap<AssetId<Species>, BakedSpecies>,
    baking: Vec<Baking>,
    bakes: u64,
}

/// A species and its models.
pub struct BakedSpecies {
    /// The species as it was last found valid; a change on disk bakes it anew.
    pub species: Species,
    /// Grows with each change of the species.
    pub generation: u64,
    /// Its models, by step of age.
    pub stages: BTreeMap<i32, BakedStage>,
}

/// The models of a species at one age.
pub struct BakedStage {
    /// One model a variant; none where a worker has panicked over the first.
    pub models: Vec<Handle<TreeModel>>,
    /// Which of the species' generations they are of; older ones stay until newer are baked.
    pub generation: u64,
}

struct Baking {
    id: AssetId<Species>,
    step: i32,
    generation: u64,
    task: Work<Vec<TreeModel>>,
}

impl SpeciesModels {
    /// A species that has been found valid.
    pub fn get(&self, id: AssetId<Species>) -> Option<&BakedSpecies> {
        self.species.get(&id)
    }

    /// Every species with every age that is baked.
    #[cfg(feature = "render")]
    pub(crate) fn stages(&self) -> impl Iterator<Item = (AssetId<Species>, i32)> + '_ {
        let baked = |(step, stage): (&i32, &BakedStage)| (!stage.models.is_empty()).then_some(*step);
        self.species.iter().flat_map(move |(id, entry)| entry.stages.iter().filter_map(baked).map(|step| (*id, step)))
    }

    /// Whether species are being baked.
    pub fn is_baking(&self) -> bool {
        !self.baking.is_empty()
    }

    /// Number of species.
    pub fn len(&self) -> usize {
        self.species.len()
    }

    /// Whether there are no species.
    pub fn is_empty(&self) -> bool {
        self.species.is_empty()
    }

    /// Inserts a valid species, and bakes it at the ages that its former version was baked at.
    fn insert(&mut self, id: AssetId<Species>, species: Species) {
        self.bakes += 1;
        let generation = self.bakes;
        let mut steps: Vec<i32> =
            self.baking.iter().filter(|baking| baking.id == id).map(|baking| baking.step).collect();
        self.baking.retain(|baking| baking.id != id);
        let stages = self.species.remove(&id).map(|old| old.stages).unwrap_or_default();
        steps.extend(stages.keys());
        self.species.insert(id, BakedSpecies { species, generation, stages });
        steps.into_iter().for_each(|step| self.bake(id, step));
    }

    /// Starts baking a stage, unless it is there or on its way.
    pub(super) fn bake(&mut self, id: AssetId<Species>, step: i32) {
        let Some(entry) = self.species.get(&id) else { return };
        let generation = entry.generation;
        let is_there = entry.stages.get(&step).is_some_and(|stage| stage.generation == generation);
        if is_there || self.baking.iter().any(|baking| (baking.id, baking.step) == (id, step)) {
            return;
        }
        let species = entry.species.clone();
        let task = spawn_work(move || bake_variants(&species, age_of_step(&species.age, step)).collect());
        self.baking.push(Baking { id, step, generation, task });
    }
}

/// The step nearest to an age; the mature age is step 0.
pub(super) fn step_of_age(age: &Age, years: Option<f32>) -> i32 {
    let years = years.filter(|years| years.is_finite()).unwrap_or(age.mature_years);
    let years = years.clamp(Age::YOUNGEST_YEARS, age.oldest_years);
    ((years / age.mature_years).ln() / AGE_STEP.ln()).round() as i32
}

fn age_of_step(age: &Age, step: i32) -> f32 {
    (age.mature_years * AGE_STEP.powi(step)).clamp(Age::YOUNGEST_YEARS, age.oldest_years)
}

/// Message: a species has been baked at one age, for the first time or anew.
#[derive(Message, Clone, Copy, Debug)]
pub struct SpeciesBaked {
    /// The species.
    pub species: AssetId<Species>,
    /// Key of the stage among its [`BakedSpecies::stages`].
    pub step: i32,
}

/// The species of which nobody has a handle any more, if an event tells of one. An id that is a constant is nobody's: it is used no longer
/// when its asset is removed.
pub(crate) fn no_longer_used(event: &AssetEvent<Species>) -> Option<AssetId<Species>> {
    match *event {
        AssetEvent::Unused { id } | AssetEvent::Removed { id: id @ AssetId::Uuid { .. } } => Some(id),
        _ => None,
    }
}

/// Inserts every species that was loaded or changed, and removes those that nobody has any longer.
pub(in crate::tree) fn update_species(
    mut events: MessageReader<AssetEvent<Species>>,
    species: Res<Assets<Species>>,
    mut baked_species: ResMut<SpeciesModels>,
) {
    for event in events.read() {
        if let Some(id) = no_longer_used(event) {
            baked_species.baking.retain(|baking| baking.id != id);
            baked_species.species.remove(&id);
        }
        match *event {
            AssetEvent::Added { id } | AssetEvent::Modified { id } => {
                let Some(species) = species.get(id).cloned() else { continue };
                match species.validate() {
                    Ok(()) => baked_species.insert(id, species),
                    Err(error) => warn!("species `{}`: {error}; the last good one stays", species.name),
                }
            }
            AssetEvent::Removed { id } => {
                if let Some(entry) = baked_species.get(id) {
                    warn!("species `{}` was removed and is still in use; it stays as it was", entry.species.name);
                }
            }
            AssetEvent::Unused { .. } | AssetEvent::LoadedWithDependencies { .. } => {}
        }
    }
}

/// Bakes the variants of a species at an age, years, one by one as they are asked for; each has its own seed, drawn from the
/// species' own.
pub fn bake_variants(species: &Species, age_years: f32) -> impl Iterator<Item = TreeModel> {
    let mut seeds = Xoshiro256PlusPlus::seed_from_u64(species.seed);
    (0..species.variants).map(move |_| TreeModel::bake(species, age_years, seeds.next_u64()))
}

/// Stores the models whose baking is done.
pub(in crate::tree) fn store_baked_models(
    mut baked_species: ResMut<SpeciesModels>,
    mut models: ResMut<Assets<TreeModel>>,
    mut baked: MessageWriter<SpeciesBaked>,
) {
    if baked_species.baking.is_empty() {
        return;
    }
    let SpeciesModels { species, baking, .. } = &mut *baked_species;
    baking.retain_mut(|Baking { id, step, generation, task }| {
        let Some(variants) = block_on(poll_once(task)) else { return true };
        let Some(entry) = species.get_mut(id) else { return false };
        match variants {
            Ok(variants) => {
                let models = variants.into_iter().map(|model| models.add(model)).collect();
                entry.stages.insert(*step, BakedStage { models, generation: *generation });
                baked.write(SpeciesBaked { species: *id, step: *step });
            }
            Err(panic) => {
                error!("species `{}`: {panic}; its last good models stay", entry.species.name);
                // It would panic again: nobody asks for this generation any more.
                let before = entry.stages.remove(step).map(|before| before.models).unwrap_or_default();
                entry.stages.insert(*step, BakedStage { models: before, generation: *generation });
            }
        }
        false
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tree::{
        Grown, Tree,
        ecs::test_app::{app, wait},
    };

    /// A tree of a species whose next version makes a worker panic, and the one after that is good again.
    #[test]
    fn where_a_worker_panics_the_last_good_models_stay() {
        let mut app = app();
        let young = Species { variants: 1, ..Species::default() };
        let species = app.world_mut().resource_mut::<Assets<Species>>().add(young.clone());
        let tree = app.world_mut().spawn(Tree::new(species.clone()).with_age(Age::YOUNGEST_YEARS)).id();
        let model = |world: &mut World| world.get::<Grown>(tree).map(|grown| grown.model.id());
        assert!(wait(&mut app, |world| model(world).is_some()));
        let before = model(app.world_mut());

        let mut models = app.world_mut().resource_mut::<SpeciesModels>();
        models.bakes += 1;
        let generation = models.bakes;
        let entry = models.species.get_mut(&species.id()).expect("it is baked");
        entry.generation = generation;
        let step = *entry.stages.keys().next().expect("it is baked at one age");
        let task = spawn_work(|| panic!("a generator has a mistake"));
        models.baking.push(Baking { id: species.id(), step, generation, task });
        assert!(wait(&mut app, |world| !world.resource::<SpeciesModels>().is_baking()));
        // Trees that come later get the last good models, too, and nobody has it baked again.
        let later = app.world_mut().spawn(Tree::new(species.clone()).with_age(Age::YOUNGEST_YEARS)).id();
        (0..20).for_each(|_| app.update());
        assert_eq!(model(app.world_mut()), before);
        assert_eq!(app.world().get::<Grown>(later).map(|grown| grown.model.id()), before);
        assert!(!app.world().resource::<SpeciesModels>().is_baking());

        let good = Species { seed: 9, ..young };
        app.world_mut().resource_mut::<Assets<Species>>().insert(&species, good).expect("the handle lives");
        assert!(wait(&mut app, |world| model(world) != before));
    }

    #[test]
    fn ages_are_rounded_by_less_than_a_sixth() {
        let age = Age::default();
        for years in 1..500 {
            let years = years as f32;
            let drawn = age_of_step(&age, step_of_age(&age, Some(years)));
            assert!((drawn / years).ln().abs() <= 0.5 * AGE_STEP.ln() + 1e-4, "{years} is drawn as {drawn}");
        }
        assert_eq!(step_of_age(&age, None), 0);
        assert_eq!(age_of_step(&age, 0), age.mature_years);
    }

    #[test]
    fn ages_out_of_range_are_clamped() {
        let age = Age::default();
        for years in [f32::NAN, f32::INFINITY, -7.0, 0.0, 1e30] {
            let drawn = age_of_step(&age, step_of_age(&age, Some(years)));
            assert!((Age::YOUNGEST_YEARS..=age.oldest_years).contains(&drawn), "{years} is drawn as {drawn}");
        }
    }
}
