//! The shaders of grass and fires compile for every pass. Needs a Vulkan driver. Mesa's software one will do.

mod support;

use bevy::prelude::*;
use bevy_windwood::{fire::FireLight, prelude::*};
use std::time::Duration;
use support::{
    headless_app,
    plants::{assert_meshes_compile, draw_meadow, pipelines_with},
};

#[test]
fn meadow_and_fire_compile_for_every_pass_and_can_be_removed() {
    let mut app = headless_app(Duration::from_millis(16), None);
    let [patch, fire] = draw_meadow(&mut app, true);
    assert_meshes_compile(&app);
    let grass = pipelines_with(&app, "WINDWOOD_GRASS").count();
    assert!(grass >= 3, "grass is drawn in the main pass, the prepass and the shadow pass, not in {grass} pipelines");
    assert!(pipelines_with(&app, "WINDWOOD_WIND").count() >= 1, "the fire is drawn in the wind");

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
