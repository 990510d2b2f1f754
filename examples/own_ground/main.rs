//! A game's own ground under a forest and a meadow: a function of the place, a mesh, or what rays hit.
//!
//! `--ground function` is drawn as a `Terrain`. `mesh` and `rays` stand for a level that a game draws itself: a mesh of its own, and a
//! physics engine that can be asked what lies below a point. In a window: fly with W, A, S, D, Q, E and the mouse. Without a display, or with
//! `--headless`, pictures are written instead.
//!
//! `cargo run --example own_ground -- --help` lists the options.

mod level;
mod options;
mod scene;
#[path = "../support/mod.rs"]
mod support;

use clap::Parser;
use options::Options;
use scene::OwnGroundScene;
use std::process::ExitCode;

fn main() -> ExitCode {
    let mut options = Options::parse();
    options.scene.image.choose_pictures_without_display(&options.scene.series.out);
    support::scene::run(OwnGroundScene { options })
}
