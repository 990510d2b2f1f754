//! What an app says whose plugins are missing, doubled or in the wrong order.

use bevy::prelude::*;
use bevy_windwood::{WindwoodMinimalPlugins, WindwoodPlugins, wind::WindPlugin};

/// All that a server needs of Bevy.
fn server() -> App {
    let mut app = App::new();
    app.add_plugins((MinimalPlugins, TransformPlugin, AssetPlugin::default()));
    app
}

#[test]
fn right_order_is_accepted() {
    let mut app = server();
    app.add_plugins(WindwoodPlugins);
    app.finish();
    app.cleanup();
    app.update();
}

#[test]
#[should_panic(
    expected = "`TreePlugin` needs Bevy's `AssetPlugin`, which is missing or added later. Plugins go in this order: \
                           `app.add_plugins((DefaultPlugins, WindwoodPlugins))`"
)]
fn groups_before_default_plugins_are_refused() {
    App::new().add_plugins((WindwoodPlugins, MinimalPlugins, AssetPlugin::default()));
}

#[test]
#[should_panic(expected = "`TreePlugin` needs Bevy's `AssetPlugin`, which is missing or added later")]
fn an_app_without_assets_is_refused() {
    App::new().add_plugins((MinimalPlugins, TransformPlugin, WindwoodMinimalPlugins));
}

#[test]
#[should_panic(
    expected = "`WindPlugin` is added twice. Add one of the groups `WindwoodPlugins` and `WindwoodMinimalPlugins`, once"
)]
fn a_group_twice_is_refused() {
    server().add_plugins(WindwoodPlugins).add_plugins(WindwoodPlugins);
}

#[test]
#[should_panic(
    expected = "`WindPlugin` is added twice. Add one of the groups `WindwoodPlugins` and `WindwoodMinimalPlugins`, once"
)]
fn both_groups_are_refused() {
    server().add_plugins((WindwoodMinimalPlugins, WindwoodPlugins));
}

#[test]
#[should_panic(expected = "`WindPlugin` needs Bevy's `TimePlugin`, which is missing")]
fn an_app_without_time_is_refused() {
    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), WindPlugin));
    app.finish();
}

#[test]
fn the_wind_may_be_added_before_the_plugins_of_bevy() {
    let mut app = App::new();
    app.add_plugins((WindPlugin, MinimalPlugins));
    app.finish();
    app.cleanup();
    app.update();
}

#[cfg(feature = "render")]
mod before_the_renderer {
    use super::*;
    use bevy_windwood::{
        fire::FireDrawPlugin, forest::ForestRenderPlugin, grass::GrassDrawPlugin, render::TreeRenderPlugin,
        terrain::TerrainDrawPlugin,
    };

    /// Adds a plugin that draws, and a renderer after it.
    fn add(plugin: impl Plugin) {
        let mut app = server();
        app.add_plugins((WindwoodMinimalPlugins, plugin));
        app.insert_sub_app(bevy::render::RenderApp, SubApp::new());
        app.finish();
    }

    #[test]
    #[should_panic(expected = "`TreeRenderPlugin` was added before Bevy's `RenderPlugin` and would draw nothing")]
    fn trees_are_refused() {
        add(TreeRenderPlugin);
    }

    #[test]
    #[should_panic(expected = "`GrassDrawPlugin` was added before Bevy's `RenderPlugin` and would draw nothing")]
    fn grass_is_refused() {
        add(GrassDrawPlugin);
    }

    #[test]
    #[should_panic(expected = "`FireDrawPlugin` was added before Bevy's `RenderPlugin` and would draw nothing")]
    fn fire_is_refused() {
        add(FireDrawPlugin);
    }

    #[test]
    #[should_panic(expected = "`TerrainDrawPlugin` was added before Bevy's `RenderPlugin` and would draw nothing")]
    fn ground_is_refused() {
        add(TerrainDrawPlugin);
    }

    #[test]
    #[should_panic(expected = "`ForestRenderPlugin` was added before Bevy's `RenderPlugin` and would draw nothing")]
    fn forests_are_refused() {
        add(ForestRenderPlugin);
    }
}
