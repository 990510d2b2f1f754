//! Characterises real data: the covariance of a map of elevations, or the law of counts of a pattern of plants.
//!
//! `cargo run --example characterise -- terrain FILE.tif` estimates the variogram of a map of elevations, ranks the covariance models by how
//! well they fit it, and draws the map beside ground made from the best. A PNG needs `--cell-size 30`.
//!
//! `cargo run --example characterise -- points FILE.csv --window 0,0,100,100` counts points in quadrats, ranks the laws
//! of such counts, and draws the pattern beside one made from the best. It says in words whether a law fits, and what is odd about the
//! places. The method does not know where the quadrats lie: clumps wider than a quadrat come out too small, unless `--quadrats` asks for
//! larger quadrats.

#[path = "../../examples/support/arguments.rs"]
mod arguments;
#[path = "../support/chart.rs"]
mod chart;
mod counts;
mod files;
mod histogram;
mod map_picture;
mod note;
mod options;
mod pattern_picture;
mod points;
mod polygon;
mod table;
mod terrain;
mod variogram_chart;
mod verdict;
mod window;
mod words;

use clap::{Parser, error::ErrorKind};
use options::{Options, Subject};
use std::process::ExitCode;

fn main() -> ExitCode {
    let outcome = match Options::try_parse() {
        Ok(options) => characterise(&options.subject),
        Err(help) if is_help(help.kind()) => help.exit(),
        Err(error) => Err(in_one_line(&error.to_string())),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

fn characterise(subject: &Subject) -> Result<(), String> {
    match subject {
        Subject::Terrain(options) => terrain::run(options),
        Subject::Points(options) => points::run(options),
    }
}

fn is_help(kind: ErrorKind) -> bool {
    use ErrorKind::{DisplayHelp, DisplayHelpOnMissingArgumentOrSubcommand, DisplayVersion};
    matches!(kind, DisplayHelp | DisplayHelpOnMissingArgumentOrSubcommand | DisplayVersion)
}

/// The message of clap in one line, without the advice after the blank line.
fn in_one_line(error: &str) -> String {
    let lines: Vec<&str> = error.lines().map(str::trim).take_while(|line| !line.is_empty()).collect();
    lines.join(" ")
}
