//! The paper's experiment to fly through: flat ground, some number of trees, and two techniques, the voxel grid (key V) and
//! levels of detail (key L), that can be switched on and off while the frame rate is told.
//!
//! Without a display, or with `--headless`, it writes pictures from along the path instead. The measured curves are drawn by
//! `cargo run --example validate -- figure9`.

#[path = "../support/arguments.rs"]
mod arguments;
#[path = "../support/capture.rs"]
mod capture;
#[path = "../support/walk.rs"]
mod walk;

use arguments::size;
use bevy::{
    diagnostic::{DiagnosticsStore, FrameTimeDiagnosticsPlugin},
    prelude::*,
};
use bevy_windwood::{forest::ForestGizmos, prelude::*};
use clap::Parser;
use std::{
    path::{Path, PathBuf},
    process::ExitCode,
};
use walk::Technique;

/// The experiment of the paper's figure 9.
#[derive(Parser, Clone)]
#[command(about = "A walk through trees on flat ground, with and without voxel grid and levels of detail")]
struct Options {
    /// Number of trees.
    #[arg(long, default_value_t = 1000, value_parser = clap::value_parser!(u32).range(10..=100_000))]
    trees: u32,
    /// Draws every cell, in view or not.
    #[arg(long)]
    no_voxels: bool,
    /// Draws every tree in full.
    #[arg(long)]
    no_levels: bool,
    /// The paper's own levels: an envelope of leaves, then four polygons.
    #[arg(long)]
    paper_levels: bool,
    /// Renders pictures instead of opening a window; the default where there is no display.
    #[arg(long)]
    headless: bool,
    /// Number of pictures, evenly along three minutes of the path.
    #[arg(long, default_value_t = 3, value_parser = clap::value_parser!(u32).range(1..=1000))]
    frames: u32,
    /// Size of a picture or of the window.
    #[arg(long, default_value = "640x360", value_parser = size)]
    size: (u32, u32),
    /// Folder for the pictures.
    #[arg(long, default_value = "out")]
    out: PathBuf,
}

/// How long the path is, s.
const PATH_S: f32 = 180.0;

fn main() -> ExitCode {
    let options = Options::parse();
    let style = if options.paper_levels { LevelStyle::Paper } else { LevelStyle::Thinned };
    let technique = Technique { voxels: !options.no_voxels, levels: !options.no_levels, style };
    if options.headless || !capture::has_display() {
        return match pictures(&options, technique) {
            Ok(()) => ExitCode::SUCCESS,
            Err(error) => {
                eprintln!("{error}");
                ExitCode::FAILURE
            }
        };
    }
    let mut app = App::new();
    app.add_plugins((
        capture::engine("bevy_windwood: figure 9", options.size, false),
        WindwoodPlugins,
        FrameTimeDiagnosticsPlugin::default(),
    ));
    walk::build(&mut app, options.trees, technique);
    app.world_mut().spawn(walk::camera(None));
    app.add_systems(Startup, spawn_text).add_systems(Update, (follow_path(options.trees), switch, tell)).run();
    ExitCode::SUCCESS
}

fn pictures(options: &Options, technique: Technique) -> Result<(), String> {
    std::fs::create_dir_all(&options.out).map_err(|error| format!("{}: {error}", options.out.display()))?;
    let (mut app, camera, canvas) = walk::headless(options.trees, technique, options.size)?;
    for frame in 0..options.frames {
        let time_s = PATH_S * frame as f32 / options.frames as f32;
        if let Some(mut at) = app.world_mut().get_mut::<Transform>(camera) {
            *at = walk::place(options.trees, time_s);
        }
        walk::settle(&mut app, 500)?;
        let picture = capture::capture(&mut app, &canvas, options.size)?;
        let path = options.out.join(Path::new(&format!("figure9_{frame:03}.png")));
        capture::save(&picture, &path)?;
        println!("{}", path.display());
    }
    Ok(())
}

fn follow_path(trees: u32) -> impl FnMut(Res<Time>, Single<&mut Transform, With<Camera3d>>) {
    move |time, mut camera| **camera = walk::place(trees, time.elapsed_secs() % PATH_S)
}

fn spawn_text(mut commands: Commands) {
    commands.spawn((
        Text::new(""),
        TextFont { font_size: FontSize::Px(16.0), ..default() },
        Node { position_type: PositionType::Absolute, left: px(12), top: px(10), ..default() },
    ));
}

fn switch(keys: Res<ButtonInput<KeyCode>>, mut technique: ResMut<Technique>, mut gizmos: ResMut<ForestGizmos>) {
    if keys.just_pressed(KeyCode::KeyV) {
        technique.voxels = !technique.voxels;
    }
    if keys.just_pressed(KeyCode::KeyL) {
        technique.levels = !technique.levels;
    }
    if keys.just_pressed(KeyCode::KeyG) {
        gizmos.enabled = !gizmos.enabled;
    }
}

fn tell(diagnostics: Res<DiagnosticsStore>, technique: Res<Technique>, mut text: Single<&mut Text>) {
    let rate = diagnostics.get(&FrameTimeDiagnosticsPlugin::FPS).and_then(bevy::diagnostic::Diagnostic::smoothed);
    let state = |on: bool| if on { "on" } else { "off" };
    text.0 = format!(
        "{:.1} frames/s\nV  voxel grid {}\nL  levels of detail {}\nG  boxes",
        rate.unwrap_or(0.0),
        state(technique.voxels),
        state(technique.levels),
    );
}
