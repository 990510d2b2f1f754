//! A meadow and a camp fire at dusk.
//!
//! Some 40,000 blades of grass bend in the synthesised wind: gusts run over the meadow as waves. A fire of rhombs burns in a
//! ring of stones, leans with the same wind and lights the grass. In a window: fly with W, A, S, D, Q, E and the mouse,
//! change the wind with the arrow keys, feed the fire with F. Without a display, or with `--headless`, pictures are written
//! instead.
//!
//! `cargo run --example fire_and_grass -- --help` lists the options.

#[path = "../support/arguments.rs"]
mod arguments;
#[path = "../support/capture.rs"]
mod capture;
mod flight;
mod ground;
#[path = "../forest/headless.rs"]
mod headless;
mod options;
mod scene;

use bevy::prelude::*;
use bevy_windwood::prelude::*;
use clap::Parser;
use options::Options;
use std::process::ExitCode;

fn main() -> ExitCode {
    let options = Options::parse();
    let headless = options.headless || !capture::has_display();
    if headless && !options.headless {
        println!("There is no display: writing pictures to `{}` instead.", options.out.display());
    }
    let mut app = App::new();
    app.add_plugins((capture::engine("bevy_windwood: fire and grass", options.size, headless), WindwoodPlugins))
        .insert_resource(Wind {
            speed: options.wind,
            direction: scene::wind_direction(),
            seed: options.seed,
            roughness_m: 0.05,
            gustiness: 1.6,
            ..default()
        })
        .insert_resource(scene::Setting { options: options.clone() })
        .add_systems(Startup, scene::build);
    if headless {
        headless::render(app, &options)
    } else {
        app.add_plugins(flight::plugin).run();
        ExitCode::SUCCESS
    }
}
