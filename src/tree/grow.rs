//! From models to trees.

use super::{
    components::{Grown, Tree},
    grove::{Grove, SpeciesBaked, step_of_age},
};
use bevy::prelude::*;

/// A tree as it gets its model.
type Growing = (Entity, &'static Tree, &'static Transform, Option<&'static Grown>);

/// Gives trees that are new or of a stage that was baked anew their model, and asks for those models that are not there
/// yet.
pub(super) fn grow_trees(
    mut commands: Commands,
    mut grove: ResMut<Grove>,
    mut baked: MessageReader<SpeciesBaked>,
    young: Query<Growing, Without<Grown>>,
    grown: Query<Growing, With<Grown>>,
) {
    let renewed: Vec<_> = baked.read().map(|message| (message.species, message.step)).collect();
    for tree in &young {
        grow(tree, &mut grove, &mut commands);
    }
    if renewed.is_empty() {
        return;
    }
    for tree in &grown {
        let (id, age_years) = (tree.1.species.id(), tree.1.age_years);
        let step = || grove.get(id).map(|entry| step_of_age(&entry.species.age, age_years));
        if renewed.iter().any(|(other, _)| *other == id) && step().is_some_and(|step| renewed.contains(&(id, step))) {
            grow(tree, &mut grove, &mut commands);
        }
    }
}

/// Frames from one look at what was changed of grown trees to the next: a seventh of a second in a game of 60 a second.
/// To look at some thousand trees takes longer than all else that is done for trees that stand, and hardly ever finds one.
const FRAMES_BETWEEN_LOOKS: u32 = 8;

/// Whether it is time to look for trees that were changed. What is changed meanwhile is found then.
pub(super) fn is_time_to_look(mut frames: Local<u32>) -> bool {
    *frames = (*frames + 1) % FRAMES_BETWEEN_LOOKS;
    *frames == 0
}

/// Gives trees that were changed, and now are of another species, age or seed, another model: at once, or when it is there.
pub(super) fn regrow_trees(
    mut commands: Commands,
    mut grove: ResMut<Grove>,
    changed: Query<Entity, (Changed<Tree>, With<Grown>)>,
    trees: Query<Growing, With<Grown>>,
    mut waiting: Local<Vec<Entity>>,
) {
    waiting.extend(&changed);
    waiting.sort_unstable();
    waiting.dedup();
    waiting.retain(|tree| trees.get(*tree).is_ok_and(|tree| !grow(tree, &mut grove, &mut commands)));
}

/// Gives a tree its model if it has another one or none, and says whether it could: the model is asked for if it is not
/// there yet.
fn grow(
    (entity, tree, transform, grown): (Entity, &Tree, &Transform, Option<&Grown>),
    grove: &mut ResMut<Grove>,
    commands: &mut Commands,
) -> bool {
    let id = tree.species.id();
    let Some(entry) = grove.get(id) else { return false };
    let step = step_of_age(&entry.species.age, tree.age_years);
    let Some(stage) = entry.stages.get(&step) else {
        grove.bypass_change_detection().bake(id, step);
        return false;
    };
    let seed = tree.seed_at(transform.translation);
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
    use crate::tree::{Species, TreePlugin, growth::age::Age};

    /// An app in which trees grow, and nothing else.
    fn app() -> App {
        let mut app = App::new();
        app.add_plugins((AssetPlugin::default(), TaskPoolPlugin::default(), TreePlugin));
        app
    }

    /// Lets frames pass until that is so.
    fn wait(app: &mut App, mut is_so: impl FnMut(&mut World) -> bool) -> bool {
        (0..10_000).any(|_| {
            app.update();
            std::thread::sleep(std::time::Duration::from_millis(1));
            is_so(app.world_mut())
        })
    }

    /// What is quickly baked.
    fn sapling(species: &Handle<Species>) -> Tree {
        Tree::new(species.clone()).with_age(Age::YOUNGEST_YEARS)
    }

    #[test]
    fn a_grown_tree_becomes_one_of_a_species_that_is_loaded_only_later() {
        let mut app = app();
        let mut assets = app.world_mut().resource_mut::<Assets<Species>>();
        let (first, second) = (assets.add(Species::default()), assets.reserve_handle());
        let tree = app.world_mut().spawn(sapling(&first)).id();
        let model = |world: &mut World| world.get::<Grown>(tree).map(|grown| grown.model.id());
        assert!(wait(&mut app, |world| model(world).is_some()));

        let before = model(app.world_mut());
        *app.world_mut().get_mut::<Tree>(tree).expect("it is there") = sapling(&second);
        (0..3 * FRAMES_BETWEEN_LOOKS).for_each(|_| app.update());
        assert_eq!(model(app.world_mut()), before, "there is nothing to become yet");

        let species = Species { variants: 1, ..Species::default() };
        app.world_mut().resource_mut::<Assets<Species>>().insert(&second, species).expect("the handle is reserved");
        assert!(wait(&mut app, |world| model(world) != before));
        let after = model(app.world_mut());
        let stages = &app.world().resource::<Grove>().get(second.id()).expect("it is baked").stages;
        assert!(stages.values().flat_map(|stage| &stage.models).any(|model| Some(model.id()) == after));
    }

    #[cfg(feature = "render")]
    #[test]
    fn a_tree_of_a_seed_is_the_variant_that_is_foretold() {
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
