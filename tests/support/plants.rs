//! A patch of grass and a fire in front of a camera.

use super::update_until;
use bevy::{
    camera::RenderTarget,
    core_pipeline::prepass::{DepthPrepass, MotionVectorPrepass, NormalPrepass},
    material::descriptor::PipelineDescriptor,
    prelude::*,
    render::{
        RenderApp,
        render_resource::{CachedPipeline, CachedPipelineState, PipelineCache, TextureFormat},
    },
};
use bevy_windwood::prelude::*;

/// Spawns a small patch of grass, a fire, a light and a camera, and updates until everything is drawn. With `passes` the camera has
/// all prepasses and lights have shadows. Returns the patch and the fire.
pub fn draw_meadow(app: &mut App, passes: bool) -> [Entity; 2] {
    app.finish();
    app.cleanup();
    let sward = Sward { width_m: 3.0, depth_m: 3.0, ..default() };
    let patch = app.world_mut().spawn(GrassPatch { sward, ..default() }).id();
    let look = FireLook { casts_shadows: passes, ..default() };
    let fire = app.world_mut().spawn(Fire { look, ..default() }).id();
    let image = Image::new_target_texture(64, 64, TextureFormat::Rgba8UnormSrgb, None);
    let target = app.world_mut().resource_mut::<Assets<Image>>().add(image);
    let eye = Transform::from_xyz(0.0, 1.0, 4.0).looking_at(Vec3::Y * 0.3, Vec3::Y);
    let mut camera = app.world_mut().spawn((Camera3d::default(), Msaa::Off, RenderTarget::Image(target.into()), eye));
    if passes {
        camera.insert((DepthPrepass, NormalPrepass, MotionVectorPrepass));
    }
    app.world_mut().spawn((
        DirectionalLight { shadow_maps_enabled: passes, ..default() },
        Transform::from_xyz(1.0, 2.0, 1.0).looking_at(Vec3::ZERO, Vec3::Y),
    ));
    let is_drawn = |world: &mut World| {
        [patch, fire].iter().all(|entity| world.get::<Mesh3d>(*entity).is_some())
            && world.resource::<ActiveSway>().is_ready()
    };
    assert!(update_until(app, is_drawn), "grass and fire were not drawn in time");
    (0..5).for_each(|_| app.update());
    [patch, fire]
}

/// Asserts that every pipeline that draws meshes has compiled.
pub fn assert_meshes_compile(app: &App) {
    let broken: Vec<String> = pipelines_with(app, "VERTEX_POSITIONS")
        .filter_map(|pipeline| match &pipeline.state {
            CachedPipelineState::Err(error) => Some(error.to_string()),
            _ => None,
        })
        .collect();
    assert!(broken.is_empty(), "{}", broken.join("\n"));
}

/// The pipelines whose vertex shader has that definition.
pub fn pipelines_with<'a>(app: &'a App, shader_def: &'static str) -> impl Iterator<Item = &'a CachedPipeline> {
    let has = move |descriptor: &PipelineDescriptor| match descriptor {
        PipelineDescriptor::RenderPipelineDescriptor(it) => it.vertex.shader_defs.contains(&shader_def.into()),
        _ => false,
    };
    let cache = app.sub_app(RenderApp).world().resource::<PipelineCache>();
    cache.pipelines().filter(move |pipeline| has(&pipeline.descriptor))
}
