//! Measures the numbers that the project promises, on this machine.
//!
//! `cargo run --example validate -- <topic> [--json FILE]` prints a table of numbers beside their limits, writes the
//! numbers as flat JSON, and exits with 1 where a limit is missed.

mod basis;
mod beams;
mod canopy;
#[path = "../../src/dynamics/oracle/cantilever.rs"]
#[expect(dead_code, reason = "a part of it is for the unit tests")]
mod cantilever;
mod change;
#[path = "../support/chart.rs"]
mod chart;
mod cost;
mod cpu_clock;
mod crown_figures;
#[cfg(feature = "editor")]
mod editor;
mod extremes;
mod figure9;
mod figure9_chart;
mod frame;
mod grid;
mod leaves;
mod levels;
mod live;
mod memory;
#[path = "../../src/dynamics/oracle/oscillator.rs"]
#[expect(dead_code, reason = "a part of it is for the unit tests")]
mod oscillator;
mod parity;
mod points;
mod report;
mod scale;
mod skeleton;
mod spectrum;
#[path = "../../tests/support/mod.rs"]
mod support;
mod sway;
mod terrain;
mod test_wind;
mod total_error;
mod trees;
mod trees_in_wind;
#[path = "../support/walk.rs"]
mod walk;

use bevy_windwood::tree::Season;
use clap::{Parser, ValueEnum};
use std::{path::PathBuf, process::ExitCode};

/// What can be measured.
#[derive(Clone, Copy, ValueEnum)]
enum Topic {
    /// The synthesised wind against its spectra, coherence, log law and period.
    Spectrum,
    /// The load bases against direct integration of each beam.
    Basis,
    /// The cantilever and the periodic steady state against closed forms and the Duhamel integral.
    Beams,
    /// Whole trees against finite elements: how they bend, how fast they sway.
    Skeleton,
    /// The sway of trunks against direct integration in a wind that every part of the crown feels. Takes some minutes.
    Sway,
    /// The wind in stands of trees beside what others have measured.
    Canopy,
    /// Trees of any size and stiffness in any wind, anywhere and after any time: finite, as long as they were, not bent past the wind.
    Extremes,
    /// Vertices posed on the GPU against the same on the CPU.
    Parity,
    /// Trees that a game touches: against the table, and what they cost.
    Live,
    /// How far a small change of wind or branch turns a leaf, and leaves on the GPU against the same on the CPU.
    Leaves,
    /// Random ground against its covariance models, and the round trip from ground to fitted model.
    Terrain,
    /// Point patterns against their laws, and the laws of real patterns.
    Points,
    /// Time of a frame in forests of ten thousand to a million trees.
    Scale,
    /// A forest of a million trees that a game changes: time and size of a change, equal forests after a walk and loading.
    Change,
    /// Trees against the tables of the papers, their own settings, and real trees.
    Trees,
    /// Figure 9 of Setas et al.: frame rate over number of trees, with and without voxel grid and levels of detail. Takes ten
    /// minutes on software Vulkan.
    Figure9,
    /// Time of a frame on a real GPU: up to a hundred thousand trees in full HD.
    Grid,
    /// What a frame costs, pass by pass: vertices, fragments, time. A hundred thousand trees take `--trees 100000`.
    Cost,
    /// The workbench: what it adds to a frame, closed and open, and how long a changed tree takes; with the feature `export`, an export.
    #[cfg(feature = "editor")]
    Editor,
    /// Every level of detail against the full tree, and how visible its changes are. Takes some minutes.
    Levels,
}

#[derive(Parser)]
#[command(about = "Measures the numbers that bevy_windwood promises, on this machine")]
struct Options {
    /// What to measure.
    topic: Topic,
    /// File for the numbers as flat JSON.
    #[arg(long)]
    json: Option<PathBuf>,
    /// `figure9`: places along the path for each curve and number of trees. `grid`: frames of each forest.
    #[arg(long, default_value_t = 36, value_parser = clap::value_parser!(u32).range(2..=10_800))]
    frames: u32,
    /// `figure9` and `grid`: greatest number of trees.
    #[arg(long, default_value_t = 10_000)]
    trees: u32,
    /// `levels`: only this species.
    #[arg(long)]
    species: Option<String>,
    /// `levels`: time of the year: 0 midwinter, 0.34 spring, 0.55 summer, 0.81 autumn.
    #[arg(long, default_value_t = Season::SUMMER.year)]
    year: f32,
    /// `cost`: from how many of their heights on trees cast the shadows of their impostors, in place of the default.
    #[arg(long)]
    shadow_impostors_from_heights: Option<f32>,
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
        Topic::Skeleton => skeleton::run(),
        Topic::Sway => sway::run(),
        Topic::Canopy => canopy::run(),
        Topic::Extremes => extremes::run(),
        Topic::Parity => parity::run(),
        Topic::Live => live::run(),
        Topic::Leaves => leaves::run(),
        Topic::Terrain => terrain::run(),
        Topic::Points => points::run(),
        Topic::Scale => scale::run(),
        Topic::Change => change::run(),
        Topic::Trees => trees::run(),
        Topic::Figure9 => figure9::run(options.frames, options.trees, &options.out.join("figure9.png")),
        Topic::Grid => grid::run(options.frames, options.trees, &options.out),
        Topic::Cost => cost::run(options.trees, options.shadow_impostors_from_heights, &options.out),
        #[cfg(feature = "editor")]
        Topic::Editor => editor::run(),
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
