//! A picture of each panel, view and dialog.

use crate::{
    options::Options,
    studio,
    support::capture::{self, create_folder, forests_are_drawn, save, step},
};
use bevy::prelude::*;
use bevy_egui::{EguiContext, PrimaryEguiContext, egui::ThemePreference};
use bevy_windwood::{
    editor::{Arrangement, Dialog, Panel, Stage, StageCamera, View, Workbench},
    prelude::*,
    terrain::TerrainChunks,
};
use std::{
    path::Path,
    time::{Duration, Instant},
};

/// Longest wait for what a picture shows.
const TIMEOUT: Duration = Duration::from_secs(300);
/// Frames after which panels have their layout, and a tree is drawn.
const SETTLING_FRAMES: usize = 8;

/// A picture.
struct Shot {
    name: &'static str,
    panel: Panel,
    stage: Stage,
    /// The species, if it is another than that of the options.
    species: Option<&'static str>,
    /// What is looked for among the fields.
    filter: &'static str,
    dialog: Option<fn(&Path) -> Dialog>,
    /// Whether something is changed before.
    is_changed: bool,
    /// The ground, if it is another than that of the options.
    ground: Option<&'static str>,
    /// Where a wood or ground is looked at: place (x, z) and distance, m, and angle over the level, degrees.
    look: ([f32; 2], f32, f32),
}

impl Default for Shot {
    fn default() -> Self {
        Self {
            name: "species",
            panel: Panel::Species,
            stage: Stage::default(),
            species: None,
            filter: "",
            dialog: None,
            is_changed: false,
            ground: None,
            look: ([0.0, 10.0], 1200.0, 55.0),
        }
    }
}

fn shots() -> Vec<Shot> {
    let view = |name, view| Shot { name, stage: Stage { view, ..default() }, ..default() };
    let row = |name, arrangement| Shot { name, stage: Stage { arrangement, ..default() }, ..default() };
    vec![
        Shot::default(),
        Shot { name: "starling", species: Some("impression_summer"), ..default() },
        Shot { name: "search", filter: "angle", ..default() },
        Shot {
            name: "compare",
            stage: Stage { compares: true, ..default() },
            is_changed: true,
            filter: "growth.trunk",
            ..default()
        },
        Shot { name: "envelope", stage: Stage { shows_envelope: true, ..default() }, ..default() },
        row("ages", Arrangement::Ages),
        row("seasons", Arrangement::Seasons),
        row("variants", Arrangement::Variants),
        view("wireframe", View::Wireframe),
        view("skeleton", View::Skeleton),
        view("frequencies", View::Frequencies),
        view("levels", View::Levels),
        view("leaf_area", View::LeafArea),
        Shot { name: "woods", panel: Panel::Woods, ..default() },
        Shot { name: "ground", panel: Panel::Ground, look: ([0.0; 2], 1500.0, 24.0), ..default() },
        Shot {
            name: "control_points",
            panel: Panel::Ground,
            ground: Some("terrain/five_patches.ground.ron"),
            look: ([0.0; 2], 620.0, 28.0),
            ..default()
        },
        Shot { name: "wind", panel: Panel::Wind, stage: Stage { shows_wind: true, ..default() }, ..default() },
        Shot { name: "cost", panel: Panel::Levels, ..default() },
        Shot { name: "open", dialog: Some(Dialog::open), ..default() },
        Shot { name: "shortcuts", dialog: Some(|_| Dialog::Shortcuts), ..default() },
    ]
}

/// Renders the pictures.
///
/// # Errors
/// If what a picture shows does not get ready, or a file cannot be written.
pub fn render(app: &mut App, options: &Options) -> Result<(), String> {
    capture::begin(app)?;
    let target = capture::target(app, options.image.render_size());
    app.world_mut().spawn((StageCamera, capture::camera(&target), studio::projection()));
    create_folder(&options.out)?;
    let shots = shots();
    for shot in &shots {
        if !options.pictures.is_empty() && options.pictures.iter().all(|name| name != shot.name) {
            continue;
        }
        show(app, options, shot);
        shoot(app, &target, options, &format!("workbench_{}", shot.name))?;
    }
    Ok(())
}

/// Waits for what is to be seen, and takes a picture of that name.
///
/// # Errors
/// If it does not get ready, or the file cannot be written.
pub fn shoot(app: &mut App, target: &Handle<Image>, options: &Options, name: &str) -> Result<(), String> {
    // The panels are there after the first frames.
    look(app, false);
    (0..SETTLING_FRAMES).for_each(|_| step(app));
    set_theme(app, options);
    wait(app, name)?;
    let picture = capture::capture(app, target, options.image.size)?;
    let path = options.out.join(format!("{name}.png"));
    save(&picture, &path)?;
    println!("{}", path.display());
    Ok(())
}

/// Has the workbench show what a picture is of.
fn show(app: &mut App, options: &Options, shot: &Shot) {
    let folder = options.file.parent().unwrap_or(Path::new("."));
    let file = shot.species.map_or_else(|| options.file.clone(), |name| folder.join(format!("{name}.species.ron")));
    let world = app.world_mut();
    let mut workbench = world.resource_mut::<Workbench>();
    open(&mut workbench, &file);
    if let Some(ground) = shot.ground {
        workbench.open_ground(&Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/assets")).join(ground));
    }
    let (place, distance_m, rise_deg) = shot.look;
    workbench.look_at_place(place.into(), distance_m, rise_deg);
    workbench.panel = shot.panel;
    workbench.stage = shot.stage.clone();
    workbench.find_field(shot.filter);
    workbench.show_dialog(shot.dialog.map(|dialog| dialog(&file)));
    if shot.is_changed {
        let mut species = workbench.species().clone();
        if let bevy_windwood::tree::Growth::ReevesBlau(growth) = &mut species.growth {
            growth.trunk.height_m *= 1.3;
            growth.envelope.top_m *= 1.3;
            growth.envelope.radius_m *= 0.6;
        }
        workbench.change(species, "Slender");
    }
}

/// Has panels in the colours that were asked for. Nothing fades in: the clock of pictures stands still.
fn set_theme(app: &mut App, options: &Options) {
    let theme = if options.light { ThemePreference::Light } else { ThemePreference::Dark };
    let world = app.world_mut();
    let mut contexts = world.query_filtered::<&mut EguiContext, With<PrimaryEguiContext>>();
    for mut context in contexts.iter_mut(world) {
        let context = context.get_mut();
        context.set_theme(theme);
        context.all_styles_mut(|style| style.animation_time = 0.0);
    }
}

/// Opens the file as it is on disk: what a picture before has changed is given up.
fn open(workbench: &mut Workbench, file: &Path) {
    workbench.undo_all();
    workbench.open_file(file);
}

fn wait(app: &mut App, name: &str) -> Result<(), String> {
    let panel = app.world().resource::<Workbench>().panel;
    let start = Instant::now();
    // What is asked for has to be taken up before it can be seen to be missing.
    // Software takes a second for a picture of a tree: it is looked at when it is the right one.
    look(app, false);
    (0..SETTLING_FRAMES).for_each(|_| step(app));
    // Woods and ground grow about what looks at them.
    let eye = camera(app);
    let viewpoint = app.world_mut().spawn((Viewpoint, eye)).id();
    let mut is_ready = false;
    while !is_ready && start.elapsed() < TIMEOUT {
        let eye = camera(app);
        app.world_mut().entity_mut(viewpoint).insert(eye);
        app.update();
        std::thread::sleep(Duration::from_millis(2));
        is_ready = is_shown(app, panel);
    }
    app.world_mut().despawn(viewpoint);
    if !is_ready {
        return Err(format!("what the picture `{name}` shows did not get ready"));
    }
    look(app, true);
    (0..SETTLING_FRAMES).for_each(|_| step(app));
    Ok(())
}

/// Whether all that the picture shows is there.
fn is_shown(app: &mut App, panel: Panel) -> bool {
    let world = app.world_mut();
    let is_settled = world.resource::<Workbench>().is_settled() && world.resource::<ActiveSway>().is_ready();
    let is_raised = !panel.is_of_land()
        || (world.query::<&TerrainChunks>().iter(world).count() == 1
            && world.query::<&TerrainChunks>().iter(world).all(TerrainChunks::is_complete));
    let is_planted = panel != Panel::Woods || forests_are_drawn(world);
    is_settled && is_raised && is_planted
}

fn camera(app: &mut App) -> Transform {
    let world = app.world_mut();
    let mut cameras = world.query_filtered::<&Transform, With<StageCamera>>();
    cameras.iter(world).next().copied().unwrap_or_default()
}

/// Switches the camera of the turntable on or off.
pub fn look(app: &mut App, is_active: bool) {
    let world = app.world_mut();
    let mut cameras = world.query_filtered::<&mut Camera, With<StageCamera>>();
    cameras.iter_mut(world).for_each(|mut camera| camera.is_active = is_active);
}
