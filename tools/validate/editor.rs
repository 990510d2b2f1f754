//! What the workbench costs: closed over a forest, and open; how long a changed tree takes, and an export.
//!
//! Frames are told by the time that the processor has spent on the thread that makes them, with all systems on that thread: what waits
//! for a core, and what software Vulkan draws on other threads, is not in it.

use crate::{
    cpu_clock::CPU_CLOCK,
    grid::{self, Stand},
    report::Report,
    scale::median_and_p99,
    support::capture,
};
use bevy::{
    ecs::schedule::{Schedules, SingleThreadedExecutor},
    prelude::*,
    render::RenderApp,
    time::TimeUpdateStrategy,
};
use bevy_windwood::{
    editor::{EditorPlugin, Panel, Workbench},
    prelude::*,
    render::LevelStyle,
};
use std::{
    sync::LazyLock,
    time::{Duration, Instant},
};

/// The forest over which the workbench lies, and the picture of it: small, because drawing is not measured.
const FOREST: Stand = Stand { trees: 500, species: "oak", age_years: 90.0 };
const SIZE: (u32, u32) = (1280, 720);
const SMALL: (u32, u32) = (160, 90);
/// Frames before those that count; rounds of closed and open in turn, and frames of each.
const WARM_UP_FRAMES: usize = 30;
const ROUNDS: usize = 30;
const FRAMES: usize = 20;
/// Changes of a tree that are timed.
const CHANGES: u32 = 9;
/// Longest wait for a tree.
const TIMEOUT: Duration = Duration::from_secs(60);

/// Panels, and the keys of what they add to a frame.
const PANELS: [(Panel, &str); 5] = [
    (Panel::Species, "open_ms_species"),
    (Panel::Woods, "open_ms_woods"),
    (Panel::Ground, "open_ms_ground"),
    (Panel::Wind, "open_ms_wind"),
    (Panel::Levels, "open_ms_levels"),
];

/// Measures all of it.
pub fn run() -> Report {
    let mut report = Report::default();
    for measure in [closed, open, rebuild] {
        if let Err(error) = measure(&mut report) {
            eprintln!("{error}");
            report.at_most("failed", f64::NAN, 0.0, "could not be measured");
        }
    }
    #[cfg(feature = "export")]
    export(&mut report);
    report
}

/// An app with a forest that is drawn to a picture of that size, with the workbench or without.
fn forest(has_workbench: bool, size: (u32, u32)) -> Result<App, String> {
    let mut app = App::new();
    app.add_plugins((capture::headless_engine(None), WindwoodPlugins));
    if has_workbench {
        app.add_plugins(EditorPlugin { file: Some(oak_file()), ..default() });
    }
    capture::begin(&mut app)?;
    let camera = grid::spawn_forest(&mut app, &FOREST)?;
    let target = capture::target(&mut app, size);
    app.world_mut().entity_mut(camera).insert(capture::camera(&target));
    // Drawing is not measured, and would take most of the time.
    let world = app.world_mut();
    world.query::<&mut DirectionalLight>().iter_mut(world).for_each(|mut sun| sun.shadow_maps_enabled = false);
    app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs_f64(1.0 / 60.0)));
    on_one_thread(app.world_mut());
    if let Some(render) = app.get_sub_app_mut(RenderApp) {
        on_one_thread(render.world_mut());
    }
    (0..WARM_UP_FRAMES).for_each(|_| capture::step(&mut app));
    Ok(app)
}

fn oak_file() -> std::path::PathBuf {
    concat!(env!("CARGO_MANIFEST_DIR"), "/assets/species/oak.species.ron").into()
}

fn on_one_thread(world: &mut World) {
    world.resource_mut::<Schedules>().iter_mut().for_each(|(_, schedule)| {
        schedule.set_executor(SingleThreadedExecutor::new());
    });
}

/// CPU time of each of some frames, ms.
fn frames_ms(app: &mut App) -> Vec<f64> {
    let frame = |_| {
        let begun = cpu_time();
        app.update();
        (cpu_time() - begun).as_secs_f64() * 1e3
    };
    (0..FRAMES).map(frame).collect()
}

/// CPU time of this thread; the time on the wall where there is no such clock.
fn cpu_time() -> Duration {
    static BEGINNING: LazyLock<Instant> = LazyLock::new(Instant::now);
    CPU_CLOCK.map_or_else(|| BEGINNING.elapsed(), |clock| clock())
}

fn median(values: &[f64]) -> f64 {
    median_and_p99(values)[0]
}

/// The same forest with the workbench closed and twice without it, in turn: what these two differ by is the noise of the measurement.
fn closed(report: &mut Report) -> Result<(), String> {
    let mut apps = [forest(false, SMALL)?, forest(true, SMALL)?, forest(false, SMALL)?];
    let (mut ratios, mut same) = (Vec::new(), Vec::new());
    let mut all_ms = [const { Vec::new() }; 3];
    for _ in 0..ROUNDS {
        let round = apps.each_mut().map(frames_ms);
        let [one, with, other] = round.each_ref().map(|frames| median(frames));
        ratios.push(with / (0.5 * (one + other)));
        same.push(one / other);
        all_ms.iter_mut().zip(round).for_each(|(all, frames)| all.extend(frames));
    }
    let [one, with, other] = all_ms.each_ref().map(|frames| median(frames));
    report.record("closed_frame_ms", with, "CPU time of a frame of 500 oaks, the workbench closed");
    report.record("frame_ms", 0.5 * (one + other), "the same without it, mean of two");
    report.record(
        "same_frame_ratio",
        median(&same),
        "the two without it, one over the other, median of 30 rounds in turn",
    );
    report.at_most("closed_frame_ratio", median(&ratios), 1.01, "with it over without it, median of the same rounds");
    Ok(())
}

/// What each panel adds to a frame: closed and open in turn.
fn open(report: &mut Report) -> Result<(), String> {
    let mut app = forest(true, SIZE)?;
    // Only the panels are drawn: the camera looks into the sky.
    let world = app.world_mut();
    let mut cameras = world.query_filtered::<&mut Transform, With<Camera3d>>();
    cameras.iter_mut(world).for_each(|mut at| at.look_to(Vec3::Y, Vec3::Z));
    let mut most_ms = 0.0_f64;
    for (panel, key) in PANELS {
        let mut added_ms = Vec::new();
        for _ in 0..ROUNDS / 5 {
            let [closed_ms, open_ms] = [false, true].map(|is_open| {
                let mut workbench = app.world_mut().resource_mut::<Workbench>();
                (workbench.is_open, workbench.panel) = (is_open, panel);
                // What a panel asks for in the background, and the layout of its first frames.
                (0..WARM_UP_FRAMES / 2).for_each(|_| app.update());
                median(&frames_ms(&mut app))
            });
            added_ms.push(open_ms - closed_ms);
        }
        most_ms = most_ms.max(median(&added_ms));
        report.record(key, median(&added_ms), "CPU time that the open panel adds to a frame");
    }
    report.at_most("open_ms", most_ms, 1.0, "the dearest of them");
    Ok(())
}

/// From a change of a mature oak on the turntable to the tree that shows it.
fn rebuild(report: &mut Report) -> Result<(), String> {
    let mut app = App::new();
    app.add_plugins((capture::headless_engine(None), WindwoodPlugins))
        .add_plugins(EditorPlugin { file: Some(oak_file()), turntable: true, starts_open: true, ..default() })
        .insert_resource(LevelOfDetail { style: LevelStyle::Full, ..default() });
    capture::begin(&mut app)?;
    let target = capture::target(&mut app, SIZE);
    let camera = app.world_mut().spawn(capture::camera(&target)).id();
    wait(&mut app)?;
    app.world_mut().entity_mut(camera).insert(Camera { is_active: false, ..default() });
    let (mut times_ms, mut frames_ms) = (Vec::new(), Vec::new());
    for change in 1..=CHANGES {
        let mut workbench = app.world_mut().resource_mut::<Workbench>();
        let mut species = workbench.species().clone();
        species.seed += u64::from(change);
        workbench.change(species, "Seed");
        let start = Instant::now();
        frames_ms.push(wait(&mut app)?);
        times_ms.push(start.elapsed().as_secs_f64() * 1e3);
    }
    let [median_ms, worst_ms] = [median(&times_ms), times_ms.iter().copied().fold(0.0, f64::max)];
    report.at_most("rebuild_ms", median_ms, 100.0, "from a changed seed of a mature oak to its meshes, median of nine");
    report.record("rebuild_ms_worst", worst_ms, "the worst of them");
    report.record("rebuild_frame_ms", median(&frames_ms), "CPU time of the longest frame meanwhile, median of nine");
    Ok(())
}

/// Waits until the tree is shown. Returns the CPU time of the longest frame, ms.
fn wait(app: &mut App) -> Result<f64, String> {
    let (start, mut longest) = (Instant::now(), Duration::ZERO);
    while start.elapsed() < TIMEOUT {
        let begun = cpu_time();
        app.update();
        longest = longest.max(cpu_time() - begun);
        if app.world().resource::<Workbench>().is_settled() {
            return Ok(longest.as_secs_f64() * 1e3);
        }
        std::thread::sleep(Duration::from_millis(1));
    }
    Err("the tree was not grown".into())
}

/// A mature oak with textures and the loop of its sway, from its species and a wind to the bytes of a file.
#[cfg(feature = "export")]
fn export(report: &mut Report) {
    use bevy_windwood::{
        export::{ExportSettings, ExportedTree, tree_glb},
        sway::{SwaySettings, WindResponse},
        tree::{TreeModel, textures::species_textures},
        wind::{FieldSettings, WindField},
    };
    let (species, seed) = (Species::default(), 1);
    let age_years = species.age.mature_years;
    let field = WindField::synthesise(&FieldSettings::default()).expect("the default is valid");
    let wind = WindResponse::new(std::sync::Arc::new(field), &SwaySettings::default());
    let begun = Instant::now();
    let (textures, model) = (species_textures(&species), TreeModel::bake(&species, age_years, seed));
    let tree = ExportedTree { species: &species, textures: &textures, model: &model, age_years, seed };
    let glb = tree_glb(&tree, &ExportSettings::default(), Some(&wind));
    let time_s = begun.elapsed().as_secs_f64();
    let bytes = glb.map_or(f64::NAN, |glb| glb.len() as f64);
    report.at_most("export_s", time_s, 2.0, "a mature oak grown and written with textures and sway, on the clock");
    report.at_most("export_mb", bytes / 1e6, 8.0, "its GLB");
}
