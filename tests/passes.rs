//! The shaders of trees compile for every pass. Needs a Vulkan driver. Mesa's software one will do.

mod support;

use bevy::{
    camera::RenderTarget,
    core_pipeline::prepass::{DepthPrepass, MotionVectorPrepass, NormalPrepass},
    material::descriptor::PipelineDescriptor,
    prelude::*,
    render::{
        RenderApp,
        render_resource::{CachedPipelineState, PipelineCache, TextureFormat},
    },
};
use bevy_windwood::prelude::*;
use std::time::Duration;
use support::{headless_app, update_until};

#[test]
fn shaders_of_trees_compile_for_every_pass() {
    let mut app = headless_app(Duration::from_millis(16), None);
    app.finish();
    app.cleanup();

    let species = app.world().resource::<AssetServer>().load("species/fir.species.ron");
    let tree = app.world_mut().spawn((Tree::new(species), Transform::default())).id();
    let image = Image::new_target_texture(64, 64, TextureFormat::Rgba8UnormSrgb, None);
    let target = app.world_mut().resource_mut::<Assets<Image>>().add(image);
    app.world_mut().spawn((
        Camera3d::default(),
        Msaa::Off,
        RenderTarget::Image(target.into()),
        (DepthPrepass, NormalPrepass, MotionVectorPrepass),
        Transform::from_xyz(0.0, 9.0, 30.0).looking_at(Vec3::Y * 9.0, Vec3::Y),
    ));
    app.world_mut().spawn((
        DirectionalLight { shadow_maps_enabled: true, ..default() },
        Transform::from_xyz(1.0, 2.0, 1.0).looking_at(Vec3::ZERO, Vec3::Y),
    ));
    assert!(update_until(&mut app, |world| world.get::<TreeMeshes>(tree).is_some()), "the tree was not ready in time");
    (0..5).for_each(|_| app.update());

    let cache = app.sub_app(RenderApp).world().resource::<PipelineCache>();
    let broken: Vec<String> = cache
        .pipelines()
        .filter_map(|pipeline| match &pipeline.state {
            CachedPipelineState::Err(error) => Some(error.to_string()),
            // A shader with an import that does not exist stays queued without an error.
            CachedPipelineState::Queued => Some("a pipeline stays queued".into()),
            _ => None,
        })
        .collect();
    assert!(broken.is_empty(), "{}", broken.join("\n"));
    let ours = cache.pipelines().filter(|pipeline| match &pipeline.descriptor {
        PipelineDescriptor::RenderPipelineDescriptor(descriptor) => {
            descriptor.vertex.shader_defs.contains(&"WINDWOOD_LEAVES".into())
        }
        _ => false,
    });
    assert!(ours.count() >= 3, "leaves are drawn in the main pass, the prepass and the shadow pass");
}
