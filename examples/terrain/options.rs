//! What the terrain may be told on its command line.

use crate::arguments::{in_range, seconds, size, wind_speed};
use clap::{Parser, ValueEnum};
use std::path::PathBuf;

/// A mountain range with its woods.
#[derive(Parser, Clone, Debug)]
#[command(about = "A mountain range with its woods. Flies in a window, or renders pictures where there is none.")]
pub struct Options {
    /// Where to begin, or to look from.
    #[arg(long, value_enum, default_value_t = View::Valley)]
    pub view: View,
    /// Trees stand as far as this from the camera, m.
    #[arg(long, default_value_t = 150.0, value_parser = trees_to)]
    pub trees_to: f32,
    /// Beyond, trees are drawn as cards as far as this; farther, woods are a colour of the ground, m.
    #[arg(long, default_value_t = 2500.0, value_parser = far_to)]
    pub far_to: f32,
    /// Leaves the trees out.
    #[arg(long)]
    pub no_trees: bool,
    /// Mean wind speed at 10 m above ground, m/s.
    #[arg(long, default_value_t = 9.0, value_parser = wind_speed)]
    pub wind: f32,
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
    /// At the height of the eyes, on a slope by a valley.
    Valley,
    /// From below the highest summit, along the range.
    Summit,
    /// From the air.
    Aerial,
}

fn far_to(text: &str) -> Result<f32, String> {
    in_range(text, 0.0, 20_000.0, "m")
}

fn trees_to(text: &str) -> Result<f32, String> {
    in_range(text, 0.0, 2000.0, "m")
}
