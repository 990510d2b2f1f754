//! Devices that can do less than ours: trees are drawn all the same. Needs a Vulkan driver; Mesa's software one will do.

mod support;

use bevy::render::render_resource::WgpuLimits;
use bevy_windwood::{forest::FarBlocks, prelude::*, sway::DrawPath};
use support::{
    firs::{TREES, draw_firs},
    wood::Wood,
};

#[test]
fn trees_sway_where_bevy_does_not_cull_on_the_device() {
    // What WebGPU guarantees: eight storage buffers. Bevy's own culling on the device wants ten.
    let outcome = draw_firs(WgpuLimits::default());
    assert!(outcome.path.sways && !outcome.path.culls_on_gpu, "{:?}", outcome.path);
    assert_eq!((outcome.swaying, outcome.posed), ([TREES, TREES], TREES));
    assert!(outcome.covered > 0.15, "{} of the picture is trees", outcome.covered);
}

#[test]
fn trees_beyond_the_room_for_poses_stand_still() {
    // A quarter of a megabyte holds the poses of some 1,800 beams, which is a few firs, and no table of a wind.
    let limits = WgpuLimits { max_storage_buffer_binding_size: 1 << 18, ..WgpuLimits::default() };
    let outcome = draw_firs(limits);
    assert!(0 < outcome.posed && outcome.posed < TREES, "{:?}, {} are posed", outcome.path, outcome.posed);
    assert_eq!(outcome.swaying, [TREES, TREES]);
    assert!(outcome.covered > 0.15, "{} of the picture is trees", outcome.covered);
}

#[test]
fn a_forest_has_all_its_levels_where_bevy_does_not_cull_on_the_device() {
    let settings = ForestSettings { trees_to_m: 100.0, far_to_m: 400.0, ..ForestSettings::default() };
    let mut wood = Wood::new(settings, Some(WgpuLimits::default()));
    let covered = wood.covered();
    let world = wood.app.world_mut();
    assert!(!world.resource::<DrawPath>().culls_on_gpu);
    assert!(world.query::<&FarBlocks>().iter(world).any(|blocks| blocks.trees() > 100));
    assert!(covered > 0.1, "{covered} of the picture is trees");
}
