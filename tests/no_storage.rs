//! A device without storage buffers: trees stand still. A program of its own, because Bevy finds out once a process
//! whether skins need them. Needs a Vulkan driver; Mesa's software one will do.

mod support;

use bevy::render::render_resource::WgpuLimits;
use support::firs::draw_firs;

#[test]
fn trees_stand_still_without_storage_buffers() {
    // What WebGL 2 guarantees: none, and no compute shaders either.
    let outcome = draw_firs(WgpuLimits::downlevel_webgl2_defaults());
    assert!(!outcome.path.sways, "{:?}", outcome.path);
    assert_eq!(outcome.swaying, [0, 0]);
    assert!(outcome.covered > 0.15, "{} of the picture is trees", outcome.covered);
}
