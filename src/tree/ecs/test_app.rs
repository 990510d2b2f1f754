//! An app for tests in which trees grow, and nothing else.

use crate::tree::TreePlugin;
use bevy::prelude::*;

pub(super) fn app() -> App {
    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), AssetPlugin::default(), TreePlugin));
    app
}

/// Runs frames until `is_so`, for ten seconds or more. Returns whether it was.
pub(super) fn wait(app: &mut App, mut is_so: impl FnMut(&mut World) -> bool) -> bool {
    (0..10_000).any(|_| {
        app.update();
        std::thread::sleep(std::time::Duration::from_millis(1));
        is_so(app.world_mut())
    })
}
