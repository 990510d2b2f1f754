//! What the forest may be told on its command line.

use crate::arguments::{in_range, seconds, size, wind_speed};
use bevy_windwood::tree::Season;
use clap::{Parser, ValueEnum};
use std::path::PathBuf;

/// A forest in the wind.
#[derive(Parser, Clone, Debug)]
#[command(about = "A hillside forest in a turbulent wind. Flies in a window, or renders pictures where there is none.")]
pub struct Options {
    /// Number of trees.
    #[arg(long, default_value_t = 1000, value_parser = clap::value_parser!(u32).range(0..=4_000_000))]
    pub trees: u32,
    /// Side of the square that they stand in, m: beyond a few thousand trees the forest grows about the camera as it flies, and
    /// has more species, a hamlet and a meadow.
    #[arg(long, value_parser = extent)]
    pub extent: Option<f32>,
    /// With `--extent`: trees stand as far as this from the camera, m.
    #[arg(long, default_value_t = 200.0, value_parser = trees_to)]
    pub trees_to: f32,
    /// With `--extent`: beyond, they are drawn as cards as far as this; farther, the forest is a colour of the ground, m.
    #[arg(long, default_value_t = 6000.0, value_parser = far_to)]
    pub far_to: f32,
    /// Another seed is another forest in another wind.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Mean wind speed at 10 m above ground, m/s.
    #[arg(long, default_value_t = 10.0, value_parser = wind_speed)]
    pub wind: f32,
    /// The time of the year: 0 midwinter, 0.34 spring, 0.55 summer, 0.81 autumn.
    #[arg(long, default_value_t = Season::SUMMER.year, value_parser = year)]
    pub year: f32,
    /// Where to look from.
    #[arg(long, value_enum, default_value_t = View::Hillside)]
    pub view: View,
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
    /// Writes the pictures side by side, and what moved between the first and the last, instead of each on its own.
    #[arg(long)]
    pub strip: bool,
    /// A 16-bit grey PNG of elevations in metres, first row northernmost.
    #[arg(long)]
    pub ground: Option<PathBuf>,
    /// Distance between the elevations, m.
    #[arg(long, default_value_t = 233.0, value_parser = cell_size)]
    pub cell_size: f32,
}

/// A place to look from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum View {
    /// Over the forest, up the slope.
    Hillside,
    /// From the meadow, at eye height, at the trees of the edge.
    Edge,
    /// From above.
    Aerial,
}

fn year(text: &str) -> Result<f32, String> {
    in_range(text, 0.0, 1.0, "of the year")
}

fn cell_size(text: &str) -> Result<f32, String> {
    in_range(text, 0.01, 10_000.0, "m")
}

fn extent(text: &str) -> Result<f32, String> {
    in_range(text, 200.0, 50_000.0, "m")
}

fn trees_to(text: &str) -> Result<f32, String> {
    in_range(text, 0.0, 2000.0, "m")
}

fn far_to(text: &str) -> Result<f32, String> {
    in_range(text, 0.0, 20_000.0, "m")
}
