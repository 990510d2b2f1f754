//! A hillside forest in a turbulent wind: the plugin's main job in one scene.
//!
//! A thousand trees of two species stand on real ground. All of them move in one synthesised wind field: gusts travel
//! through the wood from tree to tree, trunks sway slowly and twigs fast, leaves turn and flutter. In a window: fly with
//! W, A, S, D, Q, E and the mouse, change the wind with the arrow keys. Without a display, or with `--headless`, pictures
//! are written instead.
//!
//! With `--trees 1000000 --extent 10000` the forest is a plan over ten kilometres: trees near the camera, cards beyond, and
//! at last a colour of the ground; a hamlet stands in its midst.
//!
//! `cargo run --example forest -- --help` lists the options.

#[path = "../support/arguments.rs"]
mod arguments;
#[path = "../support/capture.rs"]
mod capture;
#[path = "../support/daylight.rs"]
mod daylight;
mod flight;
mod headless;
#[path = "../support/landscape.rs"]
mod landscape;
mod options;
mod planting;
mod scene;
mod wide;

use bevy::prelude::*;
use bevy_windwood::prelude::*;
use clap::Parser;
use landscape::Landscape;
use options::Options;
use std::process::ExitCode;

fn main() -> ExitCode {
    let options = Options::parse();
    let ground = match Landscape::load(options.ground.as_deref(), options.cell_size) {
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
    app.add_plugins((capture::engine("bevy_windwood: forest", options.size, headless), WindwoodPlugins))
        .insert_resource(Wind {
            speed: options.wind,
            direction: scene::wind_direction(&ground),
            seed: options.seed,
            roughness_m: 0.3,
            ..default()
        })
        .insert_resource(Season { year: options.year })
        .insert_resource(scene::Setting { options: options.clone(), ground })
        .add_systems(Startup, scene::build);
    if headless {
        headless::render(app, &options)
    } else {
        app.add_plugins(flight::plugin).run();
        ExitCode::SUCCESS
    }
}
