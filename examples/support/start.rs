//! The start and the end of every example.

use super::{capture, options::ImageOptions};
use bevy::prelude::*;
use bevy_windwood::prelude::*;
use std::process::ExitCode;

/// An app with Bevy's plugins and ours. It has a window unless pictures are asked for.
pub fn app(title: &str, image: &ImageOptions) -> App {
    let engine = if image.headless { capture::headless_engine(None) } else { capture::engine(title, image.size) };
    let mut app = App::new();
    app.add_plugins((engine, WindwoodPlugins));
    app
}

/// The exit code of the program. An error is printed.
pub fn exit_code(result: Result<(), String>) -> ExitCode {
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}
