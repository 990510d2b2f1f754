//! Time as a game has it: paused, slow, saved and loaded, and running for weeks.

#[path = "support/server.rs"]
mod server;

use bevy::{ecs::system::RunSystemOnce, prelude::*, time::TimeUpdateStrategy};
use bevy_windwood::{prelude::*, sway::TreePose};
use server::{server_app, shipped_assets};
use std::time::Duration;

const FRAME: Duration = Duration::from_millis(20);
/// Of the default field, s; that of the fast gusts and that of flutter divide it.
const PERIOD_S: f64 = 128.0;

/// An app with a birch in a wind of 12 m/s, both of which are there.
fn app() -> (App, Entity) {
    let mut app = server_app(&shipped_assets(), Duration::ZERO);
    app.insert_resource(Wind { speed: 12.0, ..default() });
    let birch = app.world().resource::<AssetServer>().load("species/birch.species.ron");
    let tree = Tree::new(birch).with_seed(1).with_age(20.0);
    let tree = app.world_mut().spawn((tree, Articulated::default(), Transform::from_xyz(7.0, 0.0, 3.0))).id();
    let ready = (0..12_000).any(|_| {
        app.update();
        std::thread::sleep(Duration::from_millis(5));
        app.world().get::<TreePose>(tree).is_some() && app.world().resource::<ActiveSway>().is_settled()
    });
    assert!(ready, "the tree and the wind did not come about in a minute");
    app.insert_resource(TimeUpdateStrategy::ManualDuration(FRAME));
    (0..3).for_each(|_| app.update());
    (app, tree)
}

fn clock(app: &App) -> WindClock {
    *app.world().resource::<WindClock>()
}

/// The places of all beams and leaves.
fn places(app: &mut App) -> Vec<Vec3> {
    let world = app.world_mut();
    let parts = |parts: Query<&Transform, Or<(With<Beam>, With<Leaf>)>>| {
        parts.iter().map(|at| at.translation).collect::<Vec<_>>()
    };
    world.run_system_once(parts).expect("a system that runs")
}

fn farthest_m(one: &[Vec3], other: &[Vec3]) -> f32 {
    one.iter().zip(other).map(|(one, other)| one.distance(*other)).fold(0.0, f32::max)
}

/// Sets the clock, as a game does in `Update`, and lets a frame pass.
fn jump_to(app: &mut App, time_s: f64) {
    // The frame's own advance comes before.
    let before_s = app.world().resource::<Time<Virtual>>().delta_secs_f64();
    app.world_mut().resource_mut::<WindClock>().time_s = time_s - before_s;
    app.update();
}

#[test]
fn a_paused_world_is_still_and_a_slow_one_slow() {
    let (mut app, _) = app();
    app.world_mut().resource_mut::<Time<Virtual>>().pause();
    app.update();
    let (still, at) = (places(&mut app), clock(&app));
    for _ in 0..10 {
        app.update();
        assert_eq!(places(&mut app), still);
        assert_eq!(clock(&app), WindClock { time_s: at.time_s, previous_s: at.time_s }, "no motion vectors either");
    }
    app.world_mut().resource_mut::<Time<Virtual>>().unpause();
    app.world_mut().resource_mut::<Time<Virtual>>().set_relative_speed(0.1);
    app.update();
    let before = clock(&app).time_s;
    (0..50).for_each(|_| app.update());
    let passed_s = clock(&app).time_s - before;
    assert!((passed_s - 0.1 * 50.0 * FRAME.as_secs_f64()).abs() < 1e-6, "{passed_s} s in a tenth of the time");
    assert!(farthest_m(&places(&mut app), &still) > 1e-4, "it moves");
}

#[test]
fn a_jump_is_no_motion_and_a_small_correction_is() {
    let (mut app, _) = app();
    for jump_s in [86_400.0, -3600.0, 0.5] {
        let target_s = clock(&app).time_s + jump_s;
        app.add_systems(Update, move |mut clock: ResMut<WindClock>, mut done: Local<bool>| {
            if !std::mem::replace(&mut *done, true) {
                clock.time_s = target_s;
            }
        });
        app.update();
        assert_eq!(clock(&app), WindClock { time_s: target_s, previous_s: target_s });
        app.update();
        let WindClock { time_s, previous_s } = clock(&app);
        assert_eq!(previous_s, target_s);
        assert!((time_s - target_s - FRAME.as_secs_f64()).abs() < 1e-9, "the next frame moves on");
    }
    let before = clock(&app);
    app.add_systems(Update, |mut clock: ResMut<WindClock>, mut done: Local<bool>| {
        if !std::mem::replace(&mut *done, true) {
            clock.time_s += 0.03;
        }
    });
    app.update();
    let WindClock { time_s, previous_s } = clock(&app);
    assert_eq!(previous_s, before.time_s);
    assert!((time_s - previous_s - 0.05).abs() < 1e-9, "a client that catches up");
}

/// A jump starts nothing: no wind, table or model is made anew.
#[test]
fn a_jump_of_a_day_makes_nothing_anew() {
    let (mut app, tree) = app();
    let generation = app.world().resource::<ActiveSway>().generation();
    let model = app.world().get::<Grown>(tree).cloned();
    for day in 1..=20 {
        jump_to(&mut app, 86_400.0 * f64::from(day));
        let (sway, wind) = (app.world().resource::<ActiveSway>(), app.world().resource::<ActiveWind>());
        assert!(sway.is_settled() && wind.is_settled() && sway.generation() == generation);
        assert_eq!(app.world().get::<Grown>(tree).cloned(), model);
    }
}

/// The wind is periodic: after 1,000 hours poses are those of the beginning, and as smooth.
#[test]
fn the_clock_is_fit_for_a_thousand_hours() {
    let (mut app, _) = app();
    let weeks_s = 28_125.0 * PERIOD_S;
    assert_eq!(weeks_s, 1000.0 * 3600.0);
    let mut at = |time_s: f64| {
        jump_to(&mut app, time_s);
        assert!((clock(&app).time_s - time_s).abs() < 1e-6);
        places(&mut app)
    };
    let (first, later) = (at(17.3), at(weeks_s + 17.3));
    // The clock is exact to 1e-9 s; a twig of 10 Hz moves by some m/s.
    assert!(farthest_m(&first, &later) < 1e-4, "{} m", farthest_m(&first, &later));
    let step = farthest_m(&at(17.3 + 1e-3), &first);
    let later_step = farthest_m(&at(weeks_s + 17.3 + 1e-3), &later);
    assert!((step - later_step).abs() < 0.05 * step + 1e-5, "{step} m in a millisecond, later {later_step} m");
}

#[test]
fn clocks_that_are_no_numbers_leave_trees_where_they_may_be() {
    let (mut app, _) = app();
    for odd_s in [f64::NAN, f64::INFINITY, -1e300, 1e300] {
        app.world_mut().resource_mut::<WindClock>().time_s = odd_s;
        (0..3).for_each(|_| app.update());
        assert!(places(&mut app).iter().all(|place| place.is_finite() && place.length() < 60.0), "{odd_s}");
    }
}
