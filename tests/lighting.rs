//! `TreeLighting::SunOnly` looks like `AllLights` under a sun, and ignores lamps. Needs a Vulkan driver. Mesa's software one
//! will do.

mod support;

use bevy::{light::CascadeShadowConfigBuilder, prelude::*};
use bevy_windwood::prelude::*;
use image::RgbaImage;
use support::forest::TestForest;

/// Mean difference of two pictures, of 255, and the share of pixels that differ by more than 12.
fn difference(one: &RgbaImage, other: &RgbaImage) -> (f32, f32) {
    let apart = |(a, b): (&image::Rgba<u8>, &image::Rgba<u8>)| {
        (0..3).map(|channel| a.0[channel].abs_diff(b.0[channel])).max().unwrap_or(0)
    };
    let count = one.pixels().len() as f32;
    let sum: f32 = one.pixels().zip(other.pixels()).map(apart).map(f32::from).sum();
    let far = one.pixels().zip(other.pixels()).map(apart).filter(|apart| *apart > 12).count();
    (sum / count, far as f32 / count)
}

fn picture_in(forest: &mut TestForest, lighting: TreeLighting) -> RgbaImage {
    forest.app.world_mut().insert_resource(lighting);
    forest.picture()
}

#[test]
fn sun_only_equals_all_lights_under_a_sun_and_ignores_lamps() {
    // Trees near by, impostors beyond.
    let settings = ForestSettings { trees_to_m: 70.0, far_to_m: 300.0, ..default() };
    let mut forest = TestForest::new(settings, None);
    forest.look(Vec3::new(0.0, 14.0, 0.0), Vec3::new(0.3, -0.15, -1.0));
    let cascades = CascadeShadowConfigBuilder { num_cascades: 1, maximum_distance: 80.0, ..default() }.build();
    let sun = DirectionalLight { illuminance: 8000.0, shadow_maps_enabled: true, ..default() };
    let place = Transform::default().looking_to(Vec3::new(0.3, -0.6, -0.7), Vec3::Y);
    let sun = forest.app.world_mut().spawn((sun, cascades, place)).id();
    let all = picture_in(&mut forest, TreeLighting::AllLights);
    let alone = picture_in(&mut forest, TreeLighting::SunOnly);
    let (mean, far) = difference(&all, &alone);
    println!("{mean} of 255 apart, {far} of the pixels by more than 12");
    assert!(mean < 1.0 && far < 0.01, "{mean} of 255 apart, {far} of the pixels by more than 12");

    forest.app.world_mut().despawn(sun);
    let dark = picture_in(&mut forest, TreeLighting::SunOnly);
    let (mean, _) = difference(&alone, &dark);
    assert!(mean > 5.0, "without the sun they are {mean} of 255 apart");

    let lamp = PointLight { intensity: 4e7, range: 200.0, ..default() };
    forest.app.world_mut().spawn((lamp, Transform::from_xyz(0.0, 16.0, -10.0)));
    let (mean, _) = difference(&dark, &picture_in(&mut forest, TreeLighting::SunOnly));
    assert!(mean < 0.1, "a lamp makes {mean} of 255");
    let (mean, _) = difference(&dark, &picture_in(&mut forest, TreeLighting::AllLights));
    assert!(mean > 3.0, "a lamp makes {mean} of 255");
}
