use super::*;
use crate::{
    editor::steps::Steps,
    render::TreeMeshOf,
    schedule::WindwoodSystems,
    tree::{Tree, TreePlugin},
};
use std::time::Duration;

/// An app without a renderer in which a young oak is grown, and that oak.
fn app() -> (tempfile::TempDir, App, Entity) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("oak.species.ron");
    std::fs::write(&path, include_str!("../../../../assets/species/oak.species.ron")).unwrap();
    let mut workbench = Workbench::new(Some(path.as_path()), None, None, true);
    workbench.is_open = true;
    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), AssetPlugin::default(), TreePlugin))
        .insert_resource(workbench)
        .init_resource::<Applied>()
        .add_systems(Update, apply_species.before(WindwoodSystems::Bake))
        .add_systems(PostUpdate, note_tree);
    app.update();
    let workbench = app.world().resource::<Workbench>();
    let stand = workbench.stage.stands(default())[0];
    let tree = Tree::new(workbench.shown.clone()).with_age(2.0);
    let tree = app.world_mut().spawn((StageTree { place: 0, stand }, tree)).id();
    wait(&mut app, |world| world.get::<Grown>(tree).is_some());
    draw(&mut app, tree);
    (folder, app, tree)
}

fn wait(app: &mut App, mut is_there: impl FnMut(&mut World) -> bool) {
    for _ in 0..10_000 {
        app.update();
        if is_there(app.world_mut()) {
            return;
        }
        std::thread::sleep(Duration::from_millis(1));
    }
    panic!("it did not come");
}

/// What a renderer would do.
fn draw(app: &mut App, tree: Entity) {
    app.world_mut().spawn((TreeMeshOf(tree), Mesh3d::default()));
    app.update();
}

fn model(world: &World, tree: Entity) -> AssetId<TreeModel> {
    world.get::<Grown>(tree).unwrap().model.id()
}

fn change(app: &mut App, change: impl FnOnce(&mut Species)) {
    let mut workbench = app.world_mut().resource_mut::<Workbench>();
    let mut species = workbench.species().clone();
    change(&mut species);
    workbench.change(species, "test");
}

#[test]
fn a_changed_species_is_grown_and_the_time_is_told() {
    let (_folder, mut app, tree) = app();
    let before = model(app.world(), tree);
    change(&mut app, |species| species.wood.density_kg_m3 = 700.0);
    app.update();
    assert!(app.world().resource::<Workbench>().tree.is_growing);
    wait(&mut app, |world| model(world, tree) != before);
    draw(&mut app, tree);
    let facts = app.world().resource::<Workbench>().tree.clone();
    assert!(!facts.is_growing && facts.grown_in_ms.is_some() && facts.beams > 0, "{facts:?}");
}

#[test]
fn a_species_that_cannot_grow_leaves_the_last_good_tree() {
    let (_folder, mut app, tree) = app();
    let before = model(app.world(), tree);
    change(&mut app, |species| species.wood.density_kg_m3 = -1.0);
    for _ in 0..50 {
        app.update();
    }
    assert_eq!(model(app.world(), tree), before);
    assert!(app.world().resource::<Assets<TreeModel>>().get(before).is_some());
}

#[test]
fn a_tree_that_is_being_grown_can_be_cancelled() {
    let (_folder, mut app, _) = app();
    let good = app.world().resource::<Workbench>().species().clone();
    change(&mut app, |species| species.wood.density_kg_m3 = 700.0);
    app.update();
    app.world_mut().resource_mut::<Workbench>().is_cancelled = true;
    app.update();
    let workbench = app.world().resource::<Workbench>();
    assert_eq!(*workbench.species(), good);
    assert_eq!(workbench.session.undo_step(), Some("Cancel"));
}

#[test]
fn many_changes_end_with_the_last() {
    let (_folder, mut app, tree) = app();
    for step in 1..=30 {
        change(&mut app, |species| species.wood.density_kg_m3 = 600.0 + step as f32);
        app.update();
    }
    wait(&mut app, |world| {
        let shown = world.resource::<Workbench>().shown.id();
        let models = world.resource::<SpeciesModels>();
        !models.is_baking() && models.get(shown).is_some_and(|entry| entry.species.wood.density_kg_m3 == 630.0)
    });
    assert!(app.world().get::<Grown>(tree).is_some());
}
