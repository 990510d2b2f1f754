//! Rays, colliders and listeners as a game asks for them, without rendering.

#[path = "support/server.rs"]
mod server;

use bevy::{ecs::system::RunSystemOnce, prelude::*, time::TimeUpdateStrategy};
use bevy_windwood::{
    prelude::*,
    query::{TreeTrace, WindAt},
    tree::{TreeModel, TreePlaces, body::TreeCapsule},
};
use server::{server_app, shipped_assets};
use std::time::Duration;

const FRAME_S: f32 = 1.0 / 30.0;

fn app() -> App {
    server_app(&shipped_assets(), Duration::from_secs_f32(FRAME_S))
}

fn plant(app: &mut App, species: &str, at: Transform) -> Entity {
    let species = app.world().resource::<AssetServer>().load(format!("species/{species}.species.ron"));
    app.world_mut().spawn((Tree::new(species).with_seed(1).with_age(40.0), at)).id()
}

/// Lets all that is asked for come about, with the clock standing still.
fn settle(app: &mut App) {
    app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::ZERO));
    let ready = (0..12_000).any(|_| {
        app.update();
        std::thread::sleep(Duration::from_millis(5));
        let world = app.world_mut();
        let waiting = world.query_filtered::<(), (With<Tree>, Without<Grown>)>().iter(world).count();
        let (asked, active) = (world.resource::<Wind>().speed, world.resource::<ActiveWind>());
        let is_asked = active.newest().is_some_and(|field| field.settings().speed == asked);
        waiting == 0 && is_asked && active.is_settled() && world.resource::<ActiveSway>().is_settled()
    });
    assert!(ready, "trees and wind did not come about in a minute");
    app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs_f32(FRAME_S)));
    (0..3).for_each(|_| app.update());
}

fn ask<T: 'static>(app: &mut App, what: impl Fn(TreeRays) -> T + Send + Sync + 'static) -> T {
    app.world_mut().run_system_once(move |rays: TreeRays| what(rays)).expect("a system that runs")
}

fn trace(app: &mut App, from: Vec3, to: Vec3) -> TreeTrace {
    let (direction, length_m) = Dir3::new_and_length(to - from).expect("two places");
    ask(app, move |rays| rays.trace(from, direction, length_m))
}

fn wind_at(app: &mut App, place: Vec3) -> WindAt {
    wind_above(app, place, None)
}

fn wind_above(app: &mut App, place: Vec3, ground_m: Option<f32>) -> WindAt {
    let system = move |wind: WindInTrees| wind.at(place, ground_m);
    app.world_mut().run_system_once(system).expect("a system that runs")
}

/// The poses that rays meet are those of the crate's own articulated trees, whose beams and leaves are checked elsewhere.
#[test]
fn limbs_are_where_those_of_an_articulated_tree_are() {
    let mut app = app();
    let at =
        Transform::from_xyz(40.0, 3.0, -20.0).with_rotation(Quat::from_rotation_y(0.8)).with_scale(Vec3::splat(1.3));
    let tree = plant(&mut app, "oak", at);
    let articulated = plant(&mut app, "oak", at);
    app.world_mut().entity_mut(articulated).insert(Articulated { deepest_order: 0, leaves: false });
    app.world_mut().resource_mut::<Wind>().speed = 16.0;
    settle(&mut app);
    let mut places = Vec::new();
    for _ in 0..8 {
        (0..10).for_each(|_| app.update());
        let pair = [tree, articulated].map(|tree| ask(&mut app, move |rays| rays.capsules(tree, 0.0)));
        assert!(pair[0].len() > 40 && pair[0].len() == pair[1].len());
        for (one, other) in pair[0].iter().zip(&pair[1]) {
            assert!(one.a.distance(other.a) < 1e-3 && one.b.distance(other.b) < 1e-3, "{one:?} and {other:?}");
        }
        places.push(pair[0].iter().map(|capsule| capsule.b.y.to_bits()).collect::<Vec<_>>());
    }
    places.dedup();
    assert!(places.len() > 6, "limbs move in the wind");
}

#[test]
fn a_bullet_hits_the_trunk_and_leaves_hide_what_is_behind() {
    let mut app = app();
    let tree = plant(&mut app, "oak", Transform::from_xyz(10.0, 0.0, 0.0));
    settle(&mut app);
    let trunk = ask(&mut app, move |rays| rays.capsules(tree, 0.05));
    let height_m = 1.0;
    let shot = trace(&mut app, Vec3::new(-20.0, height_m, 0.0), Vec3::new(40.0, height_m, 0.0));
    let hit = shot.wood.expect("the trunk is in the way");
    assert_eq!((hit.tree, shot.clear_share()), (tree, 0.0));
    let TreeCapsule { a, b, radius_m, beam } = trunk[0];
    let share = (height_m - a.y) / (b.y - a.y);
    let axis = a.lerp(b, share);
    assert_eq!(hit.beam, beam);
    assert!((hit.distance_m - (axis.x + 20.0 - radius_m)).abs() < 0.1, "{hit:?} on {trunk:?}");
    assert!(hit.normal.x < -0.8 && hit.position.distance(axis) < radius_m + 0.1);
    let short = trace(&mut app, Vec3::new(-20.0, height_m, 0.0), Vec3::new(5.0, height_m, 0.0));
    assert_eq!((short.wood, short.transmittance), (None, 1.0));

    let model = app.world().get::<Grown>(tree).expect("it has grown").model.clone();
    let model = app.world().resource::<Assets<TreeModel>>().get(&model).expect("its model").clone();
    let sight = |app: &mut App| {
        let rows = (0..40).map(|k| 0.5 * model.height_m() + 0.01 * model.height_m() * k as f32);
        let rows: Vec<f32> = rows.collect();
        ask(app, move |rays| {
            let through = |y: &f32| rays.trace(Vec3::new(10.3, *y, -30.0), Dir3::Z, 60.0).transmittance;
            rows.iter().map(through).sum::<f32>() / rows.len() as f32
        })
    };
    let summer = sight(&mut app);
    *app.world_mut().resource_mut::<Season>() = Season::WINTER;
    app.update();
    let winter = sight(&mut app);
    assert!(summer < 0.5 && winter > summer + 0.2, "{summer} in summer, {winter} in winter");
    let beside = ask(&mut app, |rays| rays.sight(Vec3::new(60.0, 5.0, -30.0), Vec3::new(60.0, 5.0, 30.0)));
    assert_eq!(beside, 1.0);
}

#[test]
fn trees_that_move_and_go_are_met_where_they_are() {
    let mut app = app();
    let tree = plant(&mut app, "birch", Transform::default());
    settle(&mut app);
    let hits =
        |app: &mut App, x: f32| trace(app, Vec3::new(x - 8.0, 0.7, 0.0), Vec3::new(x + 8.0, 0.7, 0.0)).wood.is_some();
    assert!(hits(&mut app, 0.0) && !hits(&mut app, 100.0));
    app.world_mut().get_mut::<Transform>(tree).expect("it is there").translation.x = 100.0;
    (0..2).for_each(|_| app.update());
    assert!(!hits(&mut app, 0.0) && hits(&mut app, 100.0));
    app.world_mut().entity_mut(tree).despawn();
    (0..2).for_each(|_| app.update());
    assert!(!hits(&mut app, 100.0));
    assert!(app.world().resource::<TreePlaces>().is_empty());
}

#[test]
fn colliders_come_and_go_with_the_viewer() {
    let mut app = app();
    let trees: Vec<Entity> =
        (0..20).map(|k| plant(&mut app, "birch", Transform::from_xyz(10.0 * k as f32, 0.0, 0.0))).collect();
    let viewer = app.world_mut().spawn(Viewpoint).id();
    settle(&mut app);
    let given = |app: &mut App| {
        let world = app.world_mut();
        world.query::<&TreeColliders>().iter(world).map(|colliders| colliders.capsules.len()).collect::<Vec<_>>()
    };
    assert!(given(&mut app).is_empty(), "nobody has asked for them");
    let settings = TreeColliderSettings { to_m: 35.0, least_radius_m: 0.03, trees_per_frame: 1 };
    app.insert_resource(settings);
    app.update();
    app.update();
    assert!(given(&mut app).len() <= 2, "one in a frame");
    (0..10).for_each(|_| app.update());
    let there = given(&mut app);
    assert_eq!(there.len(), 4, "trees at 0, 10, 20 and 30 m");
    assert!(there.iter().all(|capsules| *capsules > 0));
    app.world_mut().get_mut::<Transform>(viewer).expect("it is there").translation.x = 190.0;
    (0..12).for_each(|_| app.update());
    assert_eq!(given(&mut app).len(), 4);
    assert!(
        app.world().get::<TreeColliders>(trees[0]).is_none() && app.world().get::<TreeColliders>(trees[19]).is_some()
    );
    app.insert_resource(TreeColliderSettings { to_m: f32::NAN, ..settings });
    (0..2).for_each(|_| app.update());
    assert_eq!(given(&mut app).len(), 4, "the last good settings stay");
    app.insert_resource(TreeColliderSettings { to_m: 0.0, ..settings });
    (0..2).for_each(|_| app.update());
    assert!(given(&mut app).is_empty());
}

#[test]
fn trees_shelter_a_place_and_the_wind_is_continuous_there() {
    let mut app = app();
    let stand = InCanopy(Canopy { height_m: 20.0, frontal_area_index: 2.0, exposure: [0.0; 8] });
    for k in 0..25 {
        let tree = plant(&mut app, "birch", Transform::from_xyz(4.0 * (k % 5) as f32, 2.0, 4.0 * (k / 5) as f32));
        app.world_mut().entity_mut(tree).insert(stand);
    }
    settle(&mut app);
    let time_s = app.world().resource::<WindClock>().time_s;
    let far = wind_at(&mut app, Vec3::new(300.0, 10.0, 0.0));
    let open = app.world().resource::<ActiveWind>().sample(Vec3::new(300.0, 10.0, 0.0), time_s);
    assert!(far.velocity.distance(open) < 1e-4, "{} in the open, not {open}", far.velocity);
    assert!((far.mean_m_s - 8.0).abs() < 0.01 && (1.0..3.0).contains(&far.deviation_m_s), "{far:?}");
    let inside = wind_at(&mut app, Vec3::new(8.0, 3.5, 8.0));
    assert!(inside.mean_m_s < 0.35 * far.mean_m_s, "{inside:?}");
    assert!(inside.deviation_m_s / inside.mean_m_s > far.deviation_m_s / far.mean_m_s, "gustier");
    let mut before = wind_above(&mut app, Vec3::new(-30.0, 3.5, 8.0), Some(2.0));
    for step in 1..=600 {
        let now = wind_above(&mut app, Vec3::new(-30.0 + 0.1 * step as f32, 3.5, 8.0), Some(2.0));
        assert!((now.mean_m_s - before.mean_m_s).abs() < 0.35, "{before:?} to {now:?} at step {step}");
        before = now;
    }
    assert_eq!(wind_at(&mut app, Vec3::NAN), WindAt::default());
}

#[test]
fn listeners_hear_more_in_a_stronger_wind_and_nothing_in_winter() {
    let mut app = app();
    for k in 0..16 {
        plant(&mut app, "birch", Transform::from_xyz(6.0 * (k % 4) as f32, 0.0, 6.0 * (k / 4) as f32));
    }
    let near = app.world_mut().spawn((WindListener::default(), Transform::from_xyz(9.0, 1.7, 9.0))).id();
    let far = app.world_mut().spawn((WindListener::default(), Transform::from_xyz(900.0, 1.7, 9.0))).id();
    let heard = |app: &mut App, listener| *app.world().get::<WindListener>(listener).expect("it listens");
    let mean = |app: &mut App, listener| {
        let mut sum = 0.0;
        (0..120).for_each(|_| {
            app.update();
            let WindListener { rustle_level, gust_level, velocity, .. } = heard(app, listener);
            assert!((0.0..=1.0).contains(&rustle_level) && (0.0..=1.0).contains(&gust_level) && velocity.is_finite());
            sum += rustle_level;
        });
        sum / 120.0
    };
    let mut levels = Vec::new();
    for speed in [3.0, 8.0, 18.0] {
        app.world_mut().resource_mut::<Wind>().speed = speed;
        app.world_mut().resource_mut::<Wind>().fade_s = 0.0;
        settle(&mut app);
        (0..200).for_each(|_| app.update());
        settle(&mut app);
        levels.push(mean(&mut app, near));
        assert_eq!(heard(&mut app, far).rustle_level, 0.0);
    }
    assert!(levels[0] > 0.02 && levels[1] > levels[0] + 0.1 && levels[2] > levels[1] + 0.1, "{levels:?}");

    app.world_mut().resource_mut::<Time<Virtual>>().pause();
    app.update();
    let still = heard(&mut app, near);
    (0..5).for_each(|_| app.update());
    assert_eq!(heard(&mut app, near), still, "a pause");
    app.world_mut().resource_mut::<Time<Virtual>>().unpause();
    *app.world_mut().resource_mut::<Season>() = Season::WINTER;
    (0..120).for_each(|_| app.update());
    assert!(heard(&mut app, near).rustle_level < 0.01, "bare trees do not rustle");
}

#[test]
fn a_source_is_felt_and_heard_among_trees() {
    let mut app = app();
    for k in 0..9 {
        let tree = plant(&mut app, "birch", Transform::from_xyz(4.0 * (k % 3) as f32, 0.0, 4.0 * (k / 3) as f32));
        app.world_mut().entity_mut(tree).insert(InCanopy(Canopy {
            height_m: 15.0,
            frontal_area_index: 1.0,
            exposure: [0.0; 8],
        }));
    }
    settle(&mut app);
    let place = Vec3::new(4.0, 6.0, 4.0);
    let listener = app.world_mut().spawn((WindListener::default(), Transform::from_translation(place))).id();
    (0..60).for_each(|_| app.update());
    let heard = |app: &App| app.world().get::<WindListener>(listener).expect("it listens").rustle_level;
    let without = heard(&app);
    let jet = SourceKind::Cone { speed_m_s: 25.0, nozzle_radius_m: 3.0, half_angle_deg: 15.0 };
    app.world_mut().spawn((WindSource::new(jet), Transform::from_translation(place + Vec3::Z * 9.0)));
    (0..60).for_each(|_| app.update());
    let blown = wind_at(&mut app, place);
    let loud = heard(&app);
    assert!(loud > without + 0.1, "{loud} after {without}");
    // At the same moment without it: all that differs is what it blows.
    let source = app.world().resource::<WindSources>().velocity(place);
    assert!(source.length() > 5.0, "{source}");
    app.insert_resource(WindSources::default());
    let alone = wind_at(&mut app, place);
    assert!((blown.velocity - alone.velocity).distance(source) < 1e-4, "{} after {}", blown.velocity, alone.velocity);
    assert_eq!((blown.mean_m_s, blown.deviation_m_s), (alone.mean_m_s, alone.deviation_m_s));
}
