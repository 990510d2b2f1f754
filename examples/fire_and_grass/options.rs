//! What the scene may be told on its command line.

use crate::arguments::{seconds, size, wind_speed};
use clap::{Parser, ValueEnum};
use std::path::PathBuf;

/// A meadow and a camp fire.
#[derive(Parser, Clone, Debug)]
#[command(about = "A meadow and a camp fire at dusk. Flies in a window, or renders pictures where there is none.")]
pub struct Options {
    /// Another seed is another meadow and another fire in another wind.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Mean wind speed at 10 m above ground, m/s.
    #[arg(long, default_value_t = 6.0, value_parser = wind_speed)]
    pub wind: f32,
    /// Where to look from.
    #[arg(long, value_enum, default_value_t = View::Fire)]
    pub view: View,
    /// Leaves the trees behind the meadow out.
    #[arg(long)]
    pub no_trees: bool,
    /// Renders pictures instead of opening a window; the default where there is no display.
    #[arg(long)]
    pub headless: bool,
    /// Number of pictures.
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    pub frames: u32,
    /// Time between two pictures, s.
    #[arg(long, default_value_t = 0.5, value_parser = seconds)]
    pub interval: f64,
    /// Time of the first picture, s.
    #[arg(long, default_value_t = 40.0, value_parser = seconds)]
    pub start: f64,
    /// Size of a picture or of the window.
    #[arg(long, default_value = "960x540", value_parser = size)]
    pub size: (u32, u32),
    /// Renders pictures so many times as wide and high and scales them down.
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=4))]
    pub supersample: u32,
    /// Folder for the pictures.
    #[arg(long, default_value = "out")]
    pub out: PathBuf,
    /// Also writes the pictures side by side, and what moved between the first and the last.
    #[arg(long)]
    pub strip: bool,
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
