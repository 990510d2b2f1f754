//! What the workbench costs: closed over a forest, and open; how long a changed tree takes, and an export.
//!
//! Frames are told by the time that the processor has spent on the thread that makes them, with all systems on that thread: what waits
//! for a core, and what software Vulkan draws on other threads, is not in it. A frame begins when the last one has been drawn, or that drawing
//! would slow it down by the caches that they share.

use crate::{
    cpu_clock::CPU_CLOCK,
    grid::{self, Stand},
    report::Report,
    scale::median_and_p99,
    support::capture,
};
use bevy::{
    camera::{ImageRenderTarget, RenderTarget},
    ecs::schedule::{Schedules, SingleThreadedExecutor},
    prelude::*,
    render::RenderApp,
    time::TimeUpdateStrategy,
};
use bevy_egui::{
    PrimaryEguiContext,
    egui::{Event, pos2},
    input::EguiInputEvent,
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

/// The forest over which the workbench lies.
const FOREST: Stand = Stand { trees: 500, species: "oak", age_years: 90.0 };
/// The picture is small, because drawing is not measured: a few pixels stand for a window of 1280 x 720 points.
const SIZE: (u32, u32) = (320, 180);
const SCALE: f32 = 0.25;
/// Frames before those that count; groups of four apps, two with the workbench and two without; rounds in turn; frames of each round without
/// anything to draw, and with panels; and of the forest.
const WARM_UP_FRAMES: usize = 30;
const GROUPS: usize = 8;
const ROUNDS: usize = 12;
const EMPTY_FRAMES: usize = 40;
const PANEL_FRAMES: usize = 60;
const FOREST_FRAMES: usize = 60;
/// Changes of a tree that are timed.
const CHANGES: u32 = 9;
/// Longest wait for a tree.
const TIMEOUT: Duration = Duration::from_secs(60);

/// Panels, and the keys of what they add to a frame: while nobody touches them, and while the pointer moves over them.
const PANELS: [(Panel, [&str; 2]); 5] = [
    (Panel::Species, ["open_ms_species", "pointer_ms_species"]),
    (Panel::Woods, ["open_ms_woods", "pointer_ms_woods"]),
    (Panel::Ground, ["open_ms_ground", "pointer_ms_ground"]),
    (Panel::Wind, ["open_ms_wind", "pointer_ms_wind"]),
    (Panel::Levels, ["open_ms_levels", "pointer_ms_levels"]),
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

/// An app with a forest, with the workbench or without.
fn forest(has_workbench: bool) -> Result<App, String> {
    let mut app = engine(has_workbench)?;
    let camera = grid::spawn_forest(&mut app, &FOREST)?;
    draw_with(&mut app, camera);
    Ok(app)
}

/// An app with nothing to draw, with the workbench or without.
fn empty(has_workbench: bool) -> Result<App, String> {
    let mut app = engine(has_workbench)?;
    let camera = app.world_mut().spawn(Camera3d::default()).id();
    draw_with(&mut app, camera);
    Ok(app)
}

fn engine(has_workbench: bool) -> Result<App, String> {
    let mut app = App::new();
    app.add_plugins((capture::headless_engine(None), WindwoodPlugins));
    if has_workbench {
        app.add_plugins(EditorPlugin { file: Some(oak_file()), ..default() });
    }
    capture::begin(&mut app)?;
    Ok(app)
}

/// Has a camera draw to the picture that stands for a window.
fn point_at_window(app: &mut App, camera: Entity) {
    let handle = capture::target(app, SIZE);
    let picture = RenderTarget::Image(ImageRenderTarget { handle: handle.clone(), scale_factor: SCALE });
    app.world_mut().entity_mut(camera).insert(capture::camera(&handle)).insert(picture);
}

/// Has a camera draw, all systems on one thread, and lets some frames pass.
fn draw_with(app: &mut App, camera: Entity) {
    point_at_window(app, camera);
    // Drawing is not measured, and would take most of the time.
    let world = app.world_mut();
    world.query::<&mut DirectionalLight>().iter_mut(world).for_each(|mut sun| sun.shadow_maps_enabled = false);
    app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs_f64(1.0 / 60.0)));
    on_one_thread(app.world_mut());
    if let Some(render) = app.get_sub_app_mut(RenderApp) {
        on_one_thread(render.world_mut());
    }
    (0..WARM_UP_FRAMES).for_each(|_| capture::step(app));
}

fn oak_file() -> std::path::PathBuf {
    concat!(env!("CARGO_MANIFEST_DIR"), "/assets/species/oak.species.ron").into()
}

fn on_one_thread(world: &mut World) {
    world.resource_mut::<Schedules>().iter_mut().for_each(|(_, schedule)| {
        schedule.set_executor(SingleThreadedExecutor::new());
    });
}

/// CPU time of each of so many frames, ms.
fn frames_ms(app: &mut App, frames: usize) -> Vec<f64> {
    let frame = |_| {
        let begun = cpu_time();
        app.update();
        let frame_ms = (cpu_time() - begun).as_secs_f64() * 1e3;
        capture::finish_drawing(app).map_or(f64::NAN, |()| frame_ms)
    };
    (0..frames).map(frame).collect()
}

/// CPU time of this thread; the time on the wall where there is no such clock.
fn cpu_time() -> Duration {
    static BEGINNING: LazyLock<Instant> = LazyLock::new(Instant::now);
    CPU_CLOCK.map_or_else(|| BEGINNING.elapsed(), |clock| clock())
}

fn median(values: &[f64]) -> f64 {
    median_and_p99(values)[0]
}

/// What the closed workbench adds to a frame, by that of a forest.
///
/// It is found over a world with nothing to draw, where apps differ least. Two alike differ by as much as the workbench may add, since each
/// lies elsewhere in memory, and is slower or faster by which was made and run before it: so there are several groups of four.
fn closed(report: &mut Report) -> Result<(), String> {
    let mut apps = Vec::new();
    for number in 0..4 * GROUPS {
        apps.push((empty(has_workbench(number))?, Vec::new()));
    }
    for _ in 0..ROUNDS {
        for (app, times_ms) in &mut apps {
            times_ms.extend(frames_ms(app, EMPTY_FRAMES));
        }
    }
    let times_ms: Vec<f64> = apps.iter().map(|(_, times_ms)| lowest_decile(times_ms)).collect();
    drop(apps);
    let added_ms = times_ms.chunks(4).map(|group| (group[1] + group[2] - group[0] - group[3]) / 2.0);
    let added_ms: Vec<f64> = added_ms.collect();
    let frame_ms = median(&frames_ms(&mut forest(false)?, FOREST_FRAMES));
    let error_ms = variance_of_mean(&added_ms).sqrt();
    let added_ms = mean(&added_ms);
    report.record("frame_ms", frame_ms, "CPU time of a frame of 500 oaks, without the workbench");
    report.record("closed_added_us", 1e3 * added_ms, "what it adds while it is closed, mean of several groups of apps");
    report.record("closed_added_error_us", 1e3 * error_ms, "standard error of that, by how the groups differ");
    report.at_most(
        "closed_frame_ratio",
        1.0 + added_ms / frame_ms,
        1.01,
        "a frame of the oaks with it over without it",
    );
    Ok(())
}

/// Whether the app of that number has the workbench: the two in the middle of a group of four.
fn has_workbench(number: usize) -> bool {
    matches!(number % 4, 1 | 2)
}

/// What a tenth of the values are below: of times, those in which nothing else of the machine came between.
fn lowest_decile(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted[sorted.len() / 10]
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Variance of the mean of such values.
fn variance_of_mean(values: &[f64]) -> f64 {
    let middle = mean(values);
    let squares: f64 = values.iter().map(|value| (value - middle).powi(2)).sum();
    squares / (values.len() * (values.len() - 1)) as f64
}

/// What each panel adds to a frame: closed, open, and open under a moving pointer in turn. Panels are not laid out in every frame, so it is the
/// mean of frames that counts, sixty of which are a second for all parts of the app.
fn open(report: &mut Report) -> Result<(), String> {
    let mut app = forest(true)?;
    // Only the panels are drawn: the camera looks into the sky.
    let world = app.world_mut();
    let mut cameras = world.query_filtered::<&mut Transform, With<Camera3d>>();
    cameras.iter_mut(world).for_each(|mut at| at.look_to(Vec3::Y, Vec3::Z));
    let mut most_ms = [0.0_f64; 2];
    for (panel, keys) in PANELS {
        let mut added_ms = [const { Vec::new() }; 2];
        for _ in 0..ROUNDS / 4 {
            let [closed_ms, open_ms, pointer_ms] =
                [(false, false), (true, false), (true, true)].map(|(is_open, has_pointer)| {
                    let mut workbench = app.world_mut().resource_mut::<Workbench>();
                    (workbench.is_open, workbench.panel) = (is_open, panel);
                    // What a panel asks for in the background, and the layout of its first frames.
                    (0..WARM_UP_FRAMES / 2).for_each(|_| app.update());
                    let frame = |frame| {
                        if has_pointer {
                            move_pointer(app.world_mut(), frame);
                        }
                        frames_ms(&mut app, 1)[0]
                    };
                    mean(&(0..PANEL_FRAMES).map(frame).collect::<Vec<_>>())
                });
            added_ms[0].push(open_ms - closed_ms);
            added_ms[1].push(pointer_ms - closed_ms);
        }
        let added_ms = added_ms.map(|of_rounds| median(&of_rounds));
        most_ms = std::array::from_fn(|which| most_ms[which].max(added_ms[which]));
        report.record(keys[0], added_ms[0], "CPU time that the open panel adds to a frame, mean of sixty");
        report.record(keys[1], added_ms[1], "the same while the pointer moves over it");
    }
    report.at_most("open_ms", most_ms[0], 1.0, "the dearest of them");
    report.record("pointer_ms", most_ms[1], "the dearest while the pointer moves");
    Ok(())
}

/// Moves the pointer up and down over the fields of a panel.
fn move_pointer(world: &mut World, frame: usize) {
    let mut contexts = world.query_filtered::<Entity, With<PrimaryEguiContext>>();
    if let Some(context) = contexts.iter(world).next() {
        let at = pos2(150.0, 200.0 + (frame * 7 % 400) as f32);
        world.write_message(EguiInputEvent { context, event: Event::PointerMoved(at) });
    }
}

/// From a change of a mature oak on the turntable to the tree that shows it.
fn rebuild(report: &mut Report) -> Result<(), String> {
    let mut app = App::new();
    app.add_plugins((capture::headless_engine(None), WindwoodPlugins))
        .add_plugins(EditorPlugin { file: Some(oak_file()), turntable: true, starts_open: true, ..default() })
        .insert_resource(LevelOfDetail { style: LevelStyle::Full, ..default() });
    capture::begin(&mut app)?;
    let camera = app.world_mut().spawn_empty().id();
    point_at_window(&mut app, camera);
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
