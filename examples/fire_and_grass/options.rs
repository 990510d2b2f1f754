//! Command-line options of the meadow.

use crate::support::options::SceneOptions;
use clap::{Parser, ValueEnum};

/// A meadow and a camp fire.
#[derive(Parser, Clone, Debug)]
#[command(
    about = "A meadow and a camp fire at dusk. Flies in a window, or renders pictures where there is none.",
    mut_arg("wind", |speed| speed.default_value("6")),
)]
pub struct Options {
    /// Where to look from.
    #[arg(long, value_enum, default_value_t = View::Fire)]
    pub view: View,
    /// Leaves out the trees behind the meadow.
    #[arg(long)]
    pub no_trees: bool,
    #[command(flatten)]
    pub scene: SceneOptions,
}

/// A place to look from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum View {
    /// From a few steps away, at the fire.
    Fire,
    /// Over the meadow, with the fire in it.
    Meadow,
    /// Close to the flames.
    Close,
}
