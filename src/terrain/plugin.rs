//! Registers the drawing of the ground.

use super::{
    components::{GroundLook, Terrain, TerrainSettings},
    ecs::stream::{GroundTexture, TerrainChunk, TerrainChunks, begin_terrains, recolour_ground, stream_ground},
    material::GroundMaterial,
};
use crate::{
    plugin_checks::{has_renderer, require_renderer_before},
    removal::remove_made,
    schedule::{WindwoodSystems, configure_sets},
    timing::timed,
    viewpoint::give_cameras_viewpoints,
};
use bevy::{asset::embedded_asset, pbr::MaterialPlugin, prelude::*};

/// Draws [`Terrain`](super::Terrain). Without a renderer it does nothing.
pub struct TerrainDrawPlugin;

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
            .init_resource::<GroundTexture>()
            .add_observer(remove_made::<Terrain, TerrainChunk, TerrainChunks>);
        let stream = timed!(app, begin_terrains, recolour_ground, stream_ground);
        app.add_systems(Update, stream.chain().in_set(WindwoodSystems::Stream));
    }

    fn finish(&self, app: &mut App) {
        require_renderer_before::<Self>(app, app.world().contains_resource::<GroundTexture>());
    }
}
