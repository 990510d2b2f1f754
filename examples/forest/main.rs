//! A hillside forest in a turbulent wind: the plugin's main job in one scene.
//!
//! A thousand trees of two species stand on real ground. All of them move in one synthesised wind field: gusts travel
//! through the forest from tree to tree, trunks sway slowly and twigs fast, leaves turn and flutter. In a window: fly
//! with W, A, S, D, Q, E and the mouse, change the wind with the arrow keys. Without a display, or with `--headless`,
//! pictures are written instead.
//!
//! With `--trees 1000000 --extent 10000` the forest grows from a plan over ten kilometres: trees near the camera,
//! impostors beyond, and farther away a colour of the ground. A hamlet stands in its middle.
//!
//! `cargo run --example forest -- --help` lists the options.

mod large;
mod options;
mod scene;
mod small;
#[path = "../support/mod.rs"]
mod support;
mod undergrowth;
mod window;

use clap::Parser;
use options::Options;
use scene::ForestScene;
use std::process::ExitCode;
use support::landscape::Landscape;

fn main() -> ExitCode {
    let mut options = Options::parse();
    options.scene.image.choose_pictures_without_display(&options.scene.series.out);
    match Landscape::load(options.ground.as_deref(), options.cell_size) {
        Ok(landscape) => support::scene::run(ForestScene { options, landscape }),
        Err(error) => support::start::exit_code(Err(format!("cannot use the ground: {error}"))),
    }
}
