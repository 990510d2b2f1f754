//! What the gallery may be told on its command line.

use crate::arguments::{size, wind_speed};
use bevy::prelude::Resource;
use bevy_windwood::prelude::*;
use clap::{Parser, ValueEnum};
use std::path::{Path, PathBuf};

/// A gallery of trees.
#[derive(Parser, Resource, Clone, Debug)]
#[command(
    about = "Every species in a lit studio, by season and by age. Writes contact sheets where there is no window."
)]
pub struct Options {
    /// Species to show, as their files are called, separated by commas; all of them by default.
    #[arg(long, value_delimiter = ',')]
    pub species: Vec<String>,
    /// What the columns of the sheet are.
    #[arg(long, value_enum, default_value_t = Columns::Seasons)]
    pub columns: Columns,
    /// Writes a contact sheet instead of opening a window; the default where there is no display.
    #[arg(long)]
    pub headless: bool,
    /// Size of a picture of the sheet, or of the window.
    #[arg(long, default_value = "320x320", value_parser = size)]
    pub size: (u32, u32),
    /// Renders pictures so many times as wide and high and scales them down.
    #[arg(long, default_value_t = 2, value_parser = clap::value_parser!(u32).range(1..=4))]
    pub supersample: u32,
    /// Mean wind speed at 10 m above ground, m/s: 0 to 75.
    #[arg(long, default_value_t = 6.0, value_parser = wind_speed)]
    pub wind: f32,
    /// Chooses the individual.
    #[arg(long, default_value_t = 0)]
    pub seed: u64,
    /// The sheet.
    #[arg(long, default_value = "out/gallery.png")]
    pub out: PathBuf,
}

/// What changes from column to column.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Columns {
    /// Winter, spring, summer, autumn.
    Seasons,
    /// From sapling to old.
    Ages,
    /// Whole, crown, trunk.
    Close,
    /// One summer picture each, species side by side.
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
