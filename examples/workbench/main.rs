//! The workbench: a tree on a turntable, a wood or a piece of ground, and panels that edit them, the wind and levels of detail.
//!
//! In a window: everything by mouse or keys; `?` lists them. Without a display, or with `--headless`, a picture of each panel is
//! written instead.
//!
//! `cargo run --features editor --example workbench -- --help` lists the options.

mod hand;
mod land;
mod options;
mod pictures;
// The gallery uses all of it.
#[allow(dead_code)]
#[path = "../gallery/studio.rs"]
mod studio;
#[path = "../support/mod.rs"]
mod support;
mod tour;

use bevy::prelude::*;
use bevy_windwood::{
    editor::{EditorPlugin, StageCamera},
    prelude::*,
    render::LevelStyle,
};
use clap::Parser;
use options::Options;
use std::process::ExitCode;
use support::{capture, start};

fn main() -> ExitCode {
    let mut options = Options::parse();
    options.image.choose_pictures_without_display(&options.out);
    if options.tour {
        options.image.headless = true;
        if let Err(error) = tour::prepare(&mut options) {
            return start::exit_code(Err(error));
        }
    }
    let engine = if options.image.headless {
        capture::headless_engine(None)
    } else {
        // The workbench closes the window itself, once it has asked about unsaved changes.
        capture::engine("bevy_windwood: workbench", options.image.size).set(WindowPlugin {
            primary_window: Some(Window {
                title: "bevy_windwood: workbench".into(),
                resolution: options.image.size.into(),
                ..default()
            }),
            close_when_requested: false,
            ..default()
        })
    };
    let mut app = App::new();
    app.add_plugins((engine, WindwoodPlugins))
        .add_plugins(EditorPlugin {
            file: Some(options.file.clone()),
            plan: Some(options.plan.clone()),
            ground: options.ground.clone(),
            turntable: true,
            starts_open: true,
        })
        // One tree needs no lower levels, and they would take longer than the tree.
        .insert_resource(LevelOfDetail { style: LevelStyle::Full, ..default() })
        .insert_resource(Wind { speed: options.wind.wind, seed: options.wind.seed, fade_s: 1.0, ..default() })
        .add_systems(Startup, studio::spawn)
        .add_plugins(land::plugin);
    if options.image.headless {
        let render = if options.tour { tour::run } else { pictures::render };
        return start::exit_code(render(&mut app, &options));
    }
    app.add_systems(Startup, |mut commands: Commands| {
        commands.spawn((StageCamera, studio::projection()));
    })
    .run();
    ExitCode::SUCCESS
}
