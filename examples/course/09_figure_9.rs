//! Lesson 9: figure 9, an experiment to fly through.
//!
//! Setas, Gomes and Rebordao (1997) walked for three minutes through ever more trees on flat ground, and plotted the frame rate: with neither,
//! either, or both of two techniques. The first is a voxel grid: only cells that are in view are drawn. The second is levels of detail: a tree
//! that is small on the picture is drawn with less. This is their walk. V and L switch the techniques, as you go.
//!
//! Both are resources here, and a game need not touch them. `ForestCulling` is the grid: cells that no camera sees, and whose shadows fall
//! out of view, are hidden. `LevelOfDetail` says at which size on the picture a tree changes to its next level, and of which style the levels
//! are: thinned trees and impostors, or the paper's envelope of leaves and four polygons (`--paper-levels`). G draws the cells and the levels
//! as lines.
//!
//! What to look for: with a hundred trees it makes no difference, with ten thousand the picture stands still without levels. The grid alone
//! helps as much as the part of the wood that is behind you, and no more. The same curves, measured: `docs/figure9.png`, by `cargo run
//! --example validate -- figure9`.
//!
//! Without a display, or with `--headless`, pictures along the path are written. The walk itself is in `tools/support/walk.rs`, which the
//! measurement shares.

#[path = "../support/mod.rs"]
mod support;
#[path = "../../tools/support/walk.rs"]
mod walk;

use bevy::{
    diagnostic::{Diagnostic, DiagnosticsStore, FrameTimeDiagnosticsPlugin},
    prelude::*,
};
use bevy_windwood::{forest::ForestGizmos, prelude::*};
use clap::Parser;
use std::{path::PathBuf, process::ExitCode};
use support::{
    capture,
    options::ImageOptions,
    start,
    window::{StatusText, show_status, spawn_text},
};
use walk::{PATH_S, Technique};

/// The experiment of figure 9.
#[derive(Parser, Clone)]
#[command(
    about = "A walk through trees on flat ground, with and without voxel grid and levels of detail",
    mut_arg("size", |size| size.default_value("640x360")),
)]
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
    /// Draws the levels of the paper: an envelope of leaves, then four polygons.
    #[arg(long)]
    paper_levels: bool,
    #[command(flatten)]
    image: ImageOptions,
    /// Number of pictures, evenly along three minutes of the path.
    #[arg(long, default_value_t = 3, value_parser = clap::value_parser!(u32).range(1..=1000))]
    frames: u32,
    /// Folder for the pictures.
    #[arg(long, default_value = "out")]
    out: PathBuf,
}

fn main() -> ExitCode {
    let mut options = Options::parse();
    let style = if options.paper_levels { LevelStyle::Paper } else { LevelStyle::Thinned };
    let technique = Technique { voxels: !options.no_voxels, levels: !options.no_levels, style };
    options.image.choose_pictures_without_display(&options.out);
    if options.image.headless {
        return start::exit_code(render_pictures(&options, technique));
    }
    let mut app = start::app("bevy_windwood: figure 9", &options.image);
    app.add_plugins(FrameTimeDiagnosticsPlugin::default());
    walk::build(&mut app, options.trees, technique);
    app.world_mut().spawn(walk::camera(None));
    app.add_systems(Startup, spawn_text(&["V  voxel grid    L  levels of detail    G  boxes of the cells"]))
        .add_systems(Update, (follow_path(options.trees), switch_techniques, show_frame_rate))
        .run();
    ExitCode::SUCCESS
}

fn render_pictures(options: &Options, technique: Technique) -> Result<(), String> {
    capture::create_folder(&options.out)?;
    let (mut app, camera, target) = walk::headless(options.trees, technique, options.image.render_size())?;
    for frame in 0..options.frames {
        let time_s = PATH_S * frame as f32 / options.frames as f32;
        if let Some(mut at) = app.world_mut().get_mut::<Transform>(camera) {
            *at = walk::place(options.trees, time_s);
        }
        walk::settle(&mut app, 500)?;
        let picture = capture::capture(&mut app, &target, options.image.size)?;
        let path = options.out.join(format!("09_figure_9_{frame:03}.png"));
        capture::save(&picture, &path)?;
        println!("{}", path.display());
    }
    Ok(())
}

fn follow_path(trees: u32) -> impl FnMut(Res<Time>, Single<&mut Transform, With<Camera3d>>) {
    move |time, mut camera| **camera = walk::place(trees, time.elapsed_secs() % PATH_S)
}

fn switch_techniques(
    keys: Res<ButtonInput<KeyCode>>,
    mut technique: ResMut<Technique>,
    mut gizmos: ResMut<ForestGizmos>,
) {
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

fn show_frame_rate(
    diagnostics: Res<DiagnosticsStore>,
    technique: Res<Technique>,
    mut text: Single<&mut TextSpan, With<StatusText>>,
) {
    let rate = diagnostics.get(&FrameTimeDiagnosticsPlugin::FPS).and_then(Diagnostic::smoothed).unwrap_or(0.0);
    let state = |is_on: bool| if is_on { "on" } else { "off" };
    let [voxels, levels] = [technique.voxels, technique.levels].map(state);
    show_status(&mut text, format!("{rate:.1} frames/s    voxel grid {voxels}    levels of detail {levels}"));
}
