//! Checks of the order of plugins, with messages that say what to do.
//!
//! Without them a missing plugin of Bevy shows as a panic about one of our asset types or resources, and a plugin that is
//! added before the renderer draws nothing, silently.

use bevy::{asset::AssetServer, prelude::*, tasks::AsyncComputeTaskPool};

/// The way that is always right.
const RIGHT_ORDER: &str = "Plugins go in this order: `app.add_plugins((DefaultPlugins, WindwoodPlugins))`, or on a server \
    `app.add_plugins((MinimalPlugins, TransformPlugin, AssetPlugin::default(), WindwoodMinimalPlugins))`";

/// To be called in `build`, by a plugin whose `is_unique` is false: Bevy's own message does not name the groups.
///
/// # Panics
/// Where the plugin has been added before.
pub(crate) fn require_once<P: Plugin>(app: &App) {
    assert!(
        !app.is_plugin_added::<P>(),
        "bevy_windwood: `{}` is added twice. Add one of the groups `WindwoodPlugins` and `WindwoodMinimalPlugins`, once: the \
         first contains the second. {RIGHT_ORDER}",
        short_name::<P>()
    );
}

/// To be called in `build`, before assets are registered.
///
/// # Panics
/// Where there is no asset server yet.
pub(crate) fn require_assets<P: Plugin>(app: &App) {
    assert!(
        app.world().contains_resource::<AssetServer>(),
        "bevy_windwood: `{}` needs Bevy's `AssetPlugin`, which is missing or added later. {RIGHT_ORDER}",
        short_name::<P>()
    );
}

/// To be called in `build`, by a plugin that uses another one of this crate.
///
/// # Panics
/// Where the other has not been added yet.
pub(crate) fn require_plugin<P: Plugin, Needed: Plugin>(app: &App) {
    assert!(
        app.is_plugin_added::<Needed>(),
        "bevy_windwood: `{}` needs `{}`, which is missing or added later. {RIGHT_ORDER}",
        short_name::<P>(),
        short_name::<Needed>()
    );
}

/// To be called in `finish`: these may be added in any order.
///
/// # Panics
/// Where the app has no task pools or no time.
pub(crate) fn require_bevy_basics<P: Plugin>(app: &App) {
    let missing = [
        ("TaskPoolPlugin", AsyncComputeTaskPool::try_get().is_some()),
        ("TimePlugin", app.world().contains_resource::<Time>()),
    ];
    for (name, is_there) in missing {
        assert!(
            is_there,
            "bevy_windwood: `{}` needs Bevy's `{name}`, which is missing. {RIGHT_ORDER}",
            short_name::<P>()
        );
    }
}

/// Whether there is a renderer, so that a plugin that draws can set itself up. To be called in `build`; if the answer is
/// false and a renderer is there in the end, [`require_renderer_before`] finds it.
#[cfg(feature = "render")]
pub(crate) fn has_renderer(app: &App) -> bool {
    app.get_sub_app(bevy::render::RenderApp).is_some()
}

/// To be called in `finish`, by a plugin that draws, with what [`has_renderer`] said in `build` or a sign of it.
///
/// # Panics
/// Where there is a renderer now, but was none when the plugin was built.
#[cfg(feature = "render")]
pub(crate) fn require_renderer_before<P: Plugin>(app: &App, had_renderer: bool) {
    assert!(
        had_renderer || !has_renderer(app),
        "bevy_windwood: `{}` was added before Bevy's `RenderPlugin` and would draw nothing. {RIGHT_ORDER}",
        short_name::<P>()
    );
}

/// The name of a plugin without its path.
fn short_name<P: Plugin>() -> &'static str {
    std::any::type_name::<P>().rsplit("::").next().unwrap_or_default()
}
