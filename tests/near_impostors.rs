//! A tree that stands as an entity hides its impostor, in any forest and before any camera. Needs a Vulkan driver. Mesa's software one
//! will do.

mod support;

use bevy::prelude::*;
use bevy_windwood::{
    prelude::*,
    scatter::{
        ForestPlan,
        plan::{Area, Shape, Stock},
    },
};
use image::RgbaImage;
use std::time::Duration;
use support::{capture, covered};

const SIZE: (u32, u32) = (480, 270);
/// Impostors beyond the near trees, or none at all.
const FAR_TO_M: [f32; 2] = [600.0, 0.0];

/// A few firs in a rectangle, (x, z), m.
fn stand(world: &mut World, min_m: [f32; 2], max_m: [f32; 2], cell_m: f32, settings: ForestSettings) {
    let stock = Stock { species: "fir".into(), age_years: 60.0, age_spread_years: 8.0, ..default() };
    let shape = Shape::Rectangle { min_m, max_m };
    let area = Area { shape, density_per_ha: 60.0, stock: vec![stock], ..default() };
    let plan = ForestPlan { seed: 5, cell_m, areas: vec![area], ..default() };
    let plan = world.resource_mut::<Assets<ForestPlan>>().add(plan);
    world.spawn((Forest::new(plan), ForestSettings { trees_per_frame: 10_000, cells_at_once: 64, ..settings }));
}

/// A picture of what `spawn` spawns, from a place towards -z. Trees are drawn in full, so that impostors alone change the picture.
fn picture(eye: Vec3, spawn: impl FnOnce(&mut World)) -> RgbaImage {
    let mut app = support::headless_app(Duration::ZERO, None);
    capture::begin(&mut app).expect("a graphics device");
    let target = capture::target(&mut app, SIZE);
    let world = app.world_mut();
    support::light_plainly(world);
    world.resource_mut::<LevelOfDetail>().style = LevelStyle::Full;
    spawn(world);
    let lens = Projection::Perspective(PerspectiveProjection { fov: 0.3, ..default() });
    world.spawn((capture::camera(&target), lens, Transform::from_translation(eye)));
    let ready = support::update_until(&mut app, |world| {
        world.resource::<ActiveSway>().is_ready() && capture::forests_are_drawn(world)
    });
    assert!(ready, "the forest was not drawn in time");
    (0..8).for_each(|_| capture::step(&mut app));
    capture::capture(&mut app, &target, SIZE).expect("a picture")
}

/// Asserts that a scene without impostors and the same with impostors beyond its trees look alike.
fn assert_impostors_are_hidden(scene: impl Fn(f32) -> RgbaImage) {
    let [with, without] = FAR_TO_M.map(scene);
    let drawn = covered(&without);
    assert!(drawn > 0.03, "only {drawn} of the picture is covered by trees");
    let differs = |(a, b): &(_, _)| a != b;
    let different = with.pixels().zip(without.pixels()).filter(differs).count();
    let share = different as f32 / (SIZE.0 * SIZE.1) as f32 / drawn;
    println!("{share:.4} of the pixels of trees differ");
    assert!(share < 0.01, "{share} of the pixels of trees differ: impostors are drawn with them");
}

#[test]
fn a_second_forest_hides_the_impostors_of_its_own_near_trees() {
    assert_impostors_are_hidden(|far_to_m| {
        picture(Vec3::new(0.0, 10.0, 0.0), |world| {
            let settings = ForestSettings { trees_to_m: 200.0, far_to_m, ..default() };
            stand(world, [3000.0, 3000.0], [3100.0, 3100.0], 64.0, settings.clone());
            stand(world, [-20.0, -130.0], [20.0, -80.0], 64.0, settings);
        })
    });
}

#[test]
fn forests_whose_trees_reach_differently_far_fade_each_at_its_own_distance() {
    assert_impostors_are_hidden(|far_to_m| {
        picture(Vec3::new(0.0, 10.0, 0.0), |world| {
            let settings = |trees_to_m| ForestSettings { trees_to_m, far_to_m, ..default() };
            stand(world, [3000.0, 3000.0], [3100.0, 3100.0], 32.0, settings(40.0));
            stand(world, [-20.0, -130.0], [20.0, -80.0], 64.0, settings(200.0));
        })
    });
}

#[test]
fn a_camera_far_from_another_viewpoint_sees_no_impostors_of_near_trees() {
    assert_impostors_are_hidden(|far_to_m| {
        picture(Vec3::new(5000.0, 10.0, 0.0), |world| {
            world.spawn(Viewpoint);
            let settings = ForestSettings { trees_to_m: 200.0, far_to_m, ..default() };
            stand(world, [4980.0, -130.0], [5020.0, -80.0], 64.0, settings);
        })
    });
}

#[test]
fn small_cells_far_from_the_camera_hide_the_impostors_of_their_trees() {
    assert_impostors_are_hidden(|far_to_m| {
        picture(Vec3::new(0.0, 10.0, 0.0), |world| {
            let settings = ForestSettings { trees_to_m: 320.0, far_to_m, ..default() };
            stand(world, [-20.0, -200.0], [20.0, -150.0], 8.0, settings);
        })
    });
}
