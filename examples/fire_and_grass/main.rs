//! A meadow and a camp fire at dusk.
//!
//! Some 40,000 blades of grass bend in the synthesised wind: gusts run over the meadow as waves. A fire of rhombs burns in a
//! ring of stones, leans with the same wind and lights the grass. In a window: fly with W, A, S, D, Q, E and the mouse,
//! change the wind with the arrow keys, feed the fire with F. Without a display, or with `--headless`, pictures are written
//! instead.
//!
//! `cargo run --example fire_and_grass -- --help` lists the options.

mod fireplace;
mod ground;
mod options;
mod scene;
#[path = "../support/mod.rs"]
mod support;
mod window;

use clap::Parser;
use options::Options;
use scene::MeadowScene;
use std::process::ExitCode;

fn main() -> ExitCode {
    let mut options = Options::parse();
    options.scene.image.choose_pictures_without_display(&options.scene.series.out);
    support::scene::run(MeadowScene { options })
}
