//! Command-line options of the workbench.

use crate::support::options::{ImageOptions, WindOptions};
use clap::Parser;
use std::path::PathBuf;

/// The workbench.
#[derive(Parser, Clone, Debug)]
#[command(
    about = "Edits species, woods, ground, wind and levels of detail. Writes a picture of each panel where there is no window.",
    mut_arg("size", |size| size.default_value("1280x720").help("Size of a picture, or of the window, pixels")),
    mut_arg("wind", |speed| speed.default_value("6")),
)]
pub struct Options {
    /// The species that is edited first.
    #[arg(long, default_value = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/species/oak.species.ron"))]
    pub file: PathBuf,
    /// The plan of a forest that is edited first.
    #[arg(long, default_value = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/forests/mixed.forest.ron"))]
    pub plan: PathBuf,
    /// The ground that is edited first: `.bands.ron` or `.ground.ron`. Hills by default.
    #[arg(long)]
    pub ground: Option<PathBuf>,
    #[command(flatten)]
    pub wind: WindOptions,
    #[command(flatten)]
    pub image: ImageOptions,
    /// Pictures to write, by name, separated by commas; all by default.
    #[arg(long, value_delimiter = ',')]
    pub pictures: Vec<String>,
    /// Goes through the guide's first steps as a person would, by mouse and keys: makes a species, a wood on a real map and a GLB file, and
    /// takes a picture of each step. All of it comes into the folder for pictures.
    #[arg(long)]
    pub tour: bool,
    /// Light colours in all pictures.
    #[arg(long)]
    pub light: bool,
    /// Folder for the pictures.
    #[arg(long, default_value = "out")]
    pub out: PathBuf,
}
