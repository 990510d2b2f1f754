//! What a forest plants: each cell once, for the store of stems and for the near trees, and again only where a plan has changed.

use bevy::{math::DVec2, prelude::*};
use bevy_windwood::{
    Ground,
    forest::ForestCells,
    prelude::*,
    scatter::{
        ForestPlan, Planter,
        plan::{Area, Shape},
    },
};
use std::{
    collections::BTreeSet,
    sync::{
        Arc,
        atomic::{AtomicUsize, Ordering},
    },
};

fn plan() -> ForestPlan {
    let shape = Shape::Rectangle { min_m: [-2000.0; 2], max_m: [2000.0; 2] };
    ForestPlan { cell_m: 32.0, areas: vec![Area { shape, ..default() }], ..default() }
}

/// An app with a forest on that ground, and one who looks at it from the origin. Its species do not exist: nothing is asked about the
/// wind among its trees.
fn forest_app(ground: Arc<CountingGround>) -> (App, Entity) {
    let mut app = App::new();
    app.add_plugins((MinimalPlugins, TransformPlugin, AssetPlugin::default(), WindwoodMinimalPlugins));
    app.finish();
    app.cleanup();
    let plan = app.world_mut().resource_mut::<Assets<ForestPlan>>().add(plan());
    let species_folder = "none".into();
    let settings = ForestSettings { trees_to_m: 90.0, far_to_m: 400.0, species_folder, ..default() };
    app.world_mut().spawn(Viewpoint);
    let forest = app.world_mut().spawn((Forest::new(plan), settings, ForestGround(ground))).id();
    app.update();
    (app, forest)
}

/// Level ground that counts how often it is asked.
#[derive(Default)]
struct CountingGround(AtomicUsize);

impl CountingGround {
    fn count(&self) -> usize {
        self.0.load(Ordering::Relaxed)
    }
}

impl Ground for CountingGround {
    fn height_m(&self, _: DVec2) -> f64 {
        self.0.fetch_add(1, Ordering::Relaxed);
        0.0
    }

    fn gradient(&self, _: DVec2) -> DVec2 {
        DVec2::ZERO
    }
}

fn wait_until_planted(app: &mut App) {
    for _ in 0..4000 {
        app.update();
        let world = app.world_mut();
        if world.query::<&ForestCells>().iter(world).all(|forest| forest.is_planted() && forest.is_complete()) {
            return;
        }
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    panic!("the forest was not planted in time");
}

#[test]
fn each_cell_is_planted_once_for_the_store_and_the_near_trees() {
    let ground = Arc::new(CountingGround::default());
    let (mut app, _) = forest_app(ground.clone());
    wait_until_planted(&mut app);
    let asked = ground.count();
    let world = app.world_mut();
    assert!(world.query::<&Tree>().iter(world).count() > 100);
    // Independently: each known cell once.
    let world = app.world_mut();
    let store = world.query::<&ForestCells>().single(world).unwrap().store();
    let (planter, alone, mut planted) = (Planter::new(&plan()).unwrap(), CountingGround::default(), Vec::new());
    for (cell, _) in store.iter() {
        planter.plant(cell, &alone, &mut planted);
    }
    assert!(store.len() > 400);
    assert_eq!(asked, alone.count());
}

/// Bits of the place of every known stem.
fn stems(app: &mut App) -> BTreeSet<[u32; 3]> {
    let world = app.world_mut();
    let store = world.query::<&ForestCells>().single(world).unwrap().store();
    store
        .iter()
        .flat_map(|(cell, _)| store.stems(cell))
        .map(|stem| stem.position.to_array().map(f32::to_bits))
        .collect()
}

#[test]
fn an_edited_plan_leaves_the_known_stems_that_both_have() {
    let (mut app, _) = forest_app(Arc::default());
    wait_until_planted(&mut app);
    let before = stems(&mut app);
    let is_east = |stem: &&[u32; 3]| f32::from_bits(stem[0]) > 50.0;
    let wanted: BTreeSet<_> = before.iter().filter(is_east).copied().collect();
    assert!(wanted.len() > 500 && wanted.len() < before.len());

    // Nothing grows to the west any more.
    change_plan(&mut app);
    for _ in 0..100 {
        app.update();
        assert!(wanted.is_subset(&stems(&mut app)), "stems of both plans were lost");
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    wait_until_planted(&mut app);
    assert!(stems(&mut app).iter().all(|stem| f32::from_bits(stem[0]) >= 0.0));

    // As if the forest had always been of the new plan.
    let (mut fresh, forest) = forest_app(Arc::default());
    change_plan(&mut fresh);
    fresh.world_mut().entity_mut(forest).remove::<ForestCells>();
    (0..3).for_each(|_| fresh.update());
    wait_until_planted(&mut fresh);
    assert_eq!(stems(&mut app), stems(&mut fresh));
}

fn change_plan(app: &mut App) {
    let mut plans = app.world_mut().resource_mut::<Assets<ForestPlan>>();
    let id = plans.ids().next().unwrap();
    plans.get_mut(id).unwrap().areas[0].shape = Shape::Rectangle { min_m: [0.0, -2000.0], max_m: [2000.0; 2] };
}
