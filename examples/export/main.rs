//! Trees and stands as files for other programs, for build scripts too: no window, no graphics device, no app.
//!
//! `cargo run --example export --features export -- --help` lists the options.

#[path = "../support/arguments.rs"]
mod arguments;
mod options;
mod stand;
mod tree;

use clap::Parser;
use options::Options;
use std::{
    fmt::Display,
    path::{Path, PathBuf},
    process::ExitCode,
};

fn main() -> ExitCode {
    let options = Options::parse();
    let written = match &options.plan {
        Some(plan) => stand::export(&options, plan),
        None => tree::export(&options),
    };
    match written {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

/// The file of a shipped thing by its name, or the file that is named.
fn find(name: &str, folder: &str, ending: &str) -> PathBuf {
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder).join(format!("{name}{ending}"));
    if shipped.exists() { shipped } else { PathBuf::from(name) }
}

fn read<T, E: Display>(path: &Path, parse: impl Fn(&str) -> Result<T, E>) -> Result<T, String> {
    let told = |error: &dyn Display| format!("{}: {error}", path.display());
    let text = std::fs::read_to_string(path).map_err(|error| told(&error))?;
    parse(&text).map_err(|error| told(&error))
}
