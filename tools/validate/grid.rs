//! Time of a frame on this GPU: trees as dense as in a grid of 8 m, seen from a height of 30 m, in full HD, in the wind, under
//! one sun with shadows.

use crate::{report::Report, support::capture};
use bevy::{
    diagnostic::{Diagnostic, DiagnosticPath, DiagnosticsStore},
    prelude::*,
    render::{diagnostic::RenderDiagnosticsPlugin, renderer::RenderAdapterInfo},
    time::TimeUpdateStrategy,
};
use bevy_windwood::{
    SystemTimes,
    prelude::*,
    render::POSES_SPAN,
    scatter::{
        ForestPlan,
        plan::{Area, Shape, Stock},
    },
};
use std::{
    path::Path,
    time::{Duration, Instant},
};

const SIZE: (u32, u32) = (1920, 1080);
/// Numbers of trees, and the keys of the results: a frame, one under the sun alone, one without shadows, the poses in it, and our
/// systems in it.
const FORESTS: [(u32, [&str; 5]); 4] = [
    (1_000, ["frame_ms_1k", "sun_only_ms_1k", "unshadowed_ms_1k", "poses_gpu_ms_1k", "systems_ms_1k"]),
    (5_000, ["frame_ms_5k", "sun_only_ms_5k", "unshadowed_ms_5k", "poses_gpu_ms_5k", "systems_ms_5k"]),
    (20_000, ["frame_ms_20k", "sun_only_ms_20k", "unshadowed_ms_20k", "poses_gpu_ms_20k", "systems_ms_20k"]),
    (100_000, ["frame_ms_100k", "sun_only_ms_100k", "unshadowed_ms_100k", "poses_gpu_ms_100k", "systems_ms_100k"]),
];
/// Ground per tree, m^2.
const AREA_PER_TREE_M2: f32 = 64.0;
/// Height of the camera at the edge of the forest, m.
const EYE_HEIGHT_M: f32 = 30.0;
/// Frames before the measurement.
const WARM_UP_FRAMES: u32 = 20;
/// Longest wait for a forest, s.
const TIMEOUT_S: f64 = 600.0;

/// Measures frames of forests of up to that many trees, and writes a picture of each.
pub fn run(frames: u32, most_trees: u32, folder: &Path) -> Report {
    let mut report = Report::default();
    println!(
        "{:>8} {:>10} {:>11} {:>13} {:>10} {:>11}   at {}x{}",
        "trees", "frame ms", "sun only ms", "unshadowed ms", "poses ms", "systems ms", SIZE.0, SIZE.1
    );
    for (trees, keys) in FORESTS.into_iter().filter(|(trees, _)| *trees <= most_trees) {
        let times_ms = match measure(trees, frames, &folder.join(format!("grid_{trees}.png"))) {
            Ok(times_ms) => times_ms,
            Err(error) => {
                eprintln!("{trees} trees: {error}");
                continue;
            }
        };
        let [frame_ms, sun_only_ms, unshadowed_ms, poses_ms, systems_ms] = times_ms;
        println!(
            "{trees:>8} {frame_ms:>10.3} {sun_only_ms:>11.3} {unshadowed_ms:>13.3} {poses_ms:>10.3} {systems_ms:>11.3}"
        );
        let notes = [
            "a frame, of many without a pause",
            "the same under `TreeLighting::SunOnly`",
            "the same without shadows",
            "its part on the GPU that poses beams in the wind",
            "its part on the CPU that is ours",
        ];
        for ((key, value), note) in keys.into_iter().zip(times_ms).zip(notes) {
            report.record(key, value, note);
        }
    }
    report
}

/// Times of a frame, of one under the sun alone, of one without shadows, of the poses, and of our systems, ms.
fn measure(trees: u32, frames: u32, picture: &Path) -> Result<[f64; 5], String> {
    let mut app = App::new();
    app.add_plugins((capture::headless_engine(None), WindwoodPlugins, RenderDiagnosticsPlugin));
    capture::begin(&mut app)?;
    if trees == FORESTS[0].0 {
        let adapter = app.world().get_resource::<RenderAdapterInfo>();
        println!("on {}", adapter.map_or("an unknown device", |info| info.name.as_str()));
    }
    let camera = spawn_forest(&mut app, &Stand { trees, species: "oak", age_years: 90.0 })?;
    let target = capture::target(&mut app, SIZE);
    app.world_mut().entity_mut(camera).insert(capture::camera(&target));
    app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs_f64(1.0 / 60.0)));
    let [frame_ms, systems_ms] = render_frames(&mut app, frames)?;
    let path = DiagnosticPath::new(format!("render/{POSES_SPAN}/elapsed_gpu"));
    let poses_ms = app.world().resource::<DiagnosticsStore>().get(&path).and_then(Diagnostic::average);
    capture::save(&capture::capture(&mut app, &target, SIZE)?, picture)?;
    app.insert_resource(TreeLighting::SunOnly);
    let [sun_only_ms, _] = render_frames(&mut app, frames)?;
    app.insert_resource(TreeLighting::AllLights);
    let world = app.world_mut();
    world.query::<&mut DirectionalLight>().iter_mut(world).for_each(|mut sun| sun.shadow_maps_enabled = false);
    let [unshadowed_ms, _] = render_frames(&mut app, frames)?;
    Ok([frame_ms, sun_only_ms, unshadowed_ms, poses_ms.unwrap_or(f64::NAN), systems_ms])
}

/// Times of a frame and of our systems in it, ms, when many are rendered without a pause.
fn render_frames(app: &mut App, frames: u32) -> Result<[f64; 2], String> {
    (0..WARM_UP_FRAMES.min(frames)).for_each(|_| capture::step(app));
    let mut systems = Duration::ZERO;
    let start = Instant::now();
    for _ in 0..frames {
        app.update();
        systems += app.world().resource::<SystemTimes>().total();
    }
    capture::finish_drawing(app)?;
    Ok([start.elapsed(), systems].map(|sum| sum.as_secs_f64() * 1e3 / f64::from(frames)))
}

/// A stand of one species.
pub struct Stand {
    pub trees: u32,
    pub species: &'static str,
    pub age_years: f32,
}

/// Spawns the forest and waits until all that is wanted of it is drawn. Returns a [`Viewpoint`] that becomes the camera.
pub fn spawn_forest(app: &mut App, stand: &Stand) -> Result<Entity, String> {
    let Stand { trees, species, age_years } = *stand;
    let half_m = 0.5 * (trees as f32 * AREA_PER_TREE_M2).sqrt();
    let area = Area {
        shape: Shape::Rectangle { min_m: [-half_m; 2], max_m: [half_m; 2] },
        density_per_ha: 1e4 / AREA_PER_TREE_M2,
        stock: vec![Stock { species: species.into(), age_years, age_spread_years: 0.22 * age_years, ..default() }],
        ..default()
    };
    let world = app.world_mut();
    let plan = world.resource_mut::<Assets<ForestPlan>>().add(ForestPlan { seed: 8, areas: vec![area], ..default() });
    let far_to_m = (4.0 * half_m).max(ForestSettings::default().far_to_m);
    let settings = ForestSettings { far_to_m, cells_at_once: 64, trees_per_frame: 100_000, ..default() };
    world.spawn((Forest::new(plan), settings));
    spawn_ground_and_sun(world);
    let place =
        Transform::from_xyz(0.0, EYE_HEIGHT_M, half_m + 10.0).looking_at(Vec3::new(0.0, 0.0, half_m - 150.0), Vec3::Y);
    let viewpoint = world.spawn((Viewpoint, place)).id();
    wait_until_drawn(app)?;
    Ok(viewpoint)
}

/// Waits until there is wind, and all that is wanted of forests and trees is drawn.
pub fn wait_until_drawn(app: &mut App) -> Result<(), String> {
    let start = Instant::now();
    while !(app.world().resource::<ActiveSway>().is_ready() && capture::forests_are_drawn(app.world_mut())) {
        app.update();
        std::thread::sleep(Duration::from_millis(1));
        if start.elapsed().as_secs_f64() > TIMEOUT_S {
            return Err(format!("the trees were not ready after {TIMEOUT_S} s"));
        }
    }
    Ok(())
}

/// Level ground, a sun with shadows, and a fresh breeze.
pub fn spawn_ground_and_sun(world: &mut World) {
    let ground = world.resource_mut::<Assets<Mesh>>().add(Plane3d::default().mesh().size(20_000.0, 20_000.0));
    let green = StandardMaterial { base_color: Color::srgb(0.36, 0.42, 0.2), perceptual_roughness: 1.0, ..default() };
    let green = world.resource_mut::<Assets<StandardMaterial>>().add(green);
    world.spawn((Mesh3d(ground), MeshMaterial3d(green)));
    world.spawn((
        DirectionalLight { illuminance: 12_000.0, shadow_maps_enabled: true, ..default() },
        Transform::default().looking_to(Vec3::new(-0.5, -0.7, -0.4), Vec3::Y),
    ));
    world.insert_resource(Wind { speed: 8.0, ..default() });
    world.insert_resource(GlobalAmbientLight { brightness: 700.0, ..default() });
    world.insert_resource(ClearColor(Color::srgb(0.62, 0.75, 0.9)));
}
