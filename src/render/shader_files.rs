//! The shaders of trees, and the modules that shaders of other rooms import.

use bevy::{asset::embedded_asset, prelude::*, shader::load_shader_library};

/// Makes the shaders of this room known to the app.
pub(crate) fn load_shaders(app: &mut App) {
    load_shader_library!(app, "shaders/beam.wesl");
    load_shader_library!(app, "shaders/beam_sway.wesl");
    load_shader_library!(app, "shaders/cross_fade.wesl");
    load_shader_library!(app, "shaders/frame.wesl");
    load_shader_library!(app, "shaders/impostor.wesl");
    load_shader_library!(app, "shaders/impostor_output.wesl");
    load_shader_library!(app, "shaders/instances.wesl");
    load_shader_library!(app, "shaders/green_wood.wesl");
    load_shader_library!(app, "shaders/leaf.wesl");
    load_shader_library!(app, "shaders/leaf_shade.wesl");
    load_shader_library!(app, "shaders/lighting.wesl");
    load_shader_library!(app, "shaders/lod.wesl");
    load_shader_library!(app, "shaders/packed_vertex.wesl");
    load_shader_library!(app, "shaders/prepass_output.wesl");
    load_shader_library!(app, "shaders/rotation.wesl");
    load_shader_library!(app, "shaders/season.wesl");
    load_shader_library!(app, "shaders/surface.wesl");
    load_shader_library!(app, "shaders/tree_transform.wesl");
    load_shader_library!(app, "shaders/under_trees.wesl");
    load_shader_library!(app, "shaders/vertex_output.wesl");
    load_shader_library!(app, "shaders/view_direction.wesl");
    load_shader_library!(app, "shaders/sky_share.wesl");
    load_shader_library!(app, "shaders/stand_wind.wesl");
    load_shader_library!(app, "shaders/wind.wesl");
    load_shader_library!(app, "shaders/wind_sources.wesl");
    embedded_asset!(app, "shaders/impostor_fragment.wesl");
    embedded_asset!(app, "shaders/impostor_prepass.wesl");
    embedded_asset!(app, "shaders/impostor_vertex.wesl");
    embedded_asset!(app, "shaders/pose_pass.wesl");
    embedded_asset!(app, "shaders/tree_fragment.wesl");
    embedded_asset!(app, "shaders/tree_prepass.wesl");
    embedded_asset!(app, "shaders/tree_vertex.wesl");
}
