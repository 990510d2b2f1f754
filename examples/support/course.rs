//! What the lessons of the course share, so that each of them is one file: a window to fly in, or pictures where there is no display, a
//! day or an evening, and a meadow.

use super::{
    capture::{self, create_folder, save},
    daylight::Daylight,
    dusk, meadow,
    options::ImageOptions,
    pictures::{TIMEOUT, WARM_UP_FRAMES, is_drawn, let_time_pass},
    scene::no_plan_failed,
    start,
    window::{CAMERA_KEYS, spawn_text},
};
use bevy::{
    app::PluginGroupBuilder, camera::RenderTarget, camera_controller::free_camera::FreeCameraPlugin,
    core_pipeline::prepass::DepthPrepass, ecs::lifecycle::Add, math::DVec2, prelude::*,
};
use bevy_windwood::prelude::*;
use clap::Parser;
use std::{
    path::PathBuf,
    process::ExitCode,
    time::{Duration, Instant},
};

/// Radius of the sky, m: within the reach of a usual camera.
const SKY_M: f32 = 850.0;

/// A lesson of the course: a scene that is flown through in a window, or rendered to pictures.
#[derive(Parser)]
struct Options {
    #[command(flatten)]
    image: ImageOptions,
    /// Time of the first picture, s. [default: the lesson's own]
    #[arg(long)]
    at: Option<f64>,
    /// Number of pictures.
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    frames: u32,
    /// Time between two pictures, s.
    #[arg(long, default_value_t = 0.5)]
    interval: f64,
    /// Folder for the pictures.
    #[arg(long, default_value = "out")]
    out: PathBuf,
}

/// A lesson: it opens a window, or writes pictures.
pub struct Course {
    name: &'static str,
    options: Options,
    picture_s: f64,
    is_evening: bool,
}

impl Course {
    /// Reads the command line of a lesson.
    pub fn begin(name: &'static str) -> Self {
        let mut options = Options::parse();
        options.image.choose_pictures_without_display(&options.out);
        Self { name, options, picture_s: 0.0, is_evening: false }
    }

    /// The first picture shows the moment so long after everything is there, s.
    pub fn picture_after(self, picture_s: f64) -> Self {
        Self { picture_s, ..self }
    }

    /// The sun sets.
    pub fn in_the_evening(self) -> Self {
        Self { is_evening: true, ..self }
    }

    /// Bevy's `DefaultPlugins`, with a window or without one.
    pub fn engine(&self) -> PluginGroupBuilder {
        let image = &self.options.image;
        let title = format!("bevy_windwood: {}", self.name);
        if image.headless { capture::headless_engine(None) } else { capture::engine(&title, image.size) }
    }

    /// Adds sky and sun, and runs the app. `keys` are told in the window.
    pub fn run(&self, app: &mut App, keys: &str) -> ExitCode {
        if self.is_evening {
            app.add_systems(Startup, spawn_evening).add_observer(
                |camera: On<Add<Camera3d>>, mut commands: Commands| {
                    commands.entity(camera.entity).insert(dusk::camera_effects());
                },
            );
        } else {
            app.add_systems(Startup, spawn_day).add_observer(|camera: On<Add<Camera3d>>, mut commands: Commands| {
                commands.entity(camera.entity).insert(Daylight::AFTERNOON.haze(SKY_M));
            });
        }
        if self.options.image.headless {
            return start::exit_code(self.render_pictures(app));
        }
        app.add_plugins(FreeCameraPlugin).add_systems(Startup, spawn_text(&[CAMERA_KEYS, keys])).run();
        ExitCode::SUCCESS
    }

    /// The lesson's own camera renders to the pictures. Until then it has no window to render to.
    fn render_pictures(&self, app: &mut App) -> Result<(), String> {
        let Options { image, frames, interval, out, at } = &self.options;
        create_folder(out)?;
        capture::begin(app)?;
        app.world_mut().resource_mut::<LevelOfDetail>().changes_per_frame = 1_000_000;
        wait_until_drawn(app)?;
        for number in 0..*frames {
            let passes_s = if number == 0 { at.unwrap_or(self.picture_s) } else { *interval };
            if passes_s > 0.0 {
                let_time_pass(app, passes_s);
            }
            // A camera takes notice of another target when that is new.
            let target = capture::target(app, image.render_size());
            let world = app.world_mut();
            let cameras: Vec<Entity> = world.query_filtered::<Entity, With<Camera3d>>().iter(world).collect();
            for camera in &cameras {
                let target = RenderTarget::Image(target.clone().into());
                world.entity_mut(*camera).insert((target, Msaa::Off, DepthPrepass));
            }
            (0..WARM_UP_FRAMES).for_each(|_| capture::step(app));
            let picture = capture::capture(app, &target, image.size)?;
            let path = out.join(format!("{}_{number:03}.png", self.name));
            save(&picture, &path)?;
            println!("{}", path.display());
            for camera in cameras {
                app.world_mut().entity_mut(camera).insert(RenderTarget::default());
            }
        }
        Ok(())
    }
}

fn wait_until_drawn(app: &mut App) -> Result<(), String> {
    let start = Instant::now();
    while !(is_drawn(app.world_mut())? && no_plan_failed(app.world_mut())?) {
        app.update();
        if start.elapsed() > TIMEOUT {
            return Err("the wind or a species did not get ready; see the warnings above".into());
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    Ok(())
}

fn spawn_day(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    Daylight::AFTERNOON.spawn(&mut commands, &mut meshes, &mut materials, (Vec3::ZERO, SKY_M), (25.0, 140.0));
}

fn spawn_evening(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    dusk::spawn_light(&mut commands, &mut meshes, &mut materials);
}

/// The meadow's ground: level about the origin, with hills beyond.
fn meadow_height_m(at: DVec2) -> f64 {
    let beyond = ((at.length() - 35.0) / 140.0).clamp(0.0, 1.0);
    let hills = 7.0 + 6.0 * (at.x / 67.0).sin() * (at.y / 58.0).cos() + 3.0 * (at.x / 29.0 + at.y / 41.0).sin();
    beyond * beyond * (3.0 - 2.0 * beyond) * hills
}

/// A system that spawns a meadow, which is level about the origin: a place for everything else.
pub fn spawn_meadow(mut commands: Commands) {
    commands.spawn((
        Terrain::new(meadow_height_m),
        TerrainSettings { reach_m: 1000.0, builds_at_once: 64, chunks_per_frame: 64, ..default() },
    ));
    meadow::spawn_meadow(&mut commands, meadow_height_m, None, 0);
}
