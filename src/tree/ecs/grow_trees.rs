//! The systems that give trees their models.

use super::species_models::{SpeciesBaked, SpeciesModels, step_of_age};
use crate::tree::components::{Grown, Tree};
use bevy::prelude::*;

/// A tree, and its model if it has one.
type Growing = (Entity, &'static Tree, Option<&'static Grown>);

/// Gives a model to trees that are new or whose stage was baked anew, and asks for the models that are not baked yet.
pub(in crate::tree) fn grow_trees(
    mut commands: Commands,
    mut baked_species: ResMut<SpeciesModels>,
    mut baked: MessageReader<SpeciesBaked>,
    young: Query<Growing, Without<Grown>>,
    grown: Query<Growing, With<Grown>>,
    transforms: TransformHelper,
) {
    let renewed: Vec<_> = baked.read().map(|message| (message.species, message.step)).collect();
    for tree in &young {
        grow(tree, &transforms, &mut baked_species, &mut commands);
    }
    if renewed.is_empty() {
        return;
    }
    for tree in &grown {
        let (id, age_years) = (tree.1.species.id(), tree.1.age_years);
        let step = || baked_species.get(id).map(|entry| step_of_age(&entry.species.age, age_years));
        if renewed.iter().any(|(other, _)| *other == id) && step().is_some_and(|step| renewed.contains(&(id, step))) {
            grow(tree, &transforms, &mut baked_species, &mut commands);
        }
    }
}

/// Frames from one search for changed trees to the next: a seventh of a second at 60 frames a second. The search among
/// thousands of trees takes longer than all else that is done for grown trees, and hardly ever finds one.
const FRAMES_BETWEEN_SEARCHES: u32 = 8;

/// Whether changed trees are searched for in this frame. A search finds all that has changed since the one before.
pub(in crate::tree) fn is_time_to_search(mut frames: Local<u32>) -> bool {
    *frames = (*frames + 1) % FRAMES_BETWEEN_SEARCHES;
    *frames == 0
}

/// Gives another model to trees whose species, age or seed was changed: at once, or when it is baked.
pub(crate) fn regrow_trees(
    mut commands: Commands,
    mut baked_species: ResMut<SpeciesModels>,
    changed: Query<Entity, (Changed<Tree>, With<Grown>)>,
    trees: Query<Growing, With<Grown>>,
    transforms: TransformHelper,
    mut waiting: Local<Vec<Entity>>,
) {
    waiting.extend(&changed);
    waiting.sort_unstable();
    waiting.dedup();
    waiting
        .retain(|tree| trees.get(*tree).is_ok_and(|tree| !grow(tree, &transforms, &mut baked_species, &mut commands)));
}

/// Gives a tree its model if it has another one or none. Asks for the model and returns false if it is not baked yet.
fn grow(
    (entity, tree, grown): (Entity, &Tree, Option<&Grown>),
    transforms: &TransformHelper,
    baked_species: &mut ResMut<SpeciesModels>,
    commands: &mut Commands,
) -> bool {
    let id = tree.species.id();
    let Some(entry) = baked_species.get(id) else { return false };
    let step = step_of_age(&entry.species.age, tree.age_years);
    let Some(stage) = entry.stages.get(&step) else {
        baked_species.bypass_change_detection().bake(id, step);
        return false;
    };
    // Systems that propagate transforms may not have run since the tree was spawned: its place is computed here. A
    // parent without a transform leaves it at the world's origin.
    let place = || transforms.compute_global_transform(entity).unwrap_or_default().translation();
    let seed = tree.mixed_seed(place);
    let Some(variant) = seed.checked_rem(stage.models.len() as u64).map(|variant| variant as usize) else {
        return false;
    };
    let growing = Grown { model: stage.models[variant].clone(), variant, seed };
    if grown != Some(&growing) {
        commands.entity(entity).insert(growing);
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tree::{
        Species,
        ecs::test_app::{app, wait},
        growth::age::Age,
    };

    /// A tree that is baked quickly.
    fn sapling(species: &Handle<Species>) -> Tree {
        Tree::new(species.clone()).with_age(Age::YOUNGEST_YEARS)
    }

    #[test]
    fn a_grown_tree_changes_to_a_species_that_is_loaded_later() {
        let mut app = app();
        let mut assets = app.world_mut().resource_mut::<Assets<Species>>();
        let (first, second) = (assets.add(Species::default()), assets.reserve_handle());
        let tree = app.world_mut().spawn(sapling(&first)).id();
        let model = |world: &mut World| world.get::<Grown>(tree).map(|grown| grown.model.id());
        assert!(wait(&mut app, |world| model(world).is_some()));

        let before = model(app.world_mut());
        *app.world_mut().get_mut::<Tree>(tree).expect("it is there") = sapling(&second);
        (0..3 * FRAMES_BETWEEN_SEARCHES).for_each(|_| app.update());
        assert_eq!(model(app.world_mut()), before, "the other species is not loaded yet");

        let species = Species { variants: 1, ..Species::default() };
        app.world_mut().resource_mut::<Assets<Species>>().insert(&second, species).expect("the handle is reserved");
        assert!(wait(&mut app, |world| model(world) != before));
        let after = model(app.world_mut());
        let stages = &app.world().resource::<SpeciesModels>().get(second.id()).expect("it is baked").stages;
        assert!(stages.values().flat_map(|stage| &stage.models).any(|model| Some(model.id()) == after));
    }

    /// Children at one local place, of parents at many places, stand at many places of the world.
    #[test]
    fn children_of_moved_parents_get_seeds_of_their_place_in_the_world() {
        let mut app = app();
        let species = Species { variants: 4, ..Species::default() };
        let species = app.world_mut().resource_mut::<Assets<Species>>().add(species);
        let mut trees = Vec::new();
        for parent in 0..8 {
            let place = Transform::from_xyz(10.0 * parent as f32, 0.0, 3.0);
            let parent = app.world_mut().spawn((place, Visibility::default())).id();
            let local = Transform::from_xyz(1.0, 0.0, 0.0);
            trees.push(app.world_mut().spawn((sapling(&species), local, ChildOf(parent))).id());
        }
        let alone = Transform::from_xyz(11.0, 0.0, 3.0);
        trees.push(app.world_mut().spawn((sapling(&species), alone)).id());
        let mut seeds = Vec::new();
        assert!(wait(&mut app, |world| {
            seeds = trees.iter().filter_map(|tree| Some(world.get::<Grown>(*tree)?.seed)).collect();
            seeds.len() == trees.len()
        }));
        assert_eq!(seeds.pop(), Some(seeds[1]), "a child has the seed of a tree without parent at the same place");
        let mut different = seeds.clone();
        different.sort_unstable();
        different.dedup();
        assert_eq!(different.len(), seeds.len(), "{seeds:?}");
        let variants: Vec<usize> = trees.iter().map(|tree| app.world().get::<Grown>(*tree).unwrap().variant).collect();
        assert!(variants.iter().any(|variant| *variant != variants[0]), "{variants:?}");
    }

    #[cfg(feature = "render")]
    #[test]
    fn a_seed_chooses_the_variant_that_variant_of_predicts() {
        let mut app = app();
        let young = Species { variants: 3, ..Species::default() };
        let species = app.world_mut().resource_mut::<Assets<Species>>().add(young);
        for seed in 0..20 {
            app.world_mut().spawn((sapling(&species).with_seed(seed), Transform::from_xyz(seed as f32, 0.0, 0.0)));
        }
        let mut grown = Vec::new();
        assert!(wait(&mut app, |world| {
            let mut trees = world.query::<(&Tree, &Grown)>();
            grown = trees.iter(world).filter_map(|(tree, grown)| Some((tree.seed?, grown.variant))).collect();
            grown.len() == 20
        }));
        assert!(grown.iter().all(|&(seed, variant)| Tree::variant_of(seed, 3) as usize == variant), "{grown:?}");
    }
}
