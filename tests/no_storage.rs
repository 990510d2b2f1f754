//! A device without storage buffers: trees stand still. A program of its own, because Bevy finds out once a process
//! whether skins need them. Needs a Vulkan driver; Mesa's software one will do.

mod support;

use bevy::render::render_resource::WgpuLimits;
use bevy_windwood::{forest::FarBlocks, prelude::*};
use support::{firs::draw_firs, wood::Wood};

#[test]
fn trees_stand_still_without_storage_buffers() {
    // What WebGL 2 guarantees: none, and no compute shaders either.
    let outcome = draw_firs(WgpuLimits::downlevel_webgl2_defaults());
    assert!(!outcome.path.sways, "{:?}", outcome.path);
    assert_eq!(outcome.swaying, [0, 0]);
    assert!(outcome.covered > 0.15, "{} of the picture is trees", outcome.covered);
}

#[test]
fn a_forest_stands_still_and_has_no_cards_without_storage_buffers() {
    let settings = ForestSettings { trees_to_m: 150.0, far_to_m: 400.0, ..ForestSettings::default() };
    let mut wood = Wood::new(settings, Some(WgpuLimits::downlevel_webgl2_defaults()));
    let covered = wood.covered();
    let world = wood.app.world_mut();
    assert_eq!(world.query::<&FarBlocks>().iter(world).count(), 0);
    assert!(covered > 0.1, "{covered} of the picture is trees");
}
