//! Groups of command-line options. An example flattens those that it has, and changes their defaults with `mut_arg`.

use super::arguments::{in_range, seconds, size, wind_speed, year};
use bevy::prelude::default;
use bevy_windwood::prelude::*;
use clap::Args;
use std::path::{Path, PathBuf};

/// Options of a scene that is flown through in a window or rendered to a series of pictures.
#[derive(Args, Clone, Debug)]
pub struct SceneOptions {
    #[command(flatten)]
    pub wind: WindOptions,
    /// Time of the year: 0 midwinter, 0.34 spring, 0.55 summer, 0.81 autumn.
    #[arg(long, default_value_t = Season::SUMMER.year, value_parser = year)]
    pub year: f32,
    /// Leaves out ambient occlusion, bloom and temporal anti-aliasing, for slow devices.
    #[arg(long)]
    pub plain: bool,
    #[command(flatten)]
    pub image: ImageOptions,
    #[command(flatten)]
    pub series: SeriesOptions,
}

/// Options of the wind and of everything random.
#[derive(Args, Clone, Debug)]
pub struct WindOptions {
    /// Mean wind speed 10 m above ground, m/s.
    #[arg(long, default_value_t = 10.0, value_parser = wind_speed)]
    pub wind: f32,
    /// Seed of everything random: the wind and what grows.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
}

/// Options of what is drawn to.
#[derive(Args, Clone, Debug)]
pub struct ImageOptions {
    /// Renders pictures instead of opening a window. This is the default where there is no display.
    #[arg(long)]
    pub headless: bool,
    /// Size of a picture or of the window, pixels.
    #[arg(long, value_name = "WIDTHxHEIGHT", default_value = "960x540", value_parser = size)]
    pub size: (u32, u32),
    /// Renders pictures at this multiple of their width and height and scales them down.
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=4))]
    pub supersample: u32,
}

/// Options of a series of pictures.
#[derive(Args, Clone, Debug)]
pub struct SeriesOptions {
    /// Number of pictures.
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    pub frames: u32,
    /// Time between two pictures, s.
    #[arg(long, default_value_t = 0.5, value_parser = seconds)]
    pub interval: f64,
    /// Time of the first picture, s.
    #[arg(long, default_value_t = 40.0, value_parser = seconds)]
    pub start: f64,
    /// Folder for the pictures.
    #[arg(long, default_value = "out")]
    pub out: PathBuf,
    /// Writes one picture, `strip.png`: all pictures side by side, and the difference of the first and the last.
    #[arg(long)]
    pub strip: bool,
}

/// Options of how far a forest reaches.
#[derive(Args, Clone, Debug)]
pub struct ForestDistanceOptions {
    /// Distance from the camera up to which trees are entities, m.
    #[arg(long, default_value_t = 200.0, value_parser = trees_to)]
    pub trees_to: f32,
    /// Distance up to which trees are drawn as impostors, m. Beyond it woods are a colour of the ground.
    #[arg(long, default_value_t = 6000.0, value_parser = far_to)]
    pub far_to: f32,
}

impl ImageOptions {
    /// Chooses pictures where no window can be opened, and says so.
    pub fn choose_pictures_without_display(&mut self, out: &Path) {
        if !self.headless && !has_display() {
            println!("There is no display: writing pictures to `{}` instead.", out.display());
            self.headless = true;
        }
    }

    /// Size at which a picture is rendered, pixels.
    pub fn render_size(&self) -> (u32, u32) {
        (self.size.0 * self.supersample, self.size.1 * self.supersample)
    }
}

impl ForestDistanceOptions {
    /// Settings of a forest: as quick as possible for pictures, without long frames in a window.
    pub fn settings(&self, headless: bool) -> ForestSettings {
        ForestSettings {
            trees_to_m: self.trees_to,
            far_to_m: self.far_to,
            cells_at_once: if headless { 64 } else { 4 },
            trees_per_frame: if headless { 100_000 } else { 64 },
            ..default()
        }
    }
}

/// Whether a window can be opened. As a rule only Linux has machines without a display.
fn has_display() -> bool {
    let is_set = |name| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    !cfg!(target_os = "linux") || is_set("DISPLAY") || is_set("WAYLAND_DISPLAY")
}

fn trees_to(text: &str) -> Result<f32, String> {
    in_range(text, 0.0, 2000.0, "m")
}

fn far_to(text: &str) -> Result<f32, String> {
    in_range(text, 0.0, 20_000.0, "m")
}
