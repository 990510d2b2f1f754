//! Registers the ground: maps as assets, and what draws it.

use super::{
    ecs::{elevation_loader::ElevationLoader, terrain_file::raise_terrains_from_files},
    elevation_map::ElevationMap,
};
use crate::{
    plugin_checks::require_assets,
    schedule::{WindwoodSystems, configure_sets},
    timing::timed,
};
use bevy::prelude::*;
#[cfg(feature = "render")]
use {
    super::{
        components::{GroundLook, Terrain, TerrainSettings},
        ecs::stream::{TerrainChunk, TerrainChunks, begin_terrains, recolour_ground, restore_ground, stream_ground},
        material::{GroundMaterial, GroundTextures},
    },
    crate::{
        plugin_checks::{has_renderer, require_renderer_before},
        removal::remove_made,
        render::new_device::device_is_new,
        viewpoint::give_cameras_viewpoints,
    },
    bevy::{asset::embedded_asset, pbr::MaterialPlugin},
};

/// Loads [`ElevationMap`]s, and gives entities with a [`TerrainFile`](super::TerrainFile) their [`Terrain`](super::Terrain). It draws nothing.
pub struct TerrainPlugin;

impl Plugin for TerrainPlugin {
    fn build(&self, app: &mut App) {
        require_assets::<Self>(app);
        configure_sets(app);
        app.init_asset::<ElevationMap>().init_asset_loader::<ElevationLoader>();
        let raise = timed!(app, raise_terrains_from_files);
        app.add_systems(Update, raise.in_set(WindwoodSystems::Stream));
    }
}

/// Draws [`Terrain`](super::Terrain). Without a renderer it does nothing.
#[cfg(feature = "render")]
pub struct TerrainDrawPlugin;

#[cfg(feature = "render")]
impl Plugin for TerrainDrawPlugin {
    fn build(&self, app: &mut App) {
        if !has_renderer(app) {
            return;
        }
        embedded_asset!(app, "shaders/ground.wesl");
        embedded_asset!(app, "shaders/ground_colour.wesl");
        configure_sets(app);
        give_cameras_viewpoints(app);
        app.add_plugins(MaterialPlugin::<GroundMaterial>::default())
            .register_type::<TerrainSettings>()
            .register_type::<GroundLook>()
            .init_resource::<GroundTextures>()
            .add_observer(remove_made::<Terrain, TerrainChunk, TerrainChunks>);
        let stream = timed!(app, begin_terrains, recolour_ground, stream_ground);
        app.add_systems(Update, stream.chain().in_set(WindwoodSystems::Stream)).add_systems(
            Update,
            restore_ground.before(begin_terrains).in_set(WindwoodSystems::Stream).run_if(device_is_new),
        );
    }

    fn finish(&self, app: &mut App) {
        require_renderer_before::<Self>(app, app.world().contains_resource::<GroundTextures>());
    }
}
