//! Every species in neutral light, by season and by age.
//!
//! In a window: left and right change the species, up and down its age, space the season. Without a display, or with
//! `--headless`, a contact sheet is written instead: a row for each species, a column for each season (or age, or view).
//!
//! `cargo run --example gallery -- --help` lists the options.

mod contact_sheet;
mod options;
mod studio;
#[path = "../support/mod.rs"]
mod support;
mod window;

use bevy::prelude::*;
use bevy_windwood::prelude::*;
use clap::Parser;
use options::Options;
use std::process::ExitCode;
use support::start;

fn main() -> ExitCode {
    let mut options = Options::parse();
    if let Err(error) = options.find_species() {
        return start::exit_code(Err(error));
    }
    options.image.choose_pictures_without_display(&options.out);
    let mut app = start::app("bevy_windwood: gallery", &options.image);
    app.insert_resource(Wind { speed: options.wind.wind, seed: 2, ..default() }).add_systems(Startup, studio::spawn);
    if options.image.headless {
        return start::exit_code(contact_sheet::render(&mut app, &options));
    }
    app.insert_resource(options).add_plugins(window::plugin).run();
    ExitCode::SUCCESS
}
