//! Species that are deleted while their trees stand, and folders with ten thousand of them.

use super::{
    birches, places,
    server::{server_app, shipped_assets},
    settle, spawn_forest, wait,
};
use bevy::{asset::LoadedFolder, prelude::*, time::TimeUpdateStrategy};
use bevy_windwood::{
    prelude::*,
    scatter::{ForestPlan, Planter, plan::Stock},
    tree::{SpeciesModels, TreeModel},
};
use std::{
    fs,
    time::{Duration, Instant},
};

fn model(world: &World, tree: Entity) -> Option<AssetId<TreeModel>> {
    world.get::<Grown>(tree).map(|grown| grown.model.id())
}

fn young(species: &Handle<Species>) -> Tree {
    Tree::new(species.clone()).with_age(2.0)
}

#[test]
fn a_species_that_is_removed_stays_as_it_was_while_anyone_has_it() {
    let mut app = server_app(&shipped_assets(), Duration::ZERO);
    let one = Species { variants: 1, ..default() };
    let species = app.world_mut().resource_mut::<Assets<Species>>().add(one.clone());
    let tree = app.world_mut().spawn(young(&species)).id();
    wait(&mut app, "the tree", |world| model(world, tree).is_some());
    let before = model(app.world(), tree);
    app.world_mut().resource_mut::<Assets<Species>>().remove(&species).expect("it is there");
    (0..20).for_each(|_| app.update());
    assert_eq!(model(app.world(), tree), before);
    assert!(app.world().resource::<Assets<TreeModel>>().get(before.expect("a model")).is_some());
    // Trees that come after that grow as well.
    let later = app.world_mut().spawn(young(&species)).id();
    wait(&mut app, "a later tree", |world| model(world, later).is_some());

    let mut all = app.world_mut().resource_mut::<Assets<Species>>();
    all.insert(&species, Species { seed: 8, ..one }).expect("the handle lives");
    wait(&mut app, "the species that is there again", |world| model(world, tree) != before);
    // When nobody has it any more nothing is left of it, whether its asset is there or not.
    app.world_mut().resource_mut::<Assets<Species>>().remove(&species).expect("it is there");
    drop(species);
    for tree in [tree, later] {
        app.world_mut().despawn(tree);
    }
    wait(&mut app, "the end of the species", |world| {
        world.resource::<SpeciesModels>().is_empty() && world.resource::<Assets<TreeModel>>().is_empty()
    });
}

/// An app that watches a folder of its own.
fn watching_app(folder: &std::path::Path) -> App {
    let mut app = App::new();
    let file_path = folder.display().to_string();
    let assets = AssetPlugin { file_path, watch_for_changes_override: Some(true), ..default() };
    app.add_plugins((MinimalPlugins, TransformPlugin, assets, WindwoodMinimalPlugins));
    app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::ZERO));
    app.finish();
    app.cleanup();
    app
}

#[test]
fn a_file_that_is_deleted_and_written_again_leaves_its_trees_standing_between() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("elder.species.ron");
    fs::write(&file, "(name: \"elder\", variants: 1)").expect("a file");
    let mut app = watching_app(folder.path());
    let species: Handle<Species> = app.world().resource::<AssetServer>().load("elder.species.ron");
    let tree = app.world_mut().spawn(young(&species)).id();
    wait(&mut app, "the tree", |world| model(world, tree).is_some());
    let before = model(app.world(), tree);
    fs::remove_file(&file).expect("it was there");
    // Bevy waits for 300 ms until it believes in a change.
    for _ in 0..100 {
        app.update();
        std::thread::sleep(Duration::from_millis(10));
    }
    assert_eq!(model(app.world(), tree), before);
    fs::write(&file, "(name: \"elder\", variants: 1, seed: 5)").expect("a file");
    wait(&mut app, "the file that is there again", |world| model(world, tree) != before);
}

#[test]
fn ten_thousand_files_are_loaded_and_only_those_are_baked_that_trees_have() {
    const FILES: usize = 10_000;
    let folder = tempfile::tempdir().expect("a folder");
    for number in 0..FILES {
        let text = format!("(name: \"elder {number}\", variants: 1, seed: {number})");
        fs::write(folder.path().join(format!("{number}.species.ron")), text).expect("a file");
    }
    let mut app = server_app(folder.path(), Duration::ZERO);
    let begin = Instant::now();
    let all: Handle<LoadedFolder> = app.world().resource::<AssetServer>().load_folder("");
    wait(&mut app, "the folder", |world| world.resource::<SpeciesModels>().len() == FILES);
    println!("{FILES} species after {:.1} s", begin.elapsed().as_secs_f32());
    assert!(!app.world().resource::<SpeciesModels>().is_baking());
    let assets = app.world().resource::<AssetServer>().clone();
    let trees =
        [7, 5000, 9999].map(|number| app.world_mut().spawn(young(&assets.load(format!("{number}.species.ron")))).id());
    wait(&mut app, "the trees", |world| trees.iter().all(|tree| model(world, *tree).is_some()));
    assert_eq!(app.world().resource::<Assets<TreeModel>>().len(), trees.len());
    trees.into_iter().for_each(|tree| app.world_mut().entity_mut(tree).despawn());
    drop(all);
    wait(&mut app, "the end of all", |world| world.resource::<SpeciesModels>().is_empty());
}

#[test]
fn a_plan_with_more_species_than_a_stem_can_name_is_refused_and_the_last_good_one_stays() {
    let many = |count: usize| {
        let mut plan = birches(100.0, 100.0);
        plan.areas = (0..count.div_ceil(50))
            .map(|area| {
                let name = |number| format!("elder_{}", 50 * area + number);
                let stock = (0..50).map(|number| Stock { species: name(number), ..default() }).collect();
                bevy_windwood::scatter::plan::Area { stock, ..plan.areas[0].clone() }
            })
            .collect();
        plan
    };
    Planter::new(&many(250)).expect("256 may be named");
    let error = Planter::new(&many(10_000)).expect_err("too many").to_string();
    assert_eq!(error, "`species.len()` is 257, but must be 1 to 256");

    let mut app = server_app(&shipped_assets(), Duration::ZERO);
    app.world_mut().spawn(Viewpoint);
    let forest = spawn_forest(&mut app, birches(100.0, 100.0), [60.0, 0.0]);
    settle(&mut app, forest);
    let before = places(&mut app).len();
    let mut plans = app.world_mut().resource_mut::<Assets<ForestPlan>>();
    let id = plans.ids().next().expect("the plan");
    plans.insert(id, many(10_000)).expect("the handle lives");
    (0..50).for_each(|_| app.update());
    assert!(before > 20 && places(&mut app).len() == before);
}
