//! Trees that fall, as a game sees them: without rendering.

use bevy::{math::DVec2, prelude::*, time::TimeUpdateStrategy};
use bevy_windwood::{
    forest::{ForestCells, TreeFelled},
    prelude::*,
    scatter::{ForestPlan, plan::Area},
    tree::TreeModel,
};
use std::time::Duration;

const SLOPE: f64 = 0.3;

fn app(frame_s: f32) -> App {
    let mut app = App::new();
    app.add_plugins((MinimalPlugins, TransformPlugin, AssetPlugin::default(), WindwoodMinimalPlugins));
    app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs_f32(frame_s)));
    app.finish();
    app.cleanup();
    app.world_mut().spawn(Terrain::new(|at: DVec2| SLOPE * at.x));
    app
}

fn wait(app: &mut App, is_done: impl Fn(&mut World) -> bool) {
    for _ in 0..6000 {
        app.update();
        std::thread::sleep(Duration::from_millis(2));
        if is_done(app.world_mut()) {
            return;
        }
    }
    panic!("it did not come about");
}

/// A young oak with its model.
fn oak(app: &mut App) -> Entity {
    let species = app.world_mut().resource_mut::<Assets<Species>>().add(Species { variants: 1, ..default() });
    let at = Transform::from_xyz(10.0, (SLOPE * 10.0) as f32, 0.0).with_rotation(Quat::from_rotation_y(1.0));
    let tree = app.world_mut().spawn((Tree::new(species).with_age(25.0), at)).id();
    wait(app, |world| world.get::<Grown>(tree).is_some());
    tree
}

/// Lets a tree fall. Returns the time that it takes, s.
fn fall(app: &mut App, tree: Entity, falling: FallingTree, frame_s: f32) -> f32 {
    app.world_mut().entity_mut(tree).insert(falling);
    let mut frames = 0.0;
    while app.world().get::<FallenTree>(tree).is_none() {
        app.update();
        frames += 1.0;
        assert!(frames * frame_s < 30.0, "it is still standing");
        let at = app.world().get::<Transform>(tree).expect("a tree");
        assert!(at.is_finite() && at.rotation.is_normalized());
    }
    frames * frame_s
}

/// The direction of a tree's stem, and its height.
fn stem(app: &App, tree: Entity) -> (Vec3, f32) {
    let at = app.world().get::<Transform>(tree).expect("a tree");
    let grown = app.world().get::<Grown>(tree).expect("a model");
    let model = app.world().resource::<Assets<TreeModel>>().get(&grown.model).expect("it is baked");
    (at.rotation * Vec3::Y, model.height_m())
}

#[test]
fn a_tree_falls_where_it_is_to_and_rests_on_the_slope() {
    let mut app = app(1.0 / 60.0);
    let (up_hill, down_hill) = (oak(&mut app), oak(&mut app));
    for (tree, x) in [(up_hill, 1.0), (down_hill, -1.0)] {
        let falling = FallingTree { direction: Some(Vec2::new(x, 0.0)), cut_m: 0.3 };
        fall(&mut app, tree, falling, 1.0 / 60.0);
        let (along, height_m) = stem(&app, tree);
        // The stem lies on ground that falls away by 0.3 from its cut, or rises.
        let slope = along.y / along.x;
        let tolerance = 0.35 / (height_m - 0.3);
        assert!(along.x * x > 0.9 && along.z.abs() < 1e-3, "{along}");
        assert!((slope - SLOPE as f32).abs() < tolerance, "{slope} for {SLOPE}, a tree of {height_m} m");
        assert!(app.world().get::<FallingTree>(tree).is_none());
    }
    let world = app.world_mut();
    let stumps: Vec<(Stump, Vec3)> =
        world.query::<(&Stump, &Transform)>().iter(world).map(|(stump, at)| (*stump, at.translation)).collect();
    assert_eq!(stumps.len(), 2);
    for (stump, at) in stumps {
        assert!(stump.height_m == 0.3 && (0.02..0.5).contains(&stump.radius_m), "{stump:?}");
        assert_eq!(at, Vec3::new(10.0, 3.0, 0.0));
    }
    // It stays where it is.
    let before = *app.world().get::<Transform>(up_hill).expect("a tree");
    (0..100).for_each(|_| app.update());
    assert_eq!(*app.world().get::<Transform>(up_hill).expect("a tree"), before);
}

#[test]
fn a_fall_takes_the_same_time_at_any_frame_rate_and_none_while_time_is_paused() {
    let times_s = [1.0 / 120.0, 1.0 / 25.0].map(|frame_s| {
        let mut app = app(frame_s);
        let tree = oak(&mut app);
        let falling = FallingTree { direction: Some(Vec2::Y), ..default() };
        app.world_mut().entity_mut(tree).insert(falling);
        app.world_mut().resource_mut::<Time<Virtual>>().pause();
        (0..200).for_each(|_| app.update());
        let up = stem(&app, tree).0;
        assert!(up.y > 0.9999, "{up}");
        app.world_mut().resource_mut::<Time<Virtual>>().unpause();
        fall(&mut app, tree, falling, frame_s)
    });
    // Seconds for a tree of some metres; they differ by a frame or two.
    assert!((1.0..8.0).contains(&times_s[0]) && (times_s[0] - times_s[1]).abs() <= 0.09, "{times_s:?}");
}

#[test]
fn without_a_direction_it_falls_to_its_heavy_side_and_bad_numbers_do_no_harm() {
    let mut app = app(1.0 / 60.0);
    for direction in [None, Some(Vec2::ZERO), Some(Vec2::NAN)] {
        let tree = oak(&mut app);
        fall(&mut app, tree, FallingTree { direction, cut_m: f32::NAN }, 1.0 / 60.0);
        assert!(stem(&app, tree).0.y.abs() < 0.5);
    }
}

#[test]
fn a_felled_tree_of_a_forest_falls_and_goes_with_its_cell() {
    let mut app = app(1.0 / 60.0);
    let plan = ForestPlan { cell_m: 32.0, areas: vec![Area::default()], ..default() };
    let plan = app.world_mut().resource_mut::<Assets<ForestPlan>>().add(plan);
    let settings = ForestSettings { trees_to_m: 60.0, far_to_m: 0.0, ..default() };
    let forest = app.world_mut().spawn((Forest::new(plan), settings)).id();
    let viewer = app.world_mut().spawn(Viewpoint).id();
    wait(&mut app, |world| {
        let is_complete = world.get::<ForestCells>(forest).is_some_and(ForestCells::is_complete);
        let mut without_model = world.query_filtered::<(), (With<StemId>, Without<Grown>)>();
        is_complete && without_model.iter(world).next().is_none()
    });
    let world = app.world_mut();
    let id = *world.query::<&StemId>().iter(world).next().expect("a tree");
    world.get_mut::<ForestChanges>(forest).expect("changes").fell(id).expect("it stands");
    app.update();
    let tree = app.world_mut().resource_mut::<Messages<TreeFelled>>().drain().next().expect("a message").tree;
    let tree = tree.expect("it is near");
    assert!(app.world().get::<FallingTree>(tree).is_some() && app.world().get::<StemId>(tree).is_none());
    wait(&mut app, |world| world.get::<FallenTree>(tree).is_some());
    let stumps = |app: &mut App| {
        let world = app.world_mut();
        world.query::<&Stump>().iter(world).count()
    };
    assert_eq!(stumps(&mut app), 1);
    *app.world_mut().get_mut::<Transform>(viewer).expect("a viewer") = Transform::from_xyz(700.0, 0.0, 0.0);
    wait(&mut app, |world| world.get_entity(tree).is_err());
    assert_eq!(stumps(&mut app), 0);
}
