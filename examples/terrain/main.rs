//! A whole mountain range, 35 x 44 km, with its woods: real elevations, drawn from the grass at one's feet to the horizon.
//!
//! The ground is a pyramid of chunks that are built in the background as the camera flies; trees grow from a plan, cell by
//! cell, wherever the camera is. In a window: fly with W, A, S, D, Q, E and the mouse, and hold Shift to fly fast. Without a
//! display, or with `--headless`, pictures are written instead.
//!
//! `cargo run --example terrain -- --help` lists the options.

#[path = "../support/arguments.rs"]
mod arguments;
#[path = "../support/capture.rs"]
mod capture;
#[path = "../support/daylight.rs"]
mod daylight;
mod flight;
#[path = "../forest/headless.rs"]
mod headless;
#[path = "../support/landscape.rs"]
mod landscape;
mod options;
mod scene;

use bevy::prelude::*;
use bevy_windwood::prelude::*;
use clap::Parser;
use landscape::Landscape;
use options::Options;
use std::process::ExitCode;

fn main() -> ExitCode {
    let options = Options::parse();
    let ground = match Landscape::load(None, 0.0) {
        Ok(ground) => ground,
        Err(error) => {
            eprintln!("cannot use the ground: {error}");
            return ExitCode::FAILURE;
        }
    };
    let headless = options.headless || !capture::has_display();
    if headless && !options.headless {
        println!("There is no display: writing pictures to `{}` instead.", options.out.display());
    }
    let mut app = App::new();
    app.add_plugins((capture::engine("bevy_windwood: terrain", options.size, headless), WindwoodPlugins))
        .insert_resource(Wind { speed: options.wind, direction: Dir2::X, roughness_m: 0.3, ..default() })
        .insert_resource(scene::Setting { options: options.clone(), ground })
        .add_systems(Startup, scene::build);
    if headless {
        headless::render(app, &options)
    } else {
        app.add_plugins(flight::plugin).run();
        ExitCode::SUCCESS
    }
}
