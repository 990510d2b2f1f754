//! A whole mountain range, 35 x 44 km, with its woods: real elevations, drawn from the grass to the horizon.
//!
//! The ground is a pyramid of chunks that are built in the background as the camera flies. Trees grow from a plan, cell by
//! cell, wherever the camera is. In a window: fly with W, A, S, D, Q, E and the mouse, and hold Shift to fly fast. Without
//! a display, or with `--headless`, pictures are written instead.
//!
//! `cargo run --example terrain -- --help` lists the options.

mod options;
mod scene;
#[path = "../support/mod.rs"]
mod support;
mod window;

use clap::Parser;
use options::{Options, View};
use scene::TerrainScene;
use std::process::ExitCode;
use support::landscape::Landscape;

fn main() -> ExitCode {
    let mut options = Options::parse();
    options.scene.image.choose_pictures_without_display(&options.scene.series.out);
    let landscape = match options.view {
        View::Patches => Landscape::five_patches(),
        View::Valley | View::Summit | View::Aerial => Landscape::load(None, None),
    };
    match landscape {
        Ok(landscape) => support::scene::run(TerrainScene { options, landscape }),
        Err(error) => support::start::exit_code(Err(format!("cannot use the ground: {error}"))),
    }
}
