//! Meadows and fires without rendering: how they are built, changed, refused and removed.

use bevy::{math::DVec2, prelude::*};
use bevy_windwood::{
    fire::{Flames, flicker},
    grass::{Meadow, spine, swing},
    prelude::*,
};
use std::sync::Arc;

fn app() -> App {
    let mut app = App::new();
    app.add_plugins((MinimalPlugins, TransformPlugin, AssetPlugin::default(), WindwoodMinimalPlugins));
    app.finish();
    app.cleanup();
    app
}

/// Lets background work finish until `done`.
fn wait_until(app: &mut App, what: &str, done: impl Fn(&World) -> bool) {
    for _ in 0..4000 {
        app.update();
        if done(app.world()) {
            return;
        }
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    panic!("{what} did not come about within 20 s");
}

fn lawn(width_m: f32) -> GrassPatch {
    GrassPatch { sward: Sward { width_m, depth_m: 2.0, ..default() }, ..default() }
}

fn meadow(app: &App, patch: Entity) -> &Meadow {
    app.world().get::<Meadow>(patch).expect("it has grown")
}

fn grown(app: &mut App, patch: GrassPatch) -> Entity {
    let patch = app.world_mut().spawn(patch).id();
    wait_until(app, "the meadow", |world| world.get::<Meadow>(patch).is_some());
    patch
}

#[test]
fn a_patch_gets_as_many_blades_as_its_sward_says() {
    let mut app = app();
    let patch = grown(&mut app, lawn(3.0));
    assert_eq!(meadow(&app, patch).blades.len() as u64, lawn(3.0).sward.blades());
}

#[test]
fn blades_are_laid_out_again_when_the_ground_is_replaced() {
    let mut app = app();
    let patch = grown(&mut app, lawn(3.0));
    app.world_mut().entity_mut(patch).insert(GrassGround(Arc::new(|at: DVec2| 2.0 + at.x)));
    wait_until(&mut app, "the slope", |world| {
        world.get::<Meadow>(patch).is_some_and(|meadow| meadow.blades[0].root.y != 0.0)
    });
    assert!(meadow(&app, patch).blades.iter().all(|blade| blade.root.y == 2.0 + blade.root.x));
}

#[test]
fn blades_are_laid_out_again_for_a_new_sward_but_not_for_a_new_look() {
    let mut app = app();
    let patch = grown(&mut app, lawn(3.0));
    let before = meadow(&app, patch).blades.clone();
    app.world_mut().get_mut::<GrassPatch>(patch).expect("it is there").look.translucency = 0.1;
    app.update();
    let after = meadow(&app, patch);
    assert!(Arc::ptr_eq(&before, &after.blades) && after.patch.look.translucency == 0.1);
    app.world_mut().get_mut::<GrassPatch>(patch).expect("it is there").sward.seed = 7;
    wait_until(&mut app, "another meadow", |world| {
        world.get::<Meadow>(patch).is_some_and(|meadow| !Arc::ptr_eq(&meadow.blades, &before))
    });
    assert_ne!(*before, *meadow(&app, patch).blades);
}

#[test]
fn an_invalid_patch_keeps_its_last_good_meadow() {
    let mut app = app();
    let patch = grown(&mut app, lawn(3.0));
    let before = meadow(&app, patch).clone();
    for broken in [f32::NAN, -1.0, f32::INFINITY, 1e9] {
        app.world_mut().get_mut::<GrassPatch>(patch).expect("it is there").sward.width_m = broken;
        (0..20).for_each(|_| app.update());
        let after = meadow(&app, patch);
        assert!(Arc::ptr_eq(&before.blades, &after.blades) && after.patch == before.patch);
    }
    app.world_mut().get_mut::<GrassPatch>(patch).expect("it is there").sward.width_m = 4.0;
    wait_until(&mut app, "the good meadow", |world| {
        world.get::<Meadow>(patch).is_some_and(|meadow| meadow.patch.sward.width_m == 4.0)
    });
}

#[test]
fn the_meadow_of_a_removed_patch_is_removed() {
    let mut app = app();
    let (kept, gone) = (grown(&mut app, lawn(3.0)), grown(&mut app, lawn(2.0)));
    app.world_mut().entity_mut(kept).remove::<GrassPatch>();
    app.world_mut().entity_mut(gone).despawn();
    app.update();
    assert!(app.world().get::<Meadow>(kept).is_none() && app.world().get_entity(gone).is_err());
    // Removed while it is laid out.
    let sown = app.world_mut().spawn(lawn(4.0)).id();
    app.update();
    app.world_mut().entity_mut(sown).remove::<GrassPatch>();
    (0..50).for_each(|_| {
        app.update();
        std::thread::sleep(std::time::Duration::from_millis(1));
    });
    assert!(app.world().get::<Meadow>(sown).is_none());
}

#[test]
fn an_invalid_fire_keeps_its_last_good_flames() {
    let mut app = app();
    let fire = app.world_mut().spawn(Fire::default()).id();
    app.update();
    let flames = app.world().get::<Flames>(fire).expect("it burns").clone();
    assert!(!flames.rhombs.is_empty() && flames.height_m > 0.3);
    app.world_mut().get_mut::<Fire>(fire).expect("it is there").shape.threshold_m = 0.0;
    app.update();
    let after = app.world().get::<Flames>(fire).expect("it burns on");
    assert!(Arc::ptr_eq(&flames.rhombs, &after.rhombs) && after.fire == Fire::default());
    app.world_mut().get_mut::<Fire>(fire).expect("it is there").shape = FireShape { seed: 9, ..default() };
    app.update();
    assert_ne!(*flames.rhombs, *app.world().get::<Flames>(fire).expect("it burns").rhombs);
}

#[test]
fn the_flames_of_a_removed_fire_are_removed() {
    let mut app = app();
    let fire = app.world_mut().spawn(Fire::default()).id();
    app.update();
    app.world_mut().entity_mut(fire).remove::<Fire>();
    app.update();
    assert!(app.world().get::<Flames>(fire).is_none());
}

/// The numbers of a constant of a shader.
fn constant(shader: &str, name: &str) -> Vec<f32> {
    let line = shader.lines().find(|line| line.starts_with(&format!("const {name}:"))).expect("the shader has it");
    let value = line
        .split(" = ")
        .nth(1)
        .expect("it has a value")
        .trim()
        .trim_start_matches("vec3(")
        .trim_start_matches("vec2(");
    value.trim_end_matches([')', ';', 'u']).split(',').map(|number| number.trim().parse().expect("a number")).collect()
}

#[test]
fn shader_constants_equal_those_in_rust() {
    let blade = include_str!("../src/grass/shaders/blade.wesl");
    assert_eq!(constant(blade, "LINKS"), [spine::LINKS as f32]);
    assert_eq!(constant(blade, "TIP_ANGLE_LIMIT_RAD"), [spine::TIP_ANGLE_LIMIT_RAD]);
    assert_eq!(constant(blade, "ANGLE_LIMIT_RAD"), [spine::ANGLE_LIMIT_RAD]);
    assert_eq!(constant(blade, "REST_S"), swing::REST_S);
    let fire = include_str!("../src/fire/shaders/fire.wesl");
    assert_eq!(constant(fire, "WEIGHTS"), flicker::WEIGHTS);
}
