//! Command-line options.

use crate::arguments::{in_range, wind_speed, year};
use bevy::math::Vec2;
use bevy_windwood::export::{ExportLevels, ExportSettings, Instancing, LeafSides, MotionSettings};
use clap::{Args, Parser, ValueEnum};
use std::path::{Path, PathBuf};

/// Trees and stands as files for other programs.
#[derive(Parser, Clone, Debug)]
#[command(
    about = "Writes a tree, or the stand of a forest plan, as GLB, OBJ, polygons or an atlas of impostors. Needs no display."
)]
pub struct Options {
    /// A species: the name of a shipped one, or a file.
    #[arg(long, default_value = "oak", conflicts_with = "plan")]
    pub species: String,
    /// A forest plan: the name of a shipped one, or a file. Its stand is written as one GLB.
    #[arg(long)]
    pub plan: Option<String>,
    /// Age, years. The species' mature age by default.
    #[arg(long, value_parser = age)]
    pub age: Option<f32>,
    /// Seed of the tree and of the wind.
    #[arg(long, default_value_t = 0)]
    pub seed: u64,
    /// Time of the year: 0 midwinter, 0.34 spring, 0.55 summer, 0.81 autumn.
    #[arg(long, default_value_t = 0.55, value_parser = year)]
    pub year: f32,
    /// Level of detail: 0 is the full tree, 1 and 2 are thinned.
    #[arg(long, default_value_t = 0, value_parser = clap::value_parser!(u32).range(0..=2))]
    pub level: u32,
    /// All levels in one GLB.
    #[arg(long, value_enum)]
    pub lods: Option<Lods>,
    /// How leaves are seen from behind.
    #[arg(long, value_enum, default_value_t = Sides::Twice)]
    pub leaf_sides: Sides,
    #[command(flatten)]
    pub sway: SwayOptions,
    /// What to write.
    #[arg(long, value_enum, value_delimiter = ',', default_value = "glb")]
    pub formats: Vec<Format>,
    #[command(flatten)]
    pub stand: StandOptions,
    /// What the files are called; the name of the species or the plan by default.
    #[arg(long)]
    pub name: Option<String>,
    /// Folder for the files.
    #[arg(long, default_value = "out")]
    pub out: PathBuf,
}

/// Options of the sway.
#[derive(Args, Clone, Debug)]
pub struct SwayOptions {
    /// Mean wind speed 10 m above ground, m/s. With one, a GLB has a skeleton and a loop of its sway.
    #[arg(long, value_parser = wind_speed)]
    pub wind: Option<f32>,
    /// Length of the loop, s; from the wind's period on, 128 s, it needs no fade.
    #[arg(long = "loop", value_name = "SECONDS", default_value_t = 16.0, value_parser = loop_s)]
    pub loop_s: f32,
    /// Keys a second.
    #[arg(long, default_value_t = 30.0, value_parser = rate_hz)]
    pub rate: f32,
    /// Joints of the skeleton, at most.
    #[arg(long, default_value_t = 64, value_parser = clap::value_parser!(u32).range(2..=255))]
    pub joints: u32,
}

/// Options of a stand.
#[derive(Args, Clone, Debug)]
pub struct StandOptions {
    /// Half the side of the square of the plan that is written, m.
    #[arg(long, default_value_t = 60.0, value_parser = reach_m)]
    pub reach: f32,
    /// Middle of that square (x, z), m; it is the origin of the file.
    #[arg(long, value_name = "X,Z", default_value = "0,0", value_parser = place, allow_hyphen_values = true)]
    pub middle: Vec2,
    /// A map of elevations with its middle at the origin, on which the plan grows. Level ground by default.
    #[arg(long)]
    pub ground: Option<PathBuf>,
    /// Size of its cells, m, where the file does not say it: along x, and along z.
    #[arg(long, value_name = "X,Z", value_parser = place)]
    pub cells: Option<Vec2>,
    /// Different trees of each species.
    #[arg(long, default_value_t = 2, value_parser = clap::value_parser!(u32).range(1..=16))]
    pub variants: u32,
    /// How places are written.
    #[arg(long, value_enum, default_value_t = Places::Gpu)]
    pub places: Places,
}

/// How all levels are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Lods {
    /// Behind the full tree, with `MSFT_lod`.
    Msft,
    /// As nodes of the scene.
    Nodes,
}

/// What is written of a tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Format {
    Glb,
    /// OBJ, MTL and PNG.
    Obj,
    /// The polygons of an impressionist crown, as OBJ.
    Polygons,
    /// An atlas of impostors, PNG and JSON.
    Impostor,
}

/// How leaves are seen from behind.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Sides {
    /// As triangles of their own.
    Twice,
    /// By a double-sided material.
    DoubleSided,
}

/// How the places of a stand are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Places {
    /// With `EXT_mesh_gpu_instancing`.
    Gpu,
    /// A node for each tree.
    Nodes,
}

impl Options {
    /// What files are called, without ending.
    pub fn file_name(&self) -> String {
        let source = self.plan.as_ref().unwrap_or(&self.species);
        let file = Path::new(source).file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        let own = || file.split('.').next().unwrap_or_default().to_owned();
        self.name.clone().unwrap_or_else(own)
    }

    pub fn settings(&self) -> ExportSettings {
        let SwayOptions { loop_s, rate, joints, .. } = self.sway;
        let levels = match self.lods {
            None => ExportLevels::One(self.level),
            Some(Lods::Msft) => ExportLevels::Lod,
            Some(Lods::Nodes) => ExportLevels::Nodes,
        };
        let fade_s = MotionSettings::default().fade_s.min(0.25 * loop_s);
        let motion = MotionSettings { joints, loop_s, fade_s, rate_hz: rate, ..MotionSettings::default() };
        let leaf_sides = match self.leaf_sides {
            Sides::Twice => LeafSides::Twice,
            Sides::DoubleSided => LeafSides::DoubleSided,
        };
        ExportSettings { year: self.year, levels, leaf_sides, motion, ..ExportSettings::default() }
    }
}

impl From<Places> for Instancing {
    fn from(places: Places) -> Self {
        match places {
            Places::Gpu => Self::Gpu,
            Places::Nodes => Self::Nodes,
        }
    }
}

fn age(text: &str) -> Result<f32, String> {
    in_range(text, 1.0, 2000.0, "years")
}

fn loop_s(text: &str) -> Result<f32, String> {
    in_range(text, 1.0, 3600.0, "s")
}

fn rate_hz(text: &str) -> Result<f32, String> {
    in_range(text, 2.0, 120.0, "a second")
}

/// A pair of numbers, such as `120,-40`.
fn place(text: &str) -> Result<Vec2, String> {
    let number = |text: &str| in_range::<f32>(text.trim(), -1e6, 1e6, "m");
    let (x, z) = text.split_once(',').ok_or("expected X,Z")?;
    Ok(Vec2::new(number(x)?, number(z)?))
}

fn reach_m(text: &str) -> Result<f32, String> {
    in_range(text, 1.0, 2000.0, "m")
}
