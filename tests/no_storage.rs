//! Without storage buffers trees stand still. It is a test program of its own because Bevy decides once per process whether
//! skinning uses them. Needs a Vulkan driver. Mesa's software one will do.

mod support;

use bevy::render::render_resource::WgpuLimits;
use bevy_windwood::{forest::ForestImpostors, prelude::*};
use support::{firs::draw_firs, forest::TestForest};

#[test]
fn trees_stand_still_without_storage_buffers() {
    // The limits that WebGL 2 guarantees: no storage buffers and no compute shaders.
    let outcome = draw_firs(WgpuLimits::downlevel_webgl2_defaults());
    assert!(!outcome.path.sways, "{:?}", outcome.path);
    assert_eq!(outcome.swaying, [0, 0]);
    assert!(outcome.covered > 0.15, "{} of the picture is trees", outcome.covered);
}

#[test]
fn forest_has_trees_but_no_impostors_without_storage_buffers() {
    let settings = ForestSettings { trees_to_m: 150.0, far_to_m: 400.0, ..ForestSettings::default() };
    let mut forest = TestForest::new(settings, Some(WgpuLimits::downlevel_webgl2_defaults()));
    let covered = forest.covered();
    let world = forest.app.world_mut();
    assert_eq!(world.query::<&ForestImpostors>().iter(world).count(), 0);
    assert!(covered > 0.1, "{covered} of the picture is trees");
}
