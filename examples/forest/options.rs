//! Command-line options of the forest.

use crate::support::{
    arguments::in_range,
    daylight::Daylight,
    options::{ForestDistanceOptions, SceneOptions},
};
use clap::{Parser, ValueEnum};
use std::path::PathBuf;

/// A forest in the wind.
#[derive(Parser, Clone, Debug)]
#[command(about = "A hillside forest in a turbulent wind. Flies in a window, or renders pictures where there is none.")]
pub struct Options {
    /// Number of trees.
    #[arg(long, default_value_t = 1000, value_parser = clap::value_parser!(u32).range(0..=4_000_000))]
    pub trees: u32,
    /// Side of the square that the trees stand in, m. With it the forest grows from a plan around the camera, as far as
    /// `--trees-to` and `--far-to` say, and has more species, a hamlet and a meadow. More than a few thousand trees need it.
    #[arg(long, value_parser = extent)]
    pub extent: Option<f32>,
    #[command(flatten)]
    pub distances: ForestDistanceOptions,
    /// Where to look from.
    #[arg(long, value_enum, default_value_t = View::Hillside)]
    pub view: View,
    /// The state of the sky.
    #[arg(long, value_enum, default_value_t = Light::Afternoon)]
    pub light: Light,
    /// A file of elevations: a GeoTIFF, an ESRI ASCII grid, an SRTM tile, or a PNG with 16 bits of grey in metres, first row northernmost.
    #[arg(long)]
    pub ground: Option<PathBuf>,
    /// Distance between the elevations, m. A PNG needs it, other files have it.
    #[arg(long, value_parser = cell_size)]
    pub cell_size: Option<f32>,
    #[command(flatten)]
    pub scene: SceneOptions,
}

/// A place to look from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum View {
    /// Over the forest, up the slope.
    Hillside,
    /// From the meadow, at eye height, at the trees of the edge.
    Edge,
    /// Under the trees, at eye height.
    Inside,
    /// From above.
    Aerial,
}

/// A state of the sky.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Light {
    /// A clear afternoon.
    Afternoon,
    /// The sun is low, and mist lies among the trees.
    Morning,
    /// The sun is about to set.
    Dusk,
    /// Clouds.
    Storm,
}

impl Light {
    pub fn daylight(self) -> Daylight {
        match self {
            Self::Afternoon => Daylight::AFTERNOON,
            Self::Morning => Daylight::MORNING,
            Self::Dusk => Daylight::DUSK,
            Self::Storm => Daylight::STORM,
        }
    }
}

fn extent(text: &str) -> Result<f32, String> {
    in_range(text, 200.0, 50_000.0, "m")
}

fn cell_size(text: &str) -> Result<f32, String> {
    in_range(text, 0.01, 10_000.0, "m")
}
