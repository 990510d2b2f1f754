//! What a game does to trees and grass: a blast, an axe, a ball that rolls through a bush, a helicopter.
//!
//! In a window: fly with W, A, S, D, Q, E and the mouse, B sets off the charge, X strikes the birch, and the ball and the helicopter
//! come round by themselves. Without a display, or with `--headless`, pictures are written instead: the first is of the moment before.
//!
//! `cargo run --example blast_and_axe -- --help` lists the options.

mod actors;
mod options;
mod scene;
#[path = "../support/mod.rs"]
mod support;
mod window;

use clap::Parser;
use options::Options;
use scene::BlastScene;
use std::process::ExitCode;

fn main() -> ExitCode {
    let mut options = Options::parse();
    options.scene.image.choose_pictures_without_display(&options.scene.series.out);
    support::scene::run(BlastScene { options })
}
