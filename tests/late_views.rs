//! Trees are in the pictures of cameras and in the shadows of suns that are spawned after them. Needs a Vulkan driver. Mesa's
//! software one will do.

mod support;

use bevy::prelude::*;
use bevy_windwood::prelude::*;
use image::RgbaImage;
use std::time::Duration;
use support::{capture, covered};

const SIZE: (u32, u32) = (160, 80);

/// An app with a row of firs whose meshes are complete before there is a camera.
fn row_of_firs() -> App {
    let mut app = support::headless_app(Duration::from_millis(16), None);
    capture::begin(&mut app).expect("a graphics device");
    let species = app.world().resource::<AssetServer>().load("species/fir.species.ron");
    let world = app.world_mut();
    world.insert_resource(ClearColor(support::BACKGROUND));
    for tree in 0..8_u8 {
        let at = Vec3::X * (6.0 * f32::from(tree) - 21.0);
        world.spawn((Tree::new(species.clone()), Transform::from_translation(at)));
    }
    let is_ready = support::update_until(&mut app, |world| {
        world.query_filtered::<(), (With<Tree>, With<TreeMeshes>)>().iter(world).count() == 8
    });
    assert!(is_ready, "the trees were not ready in time");
    (0..5).for_each(|_| capture::step(&mut app));
    app
}

fn spawn_camera(app: &mut App) -> Handle<Image> {
    let target = capture::target(app, SIZE);
    let place = Transform::from_xyz(0.0, 11.0, 45.0).looking_at(Vec3::Y * 10.0, Vec3::Y);
    app.world_mut().spawn((capture::camera(&target), place));
    target
}

fn picture(app: &mut App, target: &Handle<Image>) -> RgbaImage {
    (0..8).for_each(|_| capture::step(app));
    capture::capture(app, target, SIZE).expect("a picture")
}

#[test]
fn later_cameras_show_earlier_trees() {
    let mut app = row_of_firs();
    let first = spawn_camera(&mut app);
    let seen = covered(&picture(&mut app, &first));
    println!("the first camera sees {seen}");
    let second = spawn_camera(&mut app);
    let by_both = [covered(&picture(&mut app, &second)), covered(&picture(&mut app, &first))];
    println!("then both see {by_both:?}");
    assert!(seen > 0.1 && by_both == [seen; 2], "{seen} of the first picture are trees, then {by_both:?}");
}

/// Mean green of a picture.
fn mean_light(picture: &RgbaImage) -> f32 {
    picture.pixels().map(|pixel| f32::from(pixel.0[1])).sum::<f32>() / (SIZE.0 * SIZE.1) as f32
}

#[test]
fn later_suns_cast_shadows_of_earlier_trees() {
    let mut app = row_of_firs();
    let world = app.world_mut();
    let ground = world.resource_mut::<Assets<Mesh>>().add(Plane3d::default().mesh().size(400.0, 400.0));
    let grey = world.resource_mut::<Assets<StandardMaterial>>().add(StandardMaterial::from(Color::WHITE));
    world.spawn((Mesh3d(ground), MeshMaterial3d(grey)));
    // From above, so that the ground beside the row is in the picture.
    let target = capture::target(&mut app, SIZE);
    let place = Transform::from_xyz(0.0, 60.0, 30.0).looking_at(Vec3::new(0.0, 0.0, 12.0), Vec3::Y);
    app.world_mut().spawn((capture::camera(&target), place));
    picture(&mut app, &target);
    let sun = |shadow_maps_enabled| {
        let light = DirectionalLight { shadow_maps_enabled, illuminance: 5000.0, ..default() };
        (light, Transform::default().looking_to(Vec3::new(0.1, -0.7, 0.7), Vec3::Y))
    };
    let without = app.world_mut().spawn(sun(false)).id();
    let bright = mean_light(&picture(&mut app, &target));
    app.world_mut().despawn(without);
    app.world_mut().spawn(sun(true));
    let shaded = mean_light(&picture(&mut app, &target));
    assert!(shaded < 0.97 * bright, "{bright} without shadows, {shaded} with them");
}
