//! Without storage buffers grass stands still and fires burn upright. It is a test program of its own because Bevy decides once
//! per process whether skinning uses them. Needs a Vulkan driver. Mesa's software one will do.

mod support;

use bevy::{prelude::*, render::render_resource::WgpuLimits};
use bevy_windwood::render::RenderCapabilities;
use std::time::Duration;
use support::{
    headless_app,
    plants::{assert_meshes_compile, draw_meadow, pipelines_with},
};

#[test]
fn grass_and_fire_are_drawn_without_storage_buffers() {
    // The limits that WebGL 2 guarantees.
    let mut app = headless_app(Duration::from_millis(16), Some(WgpuLimits::downlevel_webgl2_defaults()));
    let [patch, _] = draw_meadow(&mut app, false);
    assert!(!app.world().resource::<RenderCapabilities>().sways);
    assert!(app.world().get::<MeshMaterial3d<StandardMaterial>>(patch).is_some());
    assert!(pipelines_with(&app, "WINDWOOD_FIRE").count() >= 1, "the fire is drawn");
    assert_eq!(pipelines_with(&app, "WINDWOOD_WIND").count() + pipelines_with(&app, "WINDWOOD_GRASS").count(), 0);
    assert_meshes_compile(&app);
}
