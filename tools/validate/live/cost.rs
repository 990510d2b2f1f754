//! What trees cost that are touched, and a million that are not: without a renderer, by the time of our own systems.

use crate::report::Report;
use bevy::{prelude::*, time::TimeUpdateStrategy};
use bevy_windwood::{SystemTimes, prelude::*, tree::TreeModel};
use std::time::Duration;

const TOUCHED: u32 = 1000;
const ASLEEP: u32 = 1_000_000;
/// Frames of which the median is taken.
const FRAMES: usize = 120;
const SPACING_M: f32 = 6.0;
/// The systems that have to do with trees that are touched, and with what touches them.
const SYSTEMS: [&str; 6] =
    ["advance_sources", "gather_pushers", "index_trees", "wake_trees", "step_live_trees", "rest_live_trees"];

pub fn run(report: &mut Report) -> Result<(), String> {
    touched(report)?;
    asleep(report)
}

/// An app in a breeze in which so many trees of a species stand on a square and have their models.
fn planted(species: &str, count: u32) -> Result<App, String> {
    let mut app = App::new();
    app.add_plugins((MinimalPlugins, TransformPlugin, AssetPlugin::default(), WindwoodMinimalPlugins));
    app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs_f64(1.0 / 60.0)));
    app.finish();
    app.cleanup();
    let species = app.world().resource::<AssetServer>().load(format!("species/{species}.species.ron"));
    let side = f64::from(count).sqrt().ceil() as u32;
    let trees = (0..count).map(|number| {
        let place = Vec3::new((number % side) as f32, 0.0, (number / side) as f32) * SPACING_M;
        (Tree::new(species.clone()), Transform::from_translation(place))
    });
    app.world_mut().spawn_batch(trees.collect::<Vec<_>>());
    for _ in 0..4000 {
        app.update();
        let world = app.world_mut();
        let is_grown = world.query_filtered::<(), (With<Tree>, Without<Grown>)>().iter(world).next().is_none();
        if is_grown && world.resource::<ActiveSway>().is_settled() {
            return Ok(app);
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    Err(format!("{count} trees did not grow in time"))
}

/// Median time of those of our systems whose names are given, over some frames, us.
fn median_us(app: &mut App, systems: &[&str]) -> f64 {
    let mut times: Vec<f64> = (0..FRAMES)
        .map(|_| {
            app.update();
            let times = app.world().resource::<SystemTimes>();
            times.iter().filter(|(name, _)| systems.contains(name)).map(|(_, time)| time.as_secs_f64() * 1e6).sum()
        })
        .collect();
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

/// A great vortex turns about the middle of a wood.
fn touched(report: &mut Report) -> Result<(), String> {
    let mut app = planted("oak", TOUCHED)?;
    let middle_m = 0.5 * SPACING_M * f64::from(TOUCHED).sqrt() as f32;
    let kind = SourceKind::Vortex { speed_m_s: 15.0, core_radius_m: 60.0, length_m: 200.0, spreading_m2_s: 0.0 };
    let source = WindSource::new(kind).with_reach(400.0);
    let vortex = app.world_mut().spawn((source, Transform::from_xyz(middle_m, 5.0, middle_m))).id();
    (0..60).for_each(|_| app.update());
    let world = app.world_mut();
    let awake = world.query::<&LiveSway>().iter(world).count();
    let model = world.query::<&Grown>().iter(world).next().ok_or("no tree has grown")?.model.clone();
    let beams = world.resource::<Assets<TreeModel>>().get(&model).map_or(0, |model| model.beams.len());
    if awake != TOUCHED as usize {
        return Err(format!("{awake} trees are awake, of {TOUCHED}"));
    }
    report.record("touched_1000_us", median_us(&mut app, &SYSTEMS), "a frame, 1000 oaks in a vortex");
    report.record("touched_beams", beams as f64, "beams of one of them");
    app.world_mut().despawn(vortex);
    (0..10).for_each(|_| app.update());
    report.record("swaying_1000_us", median_us(&mut app, &SYSTEMS), "a frame, the same while they come to rest");
    Ok(())
}

/// A source blows, and a body stands, in a clearing far from all trees.
fn asleep(report: &mut Report) -> Result<(), String> {
    let mut app = planted("hazel", ASLEEP)?;
    (0..30).for_each(|_| app.update());
    let by_tree = |us: f64| us * 1e3 / f64::from(ASLEEP);
    let still = by_tree(median_us(&mut app, &SYSTEMS));
    report.at_most("sleep_cost_ns", still, 0.1, "a tree and frame, a million trees of which none is touched");
    app.world_mut().spawn((WindSource::default(), Transform::from_xyz(-500.0, 2.0, -500.0)));
    app.world_mut().spawn((Pusher::default(), Transform::from_xyz(-500.0, 1.0, -500.0)));
    (0..30).for_each(|_| app.update());
    let cause = by_tree(median_us(&mut app, &SYSTEMS));
    report.at_most(
        "sleep_cost_with_cause_ns",
        cause,
        5.0,
        "the same while a source blows elsewhere: who has moved is looked up",
    );
    Ok(())
}
