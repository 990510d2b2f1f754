//! The shaders of meadows and fires compile for every pass that draws them. Needs a Vulkan driver; Mesa's software one will
//! do.

mod support;

use bevy::{
    material::descriptor::PipelineDescriptor,
    prelude::*,
    render::{RenderApp, render_resource::PipelineCache},
};
use bevy_windwood::{fire::FireLight, prelude::*};
use std::time::Duration;
use support::{
    headless_app,
    plants::{assert_all_compile, draw_meadow},
};

#[test]
fn meadow_and_fire_compile_for_every_pass_and_go_without_a_trace() {
    let mut app = headless_app(Duration::from_millis(16), None);
    let [patch, fire] = draw_meadow(&mut app, true);
    assert_all_compile(&app);
    let cache = app.sub_app(RenderApp).world().resource::<PipelineCache>();
    let pipelines_with = |shader_def: &str| {
        let has = |descriptor: &PipelineDescriptor| match descriptor {
            PipelineDescriptor::RenderPipelineDescriptor(it) => it.vertex.shader_defs.contains(&shader_def.into()),
            PipelineDescriptor::ComputePipelineDescriptor(_) => false,
        };
        cache.pipelines().filter(|pipeline| has(&pipeline.descriptor)).count()
    };
    assert!(pipelines_with("WINDWOOD_GRASS") >= 3, "grass is drawn in the main pass, the prepass and the shadow pass");
    assert!(pipelines_with("WINDWOOD_FIRE") >= 1, "the fire is drawn");

    let world = app.world_mut();
    let light = |world: &mut World| world.query_filtered::<&PointLight, With<FireLight>>().iter(world).count();
    assert_eq!(light(world), 1);
    world.entity_mut(fire).remove::<Fire>();
    world.entity_mut(patch).remove::<GrassPatch>();
    app.update();
    let world = app.world_mut();
    assert_eq!(light(world), 0);
    assert!([patch, fire].iter().all(|entity| world.get::<Mesh3d>(*entity).is_none()));
}
