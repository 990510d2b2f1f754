//! Command-line options of the gallery.

use crate::support::options::{ImageOptions, WindOptions};
use bevy::prelude::Resource;
use bevy_windwood::prelude::*;
use clap::{Parser, ValueEnum};
use std::path::{Path, PathBuf};

/// A gallery of trees.
#[derive(Parser, Resource, Clone, Debug)]
#[command(
    about = "Every species in neutral light, by season and by age. Writes a contact sheet where there is no window.",
    mut_arg("size", |size| size.default_value("320x320").help("Size of one picture of the sheet, or of the window, pixels")),
    mut_arg("supersample", |factor| factor.default_value("2")),
    mut_arg("wind", |speed| speed.default_value("6")),
    mut_arg("seed", |seed| seed.default_value("0").help("Seed of the trees")),
)]
pub struct Options {
    /// Species to show, as their files are called, separated by commas. All by default.
    #[arg(long, value_delimiter = ',')]
    pub species: Vec<String>,
    /// What the columns of the sheet are.
    #[arg(long, value_enum, default_value_t = Columns::Seasons)]
    pub columns: Columns,
    #[command(flatten)]
    pub wind: WindOptions,
    #[command(flatten)]
    pub image: ImageOptions,
    /// File for the sheet.
    #[arg(long, default_value = "out/gallery.png")]
    pub out: PathBuf,
}

/// What changes from column to column.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Columns {
    /// Winter, spring, summer, autumn.
    Seasons,
    /// From sapling to old tree.
    Ages,
    /// Whole, crown, trunk.
    Close,
    /// No columns: one summer picture of each species, side by side.
    Summer,
}

impl Options {
    /// Finds the files of all species if none were named, and checks those that were.
    pub fn find_species(&mut self) -> Result<(), String> {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/species");
        if self.species.is_empty() {
            let files = std::fs::read_dir(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
            let names = files.filter_map(|file| file.ok()?.file_name().into_string().ok());
            self.species = names.filter_map(|name| name.strip_suffix(".species.ron").map(str::to_owned)).collect();
            self.species.sort();
        }
        for name in &self.species {
            let path = folder.join(format!("{name}.species.ron"));
            let text = std::fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
            Species::from_ron(&text).map_err(|error| format!("{}: {error}", path.display()))?;
        }
        Ok(())
    }
}
