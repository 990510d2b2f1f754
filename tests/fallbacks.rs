//! Trees are drawn on devices with smaller limits. Needs a Vulkan driver. Mesa's software one will do.

mod support;

use bevy::render::render_resource::WgpuLimits;
use bevy_windwood::{forest::ForestImpostors, prelude::*, render::RenderCapabilities};
use support::{
    firs::{TREES, draw_firs},
    forest::TestForest,
};

#[test]
fn trees_sway_without_gpu_culling() {
    // What WebGPU guarantees: eight storage buffers. Bevy's own culling on the device wants ten.
    let outcome = draw_firs(WgpuLimits::default());
    assert!(outcome.path.sways && !outcome.path.culls_on_gpu, "{:?}", outcome.path);
    assert_eq!((outcome.swaying, outcome.posed), ([TREES, TREES], TREES));
    assert!(outcome.covered > 0.15, "{} of the picture is trees", outcome.covered);
}

#[test]
fn trees_beyond_the_pose_buffer_stand_still() {
    // A third of a megabyte holds the beams of every variant of the fir, the poses of a few firs, and no table of a wind.
    let limits = WgpuLimits { max_storage_buffer_binding_size: 5 << 16, ..WgpuLimits::default() };
    let outcome = draw_firs(limits);
    assert!(0 < outcome.posed && outcome.posed < TREES, "{:?}, {} are posed", outcome.path, outcome.posed);
    assert_eq!(outcome.swaying, [TREES, TREES]);
    assert!(outcome.covered > 0.15, "{} of the picture is trees", outcome.covered);
}

#[test]
fn forest_has_all_levels_without_gpu_culling() {
    let settings = ForestSettings { trees_to_m: 100.0, far_to_m: 400.0, ..ForestSettings::default() };
    let mut forest = TestForest::new(settings, Some(WgpuLimits::default()));
    let covered = forest.covered();
    let world = forest.app.world_mut();
    assert!(!world.resource::<RenderCapabilities>().culls_on_gpu);
    assert!(world.query::<&ForestImpostors>().iter(world).any(|blocks| blocks.trees() > 100));
    assert!(covered > 0.1, "{covered} of the picture is trees");
}
