//! Command-line options.

use crate::support::options::{ForestDistanceOptions, SceneOptions};
use clap::{Parser, ValueEnum};

/// A game's own ground under a forest and a meadow.
#[derive(Parser, Clone, Debug)]
#[command(
    about = "A game's own ground under a forest and a meadow. Flies in a window, or renders pictures where there is none.",
    mut_arg("trees_to", |distance| distance.default_value("120")),
    mut_arg("far_to", |distance| distance.default_value("400")),
    mut_arg("wind", |speed| speed.default_value("8")),
    mut_arg("seed", |seed| seed.default_value("0").help("Seed of the wind")),
)]
pub struct Options {
    /// What the ground is.
    #[arg(long, value_enum, default_value_t = OwnGround::Mesh)]
    pub ground: OwnGround,
    #[command(flatten)]
    pub distances: ForestDistanceOptions,
    #[command(flatten)]
    pub scene: SceneOptions,
}

/// What the ground is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum OwnGround {
    /// A function of the place, drawn as a terrain.
    Function,
    /// A mesh that the game draws itself.
    Mesh,
    /// What rays hit, as a physics engine casts them.
    Rays,
}
