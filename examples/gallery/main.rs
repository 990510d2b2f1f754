//! Every species in a lit studio, by season and by age.
//!
//! In a window: left and right change the species, up and down its age, space the season. Without a display, or with
//! `--headless`, a contact sheet is written instead: a row a species, a column a season (or an age, or a close look).
//!
//! `cargo run --example gallery -- --help` lists the options.

#[path = "../support/arguments.rs"]
mod arguments;
#[path = "../support/capture.rs"]
mod capture;
mod options;
mod sheet;
mod studio;
mod visit;

use bevy::prelude::*;
use bevy_windwood::prelude::*;
use clap::Parser;
use options::Options;
use std::process::ExitCode;

fn main() -> ExitCode {
    let mut options = Options::parse();
    if let Err(error) = options.find_species() {
        eprintln!("{error}");
        return ExitCode::FAILURE;
    }
    let headless = options.headless || !capture::has_display();
    let mut app = App::new();
    app.add_plugins((capture::engine("bevy_windwood: gallery", options.size, headless), WindwoodPlugins))
        .insert_resource(Wind { speed: options.wind, seed: 2, ..default() })
        .add_systems(Startup, studio::build);
    if headless {
        return match sheet::print(app, &options) {
            Ok(()) => ExitCode::SUCCESS,
            Err(error) => {
                eprintln!("{error}");
                ExitCode::FAILURE
            }
        };
    }
    app.insert_resource(options).add_plugins(visit::plugin).run();
    ExitCode::SUCCESS
}
