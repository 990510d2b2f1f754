//! Registers the drawing of far trees.

use super::{
    blocks::stream_far,
    looks::{FarLooks, bake_far_looks},
    material::FarMaterial,
    near::{NearCells, tell_near_cells},
};
use crate::{
    forest::cells::plant_cells,
    schedule::WindwoodSystems,
    sway::{DrawPath, StandTables},
};
use bevy::{asset::embedded_asset, pbr::MaterialPlugin, prelude::*, render::RenderApp, shader::load_shader_library};

/// Draws the trees of [`Forest`](crate::forest::Forest)s that are too far to be entities. Needs
/// [`SwayDrawPlugin`](crate::sway::SwayDrawPlugin). Without a renderer it does nothing.
pub struct ForestDrawPlugin;

impl Plugin for ForestDrawPlugin {
    fn build(&self, app: &mut App) {
        if app.get_sub_app(RenderApp).is_none() {
            return;
        }
        load_shader_library!(app, "shaders/far.wgsl");
        embedded_asset!(app, "shaders/far_card.wgsl");
        embedded_asset!(app, "shaders/far_colour.wgsl");
        embedded_asset!(app, "shaders/far_mask.wgsl");
        let can_draw = resource_exists::<DrawPath>.and_then(resource_exists::<StandTables>);
        app.add_plugins(MaterialPlugin::<FarMaterial>::default())
            .init_resource::<NearCells>()
            .init_resource::<FarLooks>()
            .add_systems(Update, (bake_far_looks, stream_far).chain().after(plant_cells).run_if(can_draw))
            .add_systems(PostUpdate, tell_near_cells.before(WindwoodSystems::Upload));
    }
}
