//! Command-line options of the terrain.

use crate::support::options::{ForestDistanceOptions, SceneOptions};
use clap::{Parser, ValueEnum};

/// A mountain range with its woods.
#[derive(Parser, Clone, Debug)]
#[command(
    about = "A mountain range with its woods. Flies in a window, or renders pictures where there is none.",
    mut_arg("trees_to", |distance| distance.default_value("150")),
    mut_arg("far_to", |distance| distance.default_value("2500")),
    mut_arg("wind", |speed| speed.default_value("9")),
    mut_arg("seed", |seed| seed.default_value("0").help("Seed of the wind")),
)]
pub struct Options {
    /// Where to look from.
    #[arg(long, value_enum, default_value_t = View::Valley)]
    pub view: View,
    #[command(flatten)]
    pub distances: ForestDistanceOptions,
    /// Leaves the trees out.
    #[arg(long)]
    pub no_trees: bool,
    #[command(flatten)]
    pub scene: SceneOptions,
}

impl Options {
    /// Whether woods grow on the ground: the plan is that of the range.
    pub fn has_woods(&self) -> bool {
        self.view != View::Patches
    }

    /// Whether their trees are drawn.
    pub fn has_trees(&self) -> bool {
        self.has_woods() && !self.no_trees
    }
}

/// A place to look from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum View {
    /// At eye height, on a slope by a valley.
    Valley,
    /// From below the highest summit, along the range.
    Summit,
    /// From the air.
    Aerial,
    /// Zaharia's ground instead of the range: five patches of a B-spline, without trees.
    Patches,
}
