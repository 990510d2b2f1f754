//! Recomputes the project's claims on this machine.
//!
//! `cargo run --example validate -- <topic> [--json FILE]` prints a table of numbers beside their limits, writes the
//! numbers as flat JSON, and exits with 1 where a limit is missed.

mod basis;
mod beams;
mod figure9;
mod figure9_chart;
mod grid;
mod levels;
mod parity;
mod points;
mod report;
mod scale;
#[path = "../support/sheet.rs"]
mod sheet;
mod spectrum;
#[path = "../../tests/support/mod.rs"]
mod support;
mod terrain;
mod trees;
#[path = "../support/walk.rs"]
mod walk;

use bevy_windwood::tree::Season;
use clap::{Parser, ValueEnum};
use std::{path::PathBuf, process::ExitCode};
use support::capture;

/// A claim that can be checked.
#[derive(Clone, Copy, ValueEnum)]
enum Topic {
    /// The synthesised wind against its spectra, coherence, log law and period.
    Spectrum,
    /// The load bases against direct integration of each beam.
    Basis,
    /// The cantilever and the periodic steady state against closed forms and the Duhamel integral.
    Beams,
    /// The posed vertices of the graphics processor against the processor's.
    Parity,
    /// Random ground against its covariance models, and the round trip from ground to fit.
    Terrain,
    /// Point patterns against their laws, and the laws of real patterns.
    Points,
    /// What a frame costs in forests of ten thousand trees to a million.
    Scale,
    /// The trees against the papers' tables, their own settings, and real trees.
    Trees,
    /// The paper's experiment: frame rate over number of trees, with and without voxel grid and levels of detail. Takes some
    /// ten minutes on software Vulkan.
    Figure9,
    /// What a frame costs on a graphics processor: up to a hundred thousand trees in full HD.
    Grid,
    /// Every level of detail beside the full tree, and whether the eye can tell the change. Takes some minutes.
    Levels,
}

#[derive(Parser)]
#[command(about = "Recomputes the claims of bevy_windwood on this machine")]
struct Options {
    /// What to check.
    topic: Topic,
    /// Writes the numbers to this file as flat JSON.
    #[arg(long)]
    json: Option<PathBuf>,
    /// `figure9`: places along the path for each curve and number of trees; `grid`: frames of each wood.
    #[arg(long, default_value_t = 36, value_parser = clap::value_parser!(u32).range(2..=10_800))]
    frames: u32,
    /// `figure9`, `grid`: the greatest number of trees.
    #[arg(long, default_value_t = 10_000)]
    trees: u32,
    /// `levels`: this species alone.
    #[arg(long)]
    species: Option<String>,
    /// `levels`: the time of the year, 0 to 1: midwinter is 0.
    #[arg(long, default_value_t = Season::SUMMER.year)]
    year: f32,
    /// Folder for charts and pictures.
    #[arg(long, default_value = "out")]
    out: PathBuf,
}

fn main() -> ExitCode {
    let options = Options::parse();
    if let Err(error) = std::fs::create_dir_all(&options.out) {
        eprintln!("{}: {error}", options.out.display());
        return ExitCode::FAILURE;
    }
    let report = match options.topic {
        Topic::Spectrum => spectrum::run(),
        Topic::Basis => basis::run(),
        Topic::Beams => beams::run(),
        Topic::Parity => parity::run(),
        Topic::Terrain => terrain::run(),
        Topic::Points => points::run(),
        Topic::Scale => scale::run(),
        Topic::Trees => trees::run(),
        Topic::Figure9 => figure9::run(options.frames, options.trees, &options.out.join("figure9.png")),
        Topic::Grid => grid::run(options.frames, options.trees, &options.out),
        Topic::Levels => levels::run(&options.out.join("levels.png"), options.species.as_deref(), options.year),
    };
    report.print();
    if let Some(path) = options.json {
        let text = format!("{:#}\n", report.to_json());
        if let Err(error) = std::fs::write(&path, text) {
            eprintln!("cannot write {}: {error}", path.display());
            return ExitCode::FAILURE;
        }
    }
    if report.holds() { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
