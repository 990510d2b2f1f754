//! Forests as a game sees them: trees that come and go with the viewers, without rendering.

use bevy::{math::DVec2, prelude::*};
use bevy_windwood::{
    forest::{ForestCell, ForestCells},
    prelude::*,
    scatter::{ForestPlan, Planter, plan::Area, plan::GroundLimits, plan::Shape},
    terrain::chunk::drawn_height_m,
};
use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};
use std::{
    collections::BTreeSet,
    time::{Duration, Instant},
};

/// Hills that no triangle follows exactly.
struct Hills;

impl Ground for Hills {
    fn height_m(&self, place: DVec2) -> f64 {
        12.0 * (place.x / 31.0).sin() * (place.y / 17.0).cos()
    }

    fn gradient(&self, place: DVec2) -> DVec2 {
        let (x, z) = (place.x / 31.0, place.y / 17.0);
        12.0 * DVec2::new(x.cos() * z.cos() / 31.0, -x.sin() * z.sin() / 17.0)
    }
}

const TREES_TO_M: f32 = 90.0;
const TREES_PER_FRAME: u32 = 40;

fn plan() -> ForestPlan {
    let shape = Shape::Rectangle { min_m: [-2000.0; 2], max_m: [2000.0; 2] };
    let ground = GroundLimits { steepest_deg: 30.0, ..default() };
    ForestPlan { cell_m: 32.0, areas: vec![Area { shape, ground, ..default() }], ..default() }
}

/// An app with a forest on hills, and one who looks at it from the origin. Its species need not exist.
fn forest_app() -> (App, Entity) {
    let mut app = App::new();
    app.add_plugins((MinimalPlugins, TransformPlugin, AssetPlugin::default(), WindwoodMinimalPlugins));
    app.finish();
    app.cleanup();
    let plan = app.world_mut().resource_mut::<Assets<ForestPlan>>().add(plan());
    let settings = ForestSettings { trees_to_m: TREES_TO_M, trees_per_frame: TREES_PER_FRAME, ..default() };
    app.world_mut().spawn(Terrain::new(Hills));
    app.world_mut().spawn((Forest::new(plan), settings));
    let viewer = app.world_mut().spawn(Viewpoint).id();
    (app, viewer)
}

fn look_from(app: &mut App, viewer: Entity, place: Vec2) {
    *app.world_mut().get_mut::<Transform>(viewer).unwrap() = Transform::from_xyz(place.x, 2.0, place.y);
    // The place is told to all in one update, and the forest looks about in the next.
    app.update();
    for _ in 0..4000 {
        app.update();
        let world = app.world_mut();
        if world.query::<&ForestCells>().iter(world).all(ForestCells::is_complete) {
            // What nobody is near to any more goes, one cell a frame.
            (0..100).for_each(|_| app.update());
            return;
        }
        std::thread::sleep(Duration::from_millis(1));
    }
    panic!("the forest did not come about");
}

/// Bits of every tree's place, turn and size.
fn trees(app: &mut App) -> BTreeSet<[u32; 6]> {
    let world = app.world_mut();
    let bits = |at: &Transform| {
        let ([x, y, z], turn) = (at.translation.to_array(), at.rotation);
        [x, y, z, turn.y, turn.w, at.scale.x].map(f32::to_bits)
    };
    let trees: Vec<_> = world.query_filtered::<&Transform, With<Tree>>().iter(world).map(bits).collect();
    let set: BTreeSet<_> = trees.iter().copied().collect();
    assert_eq!(set.len(), trees.len(), "no tree stands twice");
    set
}

fn places(app: &mut App) -> Vec<Vec3> {
    let world = app.world_mut();
    world.query_filtered::<&Transform, With<Tree>>().iter(world).map(|at| at.translation).collect()
}

#[test]
fn every_tree_that_the_plan_has_near_the_viewer_stands_on_the_drawn_ground() {
    let (mut app, viewer) = forest_app();
    look_from(&mut app, viewer, Vec2::new(13.0, -40.0));
    let (ground, cell_m) = (Hills, f64::from(TerrainSettings::default().finest_cell_m));
    let standing = places(&mut app);
    assert!(standing.len() > 100, "{} trees", standing.len());
    for at in &standing {
        let drawn = drawn_height_m(&ground, cell_m, DVec2::new(f64::from(at.x), f64::from(at.z)));
        assert!((at.y - drawn).abs() < 0.01, "a tree at {at}, where the ground is drawn at {drawn}");
    }
    // Independently of cells: the whole plan, planted on the same ground.
    let planter = Planter::new(&plan()).unwrap();
    let own = bevy_windwood::forest::StandingGround::new(std::sync::Arc::new(Hills), cell_m as f32);
    let (mut planted, mut missing) = (Vec::new(), 0);
    for cell in (-8..8).flat_map(|row| (-8..8).map(move |column| IVec2::new(column, row))) {
        planter.plant(cell, &own, &mut planted);
        let near = planted.iter().filter(|plant| plant.position.xz().distance(Vec2::new(13.0, -40.0)) < TREES_TO_M);
        missing += near.filter(|plant| !standing.contains(&plant.position)).count();
    }
    assert_eq!(missing, 0);
}

#[test]
fn the_same_trees_stand_whatever_way_the_viewer_came() {
    let (mut app, viewer) = forest_app();
    look_from(&mut app, viewer, Vec2::ZERO);
    let first = trees(&mut app);
    look_from(&mut app, viewer, Vec2::new(700.0, 300.0));
    let far = trees(&mut app);
    assert!(first.is_disjoint(&far));
    look_from(&mut app, viewer, Vec2::ZERO);
    assert_eq!(trees(&mut app), first);

    let (mut other, viewer) = forest_app();
    look_from(&mut other, viewer, Vec2::new(900.0, -900.0));
    look_from(&mut other, viewer, Vec2::new(700.0, 300.0));
    assert_eq!(trees(&mut other), far);
}

#[test]
fn no_frame_brings_more_trees_than_it_may() {
    let (mut app, viewer) = forest_app();
    look_from(&mut app, viewer, Vec2::ZERO);
    *app.world_mut().get_mut::<Transform>(viewer).unwrap() = Transform::from_xyz(500.0, 0.0, 0.0);
    let (mut before, mut most) = (trees(&mut app), 0);
    // From the first on that comes, which on a busy machine is late.
    let (begun, mut frames) = (Instant::now(), 0);
    while frames < 200 && begun.elapsed() < Duration::from_secs(60) {
        app.update();
        let now = trees(&mut app);
        most = most.max(now.difference(&before).count());
        before = now;
        frames += usize::from(most > 0);
        std::thread::sleep(Duration::from_millis(1));
    }
    assert!(most > 0 && most <= TREES_PER_FRAME as usize, "{most} trees in a frame");
}

fn living(app: &mut App) -> usize {
    let world = app.world_mut();
    world.query::<Entity>().iter(world).count()
}

#[test]
fn a_long_flight_leaves_no_more_behind_than_a_short_one() {
    let (mut app, viewer) = forest_app();
    look_from(&mut app, viewer, Vec2::ZERO);
    let begun = living(&mut app);
    let mut random = Xoshiro256PlusPlus::seed_from_u64(6);
    for _ in 0..150 {
        let place = Vec2::new(random.random_range(-2500.0..2500.0), random.random_range(-2500.0..2500.0));
        *app.world_mut().get_mut::<Transform>(viewer).unwrap() = Transform::from_xyz(place.x, 0.0, place.y);
        (0..random.random_range(1..6)).for_each(|_| app.update());
    }
    look_from(&mut app, viewer, Vec2::ZERO);
    assert_eq!(living(&mut app), begun);
    let world = app.world_mut();
    assert!(world.query::<&ForestCell>().iter(world).count() < 100);
}

#[test]
fn a_plan_that_cannot_be_planted_leaves_the_last_good_forest() {
    let (mut app, viewer) = forest_app();
    look_from(&mut app, viewer, Vec2::ZERO);
    let good = trees(&mut app);
    let change = |app: &mut App, density_per_ha: f32| {
        let mut plans = app.world_mut().resource_mut::<Assets<ForestPlan>>();
        let id = plans.ids().next().unwrap();
        plans.get_mut(id).unwrap().areas[0].density_per_ha = density_per_ha;
    };
    for bad in [f32::NAN, 1e10, -3.0] {
        change(&mut app, bad);
        (0..5).for_each(|_| app.update());
        assert_eq!(trees(&mut app), good);
    }
    change(&mut app, 40.0);
    (0..3).for_each(|_| app.update());
    look_from(&mut app, viewer, Vec2::ZERO);
    let thin = trees(&mut app);
    assert!(!thin.is_empty() && thin.len() < good.len() / 2, "{} of {}", thin.len(), good.len());
}

/// Every tree: its bits of place, turn and size, and its entity.
fn entities(app: &mut App) -> std::collections::BTreeMap<[u32; 3], Entity> {
    let world = app.world_mut();
    let mut trees = world.query_filtered::<(Entity, &Transform), With<Tree>>();
    trees.iter(world).map(|(tree, at)| (at.translation.to_array().map(f32::to_bits), tree)).collect()
}

#[test]
fn a_changed_plan_keeps_the_trees_that_both_have_and_swaps_the_others() {
    let (mut app, viewer) = forest_app();
    look_from(&mut app, viewer, Vec2::ZERO);
    let before = entities(&mut app);
    // Nothing grows to the west any more.
    let mut plans = app.world_mut().resource_mut::<Assets<ForestPlan>>();
    let id = plans.ids().next().unwrap();
    plans.get_mut(id).unwrap().areas[0].shape = Shape::Rectangle { min_m: [0.0, -2000.0], max_m: [2000.0; 2] };
    let mut fewest = before.len();
    for _ in 0..4000 {
        app.update();
        std::thread::sleep(Duration::from_millis(1));
        let now = entities(&mut app);
        fewest = fewest.min(now.len());
        if now.keys().all(|place| f32::from_bits(place[0]) >= 0.0) {
            break;
        }
    }
    let after = entities(&mut app);
    assert!(after.len() < before.len() * 3 / 4 && fewest == after.len(), "{} to {}", before.len(), after.len());
    assert!(after.keys().all(|place| f32::from_bits(place[0]) >= 0.0));
    let kept = after.iter().filter(|(place, tree)| before.get(*place) == Some(*tree)).count();
    assert_eq!(kept, after.len(), "trees of both plans are the same entities");
}

#[test]
fn an_edit_of_the_budget_moves_no_tree() {
    let (mut app, viewer) = forest_app();
    look_from(&mut app, viewer, Vec2::ZERO);
    let before = entities(&mut app);
    let world = app.world_mut();
    world.query::<&mut ForestSettings>().single_mut(world).unwrap().trees_per_frame = 7;
    for _ in 0..60 {
        app.update();
        std::thread::sleep(Duration::from_millis(1));
        assert_eq!(entities(&mut app), before);
    }
}

#[test]
fn a_removed_forest_leaves_no_trees() {
    let (mut app, viewer) = forest_app();
    look_from(&mut app, viewer, Vec2::ZERO);
    let world = app.world_mut();
    let forest = world.query_filtered::<Entity, With<Forest>>().single(world).unwrap();
    world.entity_mut(forest).remove::<Forest>();
    (0..3).for_each(|_| app.update());
    assert!(entities(&mut app).is_empty() && app.world().get::<ForestCells>(forest).is_none());
}

#[test]
fn a_viewer_who_is_nowhere_is_no_viewer() {
    let (mut app, viewer) = forest_app();
    look_from(&mut app, viewer, Vec2::ZERO);
    let good = trees(&mut app);
    *app.world_mut().get_mut::<Transform>(viewer).unwrap() = Transform::from_xyz(f32::NAN, 0.0, f32::INFINITY);
    (0..10).for_each(|_| app.update());
    assert_eq!(trees(&mut app), good);
}

#[test]
fn near_cells_feel_the_wind_and_the_nearest_trees_are_articulated() {
    let (mut app, viewer) = forest_app();
    let world = app.world_mut();
    world.query::<&mut ForestSettings>().iter_mut(world).for_each(|mut settings| {
        (settings.wind_cells, settings.articulated_to_m) = (true, 30.0);
    });
    look_from(&mut app, viewer, Vec2::ZERO);
    let world = app.world_mut();
    let cells = world.query::<&ForestCell>().iter(world).count();
    let winds: Vec<Vec3> =
        world.query_filtered::<&Transform, With<WindCell>>().iter(world).map(|at| at.translation).collect();
    assert!(winds.len() > 20 && winds.len() <= cells, "{} of {cells}", winds.len());
    assert!(winds.iter().all(|at| (at.y - 10.0).abs() <= 12.0));
    let articulated = |app: &mut App| -> Vec<Vec2> {
        let world = app.world_mut();
        let mut trees = world.query_filtered::<&Transform, (With<Tree>, With<Articulated>)>();
        trees.iter(world).map(|at| at.translation.xz()).collect()
    };
    let near = articulated(&mut app);
    // Cell by cell: whoever is within the distance, and nobody beyond it by more than a cell's diagonal.
    let all = places(&mut app);
    let within = all.iter().filter(|at| at.xz().length() < 30.0).count();
    assert!(within > 20 && near.iter().filter(|at| at.length() < 30.0).count() == within);
    assert!(near.iter().all(|at| at.length() < 30.0 + 32.0 * 1.5) && near.len() < all.len());
    look_from(&mut app, viewer, Vec2::new(60.0, 0.0));
    assert!(articulated(&mut app).iter().all(|at| at.distance(Vec2::new(60.0, 0.0)) < 34.5 + 32.0 * 1.5));
}

#[test]
fn the_forest_tells_who_stands_where() {
    let (mut app, viewer) = forest_app();
    look_from(&mut app, viewer, Vec2::new(13.0, -40.0));
    for _ in 0..2000 {
        app.update();
        let world = app.world_mut();
        if world.query::<&ForestCells>().iter(world).all(ForestCells::is_planted) {
            break;
        }
        std::thread::sleep(Duration::from_millis(1));
    }
    let trees = places(&mut app);
    let world = app.world_mut();
    let mut forests = world.query::<&ForestCells>();
    let store = forests.single(world).unwrap().store();
    let at = Vec2::new(20.0, -30.0);
    let nearest = trees.iter().map(|tree| tree.xz().distance(at)).fold(f32::INFINITY, f32::min);
    let found = store.nearest(at, 100.0).unwrap();
    // Stems are packed to half a millimetre.
    assert!((found.distance_m - nearest).abs() < 2e-3, "{} and {nearest}", found.distance_m);
    let mut count = 0_usize;
    store.within(at, 40.0, |_| count += 1);
    assert!(count.abs_diff(trees.iter().filter(|tree| tree.xz().distance(at) <= 40.0).count()) <= 1);
}

#[test]
fn trees_of_a_wood_stand_in_its_canopy_and_the_first_rows_shelter_the_others() {
    let (mut app, viewer) = forest_app();
    let shape = Shape::Rectangle { min_m: [0.0, -300.0], max_m: [600.0, 300.0] };
    let area = Area { shape, density_per_ha: 80.0, ..default() };
    let wood = ForestPlan { cell_m: 32.0, areas: vec![area], ..default() };
    let plan = app.world_mut().resource_mut::<Assets<ForestPlan>>().add(wood);
    let forest = app.world_mut().query_filtered::<Entity, With<Forest>>().single(app.world()).unwrap();
    app.world_mut().entity_mut(forest).insert(Forest::new(plan));
    look_from(&mut app, viewer, Vec2::new(40.0, 0.0));
    let stands = |app: &mut App| {
        let world = app.world_mut();
        let all = world.query_filtered::<(), With<Tree>>().iter(world).count();
        let mut trees = world.query_filtered::<(&Transform, &InCanopy), With<Tree>>();
        let found: Vec<(Vec3, Canopy)> = trees.iter(world).map(|(at, canopy)| (at.translation, canopy.0)).collect();
        (found.len() == all).then_some(found)
    };
    let found = (0..2000).find_map(|_| {
        app.update();
        std::thread::sleep(Duration::from_millis(1));
        stands(&mut app)
    });
    let found = found.expect("every tree gets its canopy");
    let open_to_x = |from_m: f32, to_m: f32| {
        let rows = found.iter().filter(|(at, _)| (from_m..to_m).contains(&at.x));
        let open: Vec<f32> = rows.map(|(_, canopy)| canopy.exposure[0]).collect();
        open.iter().sum::<f32>() / open.len() as f32
    };
    let [first, second, inner] = [(0.0, 10.0), (20.0, 40.0), (80.0, 120.0)].map(|(from, to)| open_to_x(from, to));
    assert!(first > 0.7 && second < first - 0.1 && inner < 0.2, "{first}, {second}, {inner}");
    assert!(found.iter().all(|(_, canopy)| (5.0..30.0).contains(&canopy.height_m)));
}
