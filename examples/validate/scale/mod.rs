//! What a frame costs in forests of ten thousand trees to a million.
//!
//! A camera flies through woods of 10 km x 10 km in an app without a renderer: cells are planted, trees come and go and
//! get their models, near cells are culled, and every system of ours is timed. What a renderer adds (the levels, tables
//! and cards of the trees near the camera) is not in these numbers, but in those of one more flight (`drawn`). Beside it the
//! same trees stand as plain entities that Bevy culls one by one.

mod dearest;
mod drawn;
mod leaps;

use crate::report::Report;
use bevy::{
    camera::{CameraPlugin, primitives::Aabb},
    mesh::MeshPlugin,
    prelude::*,
    time::TimeUpdateStrategy,
};
use bevy_windwood::{
    SystemTimes,
    forest::{ForestCells, ForestDrawPlugin},
    prelude::*,
    scatter::{
        ForestPlan,
        plan::{Area, Shape, Stock},
    },
};
use dearest::{Dearest, median_and_p99};
use leaps::{Acts, Slowest};
use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};
use std::time::{Duration, Instant};

/// Trees of the largest wood.
const LARGEST: f32 = 1e6;
/// Trees, and the keys of the numbers: median, 99th percentile, and that of plain entities.
const SIZES: [(f32, [&str; 3]); 3] = [
    (1e4, ["frame_ms_median_1e4", "frame_ms_p99_1e4", "plain_frame_ms_1e4"]),
    (1e5, ["frame_ms_median_1e5", "frame_ms_p99_1e5", "plain_frame_ms_1e5"]),
    (LARGEST, ["frame_ms_median_1e6", "frame_ms_p99_1e6", "plain_frame_ms_1e6"]),
];
/// Side of the woods, m.
const SIDE_M: f32 = 10_000.0;
const SPEED_M_S: f32 = 20.0;
const FRAMES_A_SECOND: f32 = 60.0;
/// Frames of the flight; it begins when the trees about the camera stand.
const FRAMES: usize = 1500;
/// Frames among plain entities: each is like the others.
const PLAIN_FRAMES: usize = 200;
/// After so long something is amiss.
const PATIENCE_S: f64 = 60.0;
/// What the mesh of a card has: a far tree is one.
const CARD_BYTES: f64 = 76.0;

pub fn run() -> Report {
    let mut report = Report::default();
    if let Err(error) = measure(&mut report) {
        eprintln!("{error}");
        report.at_most("frame_ms_median_1e6", f64::NAN, 1.0, "could not be measured");
    }
    if let Err(error) = drawn::run(&mut report) {
        eprintln!("with a renderer: {error}");
    }
    report
}

fn measure(report: &mut Report) -> Result<(), String> {
    println!("trees     cells of m   median ms      p99 ms   update ms      p99 ms   known s   plain update ms");
    let mut medians_ms = Vec::new();
    for (trees, [median_key, p99_key, plain_key]) in SIZES {
        let flown = Flown::through(trees)?;
        let plain_ms = plain_frame_ms(&flown.stems_m);
        let [median_ms, p99_ms] = median_and_p99(&flown.ours_ms);
        let [update_ms, update_p99_ms] = median_and_p99(&flown.updates_ms);
        let (stems, cell_m, known_s) = (flown.stems_m.len(), cell_m(trees), flown.known_s);
        println!(
            "{stems:<9} {cell_m:>10.0} {median_ms:>11.4} {p99_ms:>11.4} {update_ms:>11.4} {update_p99_ms:>11.4} \
             {known_s:>9.1} {plain_ms:>17.3}"
        );
        flown.dearest.print();
        medians_ms.push(median_ms);
        report.tell(plain_key, plain_ms, "a whole update with as many plain entities that Bevy culls");
        if trees < LARGEST {
            report.tell(median_key, median_ms, "all our systems");
            report.tell(p99_key, p99_ms, "the same");
            continue;
        }
        report.at_most(median_key, median_ms, 1.0, "all our systems, as if none ran beside another");
        report.at_most(p99_key, p99_ms, 4.0, "the same, the frame that is slower than 99 of 100");
        let keys = [
            ["turn_ms_1e6", "turn_ms_worst_1e6"],
            ["leap_ms_1e6", "leap_ms_worst_1e6"],
            ["wind_ms_1e6", "wind_ms_worst_1e6"],
        ];
        leaps::tell(report, keys, flown.slowest_ms);
        report.tell("update_ms_median_1e6", update_ms, "a whole update: Bevy's part, and what commands take");
        report.tell("update_ms_p99_1e6", update_p99_ms, "the same");
        let bytes = flown.bytes_per_tree;
        report.at_most("bytes_per_tree", bytes, 100.0, "its part of the store, and 76 of a card's mesh");
        report.at_most("startup_s", flown.startup_s, 3.0, "until each near tree has its model, without a renderer");
        report.tell("known_s_1e6", known_s, "until every stem is known");
    }
    let growth = medians_ms[2] / medians_ms[0];
    report.at_most("growth_1e4_to_1e6", growth, 1.5, "of the median, for 100 times the trees");
    Ok(())
}

/// Some 41 trees to a cell, however thin the wood, as whoever plans it would choose: a cell costs something to stream,
/// to cull and to clear, whether or not anything stands in it. 64 m for a million trees, 640 m for ten thousand.
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

/// What there was to see of a flight.
#[derive(Default)]
struct Flown {
    /// Of each frame: all our systems, and the whole update.
    ours_ms: Vec<f64>,
    updates_ms: Vec<f64>,
    dearest: Dearest,
    /// From the moment at which the forest is spawned, in an app that has not yet had a frame.
    startup_s: f64,
    known_s: f64,
    bytes_per_tree: f64,
    /// Of turns, leaps and changes of the wind; of the largest wood.
    slowest_ms: [Slowest; 3],
    stems_m: Vec<Vec3>,
}

impl Flown {
    /// Waits for the trees about the camera, and flies away over the forest while its rest is still being planted.
    fn through(trees: f32) -> Result<Self, String> {
        let mut app = app();
        app.add_plugins((WindwoodMinimalPlugins, ForestDrawPlugin)).add_systems(Update, wear_meshes);
        app.finish();
        app.cleanup();
        let mut flight = Flight::begin(&mut app);
        let begun = Instant::now();
        let plan = app.world_mut().resource_mut::<Assets<ForestPlan>>().add(plan(trees));
        let settings = ForestSettings { far_to_m: SIDE_M, trees_to_m: 300.0, ..default() };
        app.world_mut().spawn((Forest::new(plan), settings));

        let (mut flown, mut startup_s, mut known_s) = (Self::default(), None, None);
        while startup_s.is_none() || known_s.is_none() || flown.ours_ms.len() < FRAMES {
            if startup_s.is_none() {
                frame(&mut app);
            } else {
                flight.fly_on(&mut app);
                flown.note(&mut app);
            }
            let since_s = begun.elapsed().as_secs_f64();
            if since_s > PATIENCE_S {
                return Err(format!("a forest of {trees} trees did not come about in {PATIENCE_S} s"));
            }
            let world = app.world_mut();
            let Ok(forest) = world.query::<&ForestCells>().single(world) else { continue };
            let (is_complete, is_known) = (forest.is_complete(), forest.is_planted());
            known_s = known_s.or(is_known.then_some(since_s));
            startup_s = startup_s.or_else(|| (is_complete && all_have_models(world)).then_some(since_s));
        }
        if trees == LARGEST {
            let pass = |app: &mut App| {
                frame(app);
            };
            flown.slowest_ms = Acts { app: &mut app, flight: &mut flight, pass }.slowest_ms();
        }
        (flown.startup_s, flown.known_s) = (startup_s.unwrap_or(f64::NAN), known_s.unwrap_or(f64::NAN));
        let world = app.world_mut();
        let forest = world.query::<&ForestCells>().single(world).map_err(|error| error.to_string())?;
        let store = forest.store();
        flown.bytes_per_tree = CARD_BYTES + store.bytes() as f64 / store.plants() as f64;
        flown.stems_m = store.iter().flat_map(|(cell, _)| store.stems(cell)).map(|stem| stem.position).collect();
        Ok(flown)
    }

    /// Lets a frame pass, and notes what it took.
    fn note(&mut self, app: &mut App) {
        let update_ms = frame(app).as_secs_f64() * 1e3;
        let times = app.world().resource::<SystemTimes>();
        self.updates_ms.push(update_ms);
        self.ours_ms.push(times.total().as_secs_f64() * 1e3);
        self.dearest.note(times);
    }
}

/// Lets a frame pass as in a game of 60 a second, and returns how long its work took. What is left of the frame is slept
/// through: the tasks in the background have the time that they would have while a game waits for its picture, and the
/// caches grow as cold.
fn frame(app: &mut App) -> Duration {
    let begun = Instant::now();
    app.update();
    let taken = begun.elapsed();
    std::thread::sleep(Duration::from_secs_f32(1.0 / FRAMES_A_SECOND).saturating_sub(taken));
    taken
}

fn all_have_models(world: &mut World) -> bool {
    let mut bare = world.query_filtered::<(), (With<Tree>, Without<Grown>)>();
    let mut grown = world.query::<&Grown>();
    bare.iter(world).next().is_none() && grown.iter(world).next().is_some()
}

/// Everything that culls, and nothing that draws.
fn app() -> App {
    let mut app = App::new();
    // Where the assets are: in the working folder's, unless `BEVY_ASSET_ROOT` says otherwise.
    app.add_plugins((MinimalPlugins, TransformPlugin, AssetPlugin::default(), MeshPlugin, CameraPlugin));
    app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs_f32(1.0 / FRAMES_A_SECOND)));
    app
}

/// What Bevy needs to know of a thing to cull it.
fn culled() -> (Mesh3d, Aabb) {
    (Mesh3d::default(), Aabb::from_min_max(Vec3::new(-4.0, 0.0, -4.0), Vec3::new(4.0, 20.0, 4.0)))
}

/// Near trees get a mesh for Bevy to cull, as they would where they are drawn, so that whole updates can be compared.
fn wear_meshes(mut commands: Commands, trees: Query<Entity, Added<Grown>>) {
    trees.iter().for_each(|tree| {
        commands.entity(tree).insert(culled());
    });
}

/// The median time of a whole update with a plain entity for each stem, in which the camera takes the same way.
fn plain_frame_ms(stems_m: &[Vec3]) -> f64 {
    let mut app = app();
    app.finish();
    app.cleanup();
    let mut flight = Flight::begin(&mut app);
    let trees: Vec<_> = stems_m.iter().map(|stem| (Transform::from_translation(*stem), culled())).collect();
    app.world_mut().spawn_batch(trees);
    let mut times_ms = Vec::new();
    for _ in 0..PLAIN_FRAMES {
        flight.fly_on(&mut app);
        times_ms.push(frame(&mut app).as_secs_f64() * 1e3);
    }
    median_and_p99(&times_ms)[0]
}

/// A camera that turns as it likes, smoothly, and always in the same way.
struct Flight {
    camera: Entity,
    at: Transform,
    turn_rad_s: f32,
    /// The turn that it goes over to, and how long it keeps at that.
    wanted_rad_s: f32,
    left_s: f32,
    random: Xoshiro256PlusPlus,
}

impl Flight {
    fn begin(app: &mut App) -> Self {
        let at = Transform::from_xyz(0.0, 15.0, 0.0);
        let lens = PerspectiveProjection { aspect_ratio: 16.0 / 9.0, far: 1.5 * SIDE_M, ..default() };
        let camera = app.world_mut().spawn((Camera3d::default(), Projection::Perspective(lens), at)).id();
        let random = Xoshiro256PlusPlus::seed_from_u64(20);
        Self { camera, at, turn_rad_s: 0.0, wanted_rad_s: 0.0, left_s: 0.0, random }
    }

    /// Moves the camera by what it flies in a frame.
    fn fly_on(&mut self, app: &mut App) {
        let frame_s = 1.0 / FRAMES_A_SECOND;
        self.left_s -= frame_s;
        if self.left_s <= 0.0 {
            (self.wanted_rad_s, self.left_s) =
                (self.random.random_range(-0.6..0.6), self.random.random_range(1.0..4.0));
        }
        self.turn_rad_s += (self.wanted_rad_s - self.turn_rad_s) * frame_s / 0.5;
        self.at.rotate_y(self.turn_rad_s * frame_s);
        self.at.translation += self.at.forward() * SPEED_M_S * frame_s;
        self.place(app, |_| ());
    }

    /// Moves the camera as is told.
    fn place(&mut self, app: &mut App, change: impl FnOnce(&mut Transform)) {
        change(&mut self.at);
        if let Some(mut at) = app.world_mut().get_mut::<Transform>(self.camera) {
            *at = self.at;
        }
    }
}
