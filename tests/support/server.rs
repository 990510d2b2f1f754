//! Apps without a renderer, as a server has them.

use bevy::{prelude::*, time::TimeUpdateStrategy};
use bevy_windwood::prelude::*;
use std::{
    path::{Path, PathBuf},
    time::Duration,
};

/// The folder of the shipped assets.
pub fn shipped_assets() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("assets")
}

/// An app with Bevy's minimal plugins and ours, whose assets are those of a folder and whose frames last so long.
pub fn server_app(assets: &Path, frame: Duration) -> App {
    let mut app = App::new();
    app.add_plugins((
        MinimalPlugins,
        TransformPlugin,
        AssetPlugin { file_path: assets.display().to_string(), ..default() },
        WindwoodMinimalPlugins,
    ));
    app.insert_resource(TimeUpdateStrategy::ManualDuration(frame));
    app.finish();
    app.cleanup();
    app
}
