//! Registers the drawing of the ground.

use super::{
    components::{GroundLook, TerrainSettings},
    ecs::stream::{GroundTexture, begin_terrains, recolour_ground, remove_terrain, stream_ground},
    material::GroundMaterial,
};
use crate::{
    schedule::{WindwoodSystems, configure_sets},
    timing::timed,
    viewpoint::give_cameras_viewpoints,
};
use bevy::{asset::embedded_asset, pbr::MaterialPlugin, prelude::*, render::RenderApp};

/// Draws [`Terrain`](super::Terrain). Without a renderer it does nothing.
pub struct TerrainDrawPlugin;

impl Plugin for TerrainDrawPlugin {
    fn build(&self, app: &mut App) {
        if app.get_sub_app(RenderApp).is_none() {
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
            .add_observer(remove_terrain);
        let stream = timed!(app, begin_terrains, recolour_ground, stream_ground);
        app.add_systems(Update, stream.chain().in_set(WindwoodSystems::Stream));
    }
}
