//! Time of a frame in forests of ten thousand to a million trees.
//!
//! A camera flies through forests of 10 km x 10 km in an app without a renderer: cells are planted, trees are spawned and
//! despawned and get their models, near cells are culled, and every system of ours is timed. What a renderer adds (levels of
//! detail, tables and impostors) is measured by one more flight (`rendered`). For comparison the same trees are plain entities
//! that Bevy culls one by one.

mod flight;
mod rendered;
mod stress;
mod system_costs;

use crate::report::Report;
use bevy::{
    camera::{CameraPlugin, primitives::Aabb},
    mesh::MeshPlugin,
    prelude::*,
    time::TimeUpdateStrategy,
};
use bevy_windwood::{
    SystemTimes,
    forest::{ForestCells, ForestRenderPlugin},
    prelude::*,
    scatter::{
        ForestPlan,
        plan::{Area, Shape, Stock},
    },
};
use flight::Flight;
use std::time::{Duration, Instant};
use stress::{Slowest, StressTest};
use system_costs::SystemCosts;
pub use system_costs::median_and_p99;

/// Trees of the largest forest.
const LARGEST: f32 = 1e6;
/// Numbers of trees, and the keys of the results: median, 99th percentile, and median with plain entities.
const SIZES: [(f32, [&str; 3]); 3] = [
    (1e4, ["frame_ms_median_1e4", "frame_ms_p99_1e4", "plain_frame_ms_1e4"]),
    (1e5, ["frame_ms_median_1e5", "frame_ms_p99_1e5", "plain_frame_ms_1e5"]),
    (LARGEST, ["frame_ms_median_1e6", "frame_ms_p99_1e6", "plain_frame_ms_1e6"]),
];
/// Side of the forests, m.
const SIDE_M: f32 = 10_000.0;
const SPEED_M_S: f32 = 20.0;
const FRAMES_PER_S: f32 = 60.0;
/// Frames of the flight. It begins when the trees around the camera have their models.
const FRAMES: usize = 1500;
/// Frames with plain entities.
const PLAIN_FRAMES: usize = 200;
/// Longest wait for a forest, s.
const TIMEOUT_S: f64 = 60.0;
/// Bytes of the mesh of an impostor, which each far tree has.
const IMPOSTOR_BYTES: f64 = 76.0;

pub fn run() -> Report {
    let mut report = Report::default();
    if let Err(error) = measure(&mut report) {
        eprintln!("{error}");
        report.at_most("frame_ms_median_1e6", f64::NAN, 1.0, "could not be measured");
    }
    if let Err(error) = rendered::run(&mut report) {
        eprintln!("with a renderer: {error}");
    }
    report
}

fn measure(report: &mut Report) -> Result<(), String> {
    println!("trees     cells of m   median ms      p99 ms   update ms      p99 ms   known s   plain update ms");
    let mut medians_ms = Vec::new();
    for (trees, [median_key, p99_key, plain_key]) in SIZES {
        let result = FlightResult::over(trees)?;
        let plain_ms = plain_frame_ms(&result.stems_m);
        let [median_ms, p99_ms] = median_and_p99(&result.systems_ms);
        let [update_ms, update_p99_ms] = median_and_p99(&result.updates_ms);
        let (stems, cell_m, known_s) = (result.stems_m.len(), cell_m(trees), result.known_s);
        println!(
            "{stems:<9} {cell_m:>10.0} {median_ms:>11.4} {p99_ms:>11.4} {update_ms:>11.4} {update_p99_ms:>11.4} \
             {known_s:>9.1} {plain_ms:>17.3}"
        );
        result.costs.print();
        medians_ms.push(median_ms);
        report.record(plain_key, plain_ms, "a whole update with as many plain entities that Bevy culls");
        if trees < LARGEST {
            report.record(median_key, median_ms, "all our systems");
            report.record(p99_key, p99_ms, "the same");
            continue;
        }
        report.at_most(median_key, median_ms, 1.0, "all our systems, as if one ran after another");
        report.at_most(p99_key, p99_ms, 4.0, "the same, the frame that is slower than 99 of 100");
        let keys = [
            ["turn_ms_1e6", "turn_ms_worst_1e6"],
            ["teleport_ms_1e6", "teleport_ms_worst_1e6"],
            ["wind_ms_1e6", "wind_ms_worst_1e6"],
        ];
        stress::record(report, keys, result.slowest_ms);
        report.record("update_ms_median_1e6", update_ms, "a whole update, with the part of Bevy and commands");
        report.record("update_ms_p99_1e6", update_p99_ms, "the same");
        let bytes = result.bytes_per_tree;
        report.at_most("bytes_per_tree", bytes, 100.0, "its part of the store, and 76 of the mesh of an impostor");
        report.at_most("startup_s", result.startup_s, 3.0, "until each near tree has its model, without a renderer");
        report.record("known_s_1e6", known_s, "until every stem is known");
    }
    let growth = medians_ms[2] / medians_ms[0];
    report.at_most("growth_1e4_to_1e6", growth, 1.5, "of the median, for 100 times the trees");
    Ok(())
}

/// Side of a cell with some 41 trees, m: 64 for a million trees, 640 for ten thousand. Streaming, culling and clearing cost a time
/// per cell, however few trees it has, so that a plan for a sparse forest has larger cells.
fn cell_m(trees: f32) -> f32 {
    64.0 * (1e6 / trees).sqrt()
}

/// A square of mixed woodland.
fn plan(trees: f32) -> ForestPlan {
    let stock = |species: &str, age_years, age_spread_years, full_grown_years| Stock {
        species: species.into(),
        age_years,
        age_spread_years,
        full_grown_years,
        ..default()
    };
    let area = Area {
        shape: Shape::Rectangle { min_m: [-0.5 * SIDE_M; 2], max_m: [0.5 * SIDE_M; 2] },
        density_per_ha: trees / (SIDE_M * SIDE_M) * 1e4,
        stock: vec![stock("fir", 75.0, 30.0, 110.0), stock("oak", 95.0, 35.0, 130.0), stock("birch", 45.0, 8.0, 70.0)],
        ..default()
    };
    ForestPlan { cell_m: cell_m(trees), areas: vec![area], ..default() }
}

/// Measurements of a flight.
#[derive(Default)]
struct FlightResult {
    /// Times of all our systems, and of the whole update, for each frame.
    systems_ms: Vec<f64>,
    updates_ms: Vec<f64>,
    costs: SystemCosts,
    /// Since the forest was spawned, in an app before its first frame.
    startup_s: f64,
    known_s: f64,
    bytes_per_tree: f64,
    /// Of turns, teleports and changes of the wind in the largest forest.
    slowest_ms: [Slowest; 3],
    stems_m: Vec<Vec3>,
}

impl FlightResult {
    /// Waits for the trees around the camera, then flies over the forest while the rest of it is being planted.
    fn over(trees: f32) -> Result<Self, String> {
        let mut app = app();
        app.add_plugins((WindwoodMinimalPlugins, ForestRenderPlugin)).add_systems(Update, add_meshes);
        app.finish();
        app.cleanup();
        let mut flight = Flight::start(&mut app);
        let start = Instant::now();
        let plan = app.world_mut().resource_mut::<Assets<ForestPlan>>().add(plan(trees));
        let settings = ForestSettings { far_to_m: SIDE_M, trees_to_m: 300.0, ..default() };
        app.world_mut().spawn((Forest::new(plan), settings));

        let (mut result, mut startup_s, mut known_s) = (Self::default(), None, None);
        while startup_s.is_none() || known_s.is_none() || result.systems_ms.len() < FRAMES {
            if startup_s.is_none() {
                frame(&mut app);
            } else {
                flight.advance(&mut app);
                result.run_frame(&mut app);
            }
            let since_s = start.elapsed().as_secs_f64();
            if since_s > TIMEOUT_S {
                return Err(format!("a forest of {trees} trees was not ready after {TIMEOUT_S} s"));
            }
            let world = app.world_mut();
            let Ok(forest) = world.query::<&ForestCells>().single(world) else { continue };
            let (is_complete, is_known) = (forest.is_complete(), forest.is_planted());
            known_s = known_s.or(is_known.then_some(since_s));
            startup_s = startup_s.or_else(|| (is_complete && all_have_models(world)).then_some(since_s));
        }
        if trees == LARGEST {
            let run_frame = |app: &mut App| {
                frame(app);
            };
            result.slowest_ms = StressTest { app: &mut app, flight: &mut flight, run_frame }.slowest_frames_ms();
        }
        (result.startup_s, result.known_s) = (startup_s.unwrap_or(f64::NAN), known_s.unwrap_or(f64::NAN));
        let world = app.world_mut();
        let forest = world.query::<&ForestCells>().single(world).map_err(|error| error.to_string())?;
        let store = forest.store();
        result.bytes_per_tree = IMPOSTOR_BYTES + store.bytes() as f64 / store.plants() as f64;
        result.stems_m = store.iter().flat_map(|(cell, _)| store.stems(cell)).map(|stem| stem.position).collect();
        Ok(result)
    }

    /// Runs a frame and keeps its times.
    fn run_frame(&mut self, app: &mut App) {
        let update_ms = frame(app).as_secs_f64() * 1e3;
        let times = app.world().resource::<SystemTimes>();
        self.updates_ms.push(update_ms);
        self.systems_ms.push(times.total().as_secs_f64() * 1e3);
        self.costs.add(times);
    }
}

/// Runs a frame as in a game with 60 per second, and returns the time of its work. It sleeps for the rest of the frame, so that
/// background tasks have as much time as in a game that waits for its picture, and caches get as cold.
fn frame(app: &mut App) -> Duration {
    let start = Instant::now();
    app.update();
    let work = start.elapsed();
    std::thread::sleep(Duration::from_secs_f32(1.0 / FRAMES_PER_S).saturating_sub(work));
    work
}

fn all_have_models(world: &mut World) -> bool {
    let mut without_model = world.query_filtered::<(), (With<Tree>, Without<Grown>)>();
    let mut grown = world.query::<&Grown>();
    without_model.iter(world).next().is_none() && grown.iter(world).next().is_some()
}

/// An app that culls but does not render.
fn app() -> App {
    let mut app = App::new();
    // Assets are in the working folder, unless `BEVY_ASSET_ROOT` names another.
    app.add_plugins((MinimalPlugins, TransformPlugin, AssetPlugin::default(), MeshPlugin, CameraPlugin));
    app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs_f32(1.0 / FRAMES_PER_S)));
    app
}

/// The components with which Bevy culls an entity.
fn culling_components() -> (Mesh3d, Aabb) {
    (Mesh3d::default(), Aabb::from_min_max(Vec3::new(-4.0, 0.0, -4.0), Vec3::new(4.0, 20.0, 4.0)))
}

/// Gives near trees a mesh for Bevy to cull, as a renderer would, so that whole updates can be compared.
fn add_meshes(mut commands: Commands, trees: Query<Entity, Added<Grown>>) {
    trees.iter().for_each(|tree| {
        commands.entity(tree).insert(culling_components());
    });
}

/// Median time of a whole update with a plain entity for each stem and the same flight, ms.
fn plain_frame_ms(stems_m: &[Vec3]) -> f64 {
    let mut app = app();
    app.finish();
    app.cleanup();
    let mut flight = Flight::start(&mut app);
    let trees: Vec<_> = stems_m.iter().map(|stem| (Transform::from_translation(*stem), culling_components())).collect();
    app.world_mut().spawn_batch(trees);
    let mut times_ms = Vec::new();
    for _ in 0..PLAIN_FRAMES {
        flight.advance(&mut app);
        times_ms.push(frame(&mut app).as_secs_f64() * 1e3);
    }
    median_and_p99(&times_ms)[0]
}
