//! Trees as entities of a game: what a game may do to them, and what stays its own. Needs a Vulkan driver. Mesa's software one
//! will do.

mod support;

use bevy::{camera::visibility::RenderLayers, mesh::MeshTag, prelude::*};
use bevy_windwood::{
    prelude::*,
    render::{TreeMeshOf, TreePart},
};
use image::RgbaImage;
use std::time::Duration;
use support::{capture, covered, is_background};

const SIZE: (u32, u32) = (160, 120);

/// An app with firs at these places, before a camera and under a magenta sky.
fn app_with_firs(places: &[Transform]) -> (App, Vec<Entity>, Handle<Image>) {
    let mut app = support::headless_app(Duration::from_millis(16), None);
    capture::begin(&mut app).expect("a graphics device");
    let target = capture::target(&mut app, SIZE);
    let species = app.world().resource::<AssetServer>().load("species/fir.species.ron");
    let world = app.world_mut();
    support::light_plainly(world);
    let eye = Transform::from_xyz(0.0, 11.0, 50.0).looking_at(Vec3::Y * 10.0, Vec3::Y);
    world.spawn((capture::camera(&target), eye));
    let trees: Vec<Entity> =
        places.iter().map(|at| world.spawn((Tree::new(species.clone()).with_seed(1), *at)).id()).collect();
    wait_until_drawn(&mut app, &trees);
    (app, trees, target)
}

fn wait_until_drawn(app: &mut App, trees: &[Entity]) {
    let is_ready = support::update_until(app, |world| {
        world.resource::<ActiveSway>().is_ready() && trees.iter().all(|tree| world.get::<TreeMeshes>(*tree).is_some())
    });
    assert!(is_ready, "the trees were not drawn in time");
    (0..5).for_each(|_| capture::step(app));
}

fn meshes(app: &App, tree: Entity) -> Vec<Entity> {
    app.world().get::<TreeMeshes>(tree).map(|meshes| meshes.iter().collect()).unwrap_or_default()
}

/// Rows of the trees that meshes are of.
fn rows(app: &App, tree: Entity) -> Vec<u32> {
    let tag = |mesh: Entity| app.world().get::<MeshTag>(mesh).expect("it has a tag").value & 0xffff;
    meshes(app, tree).into_iter().map(tag).collect()
}

/// The next picture, without waiting for anything.
fn next_picture(app: &mut App, target: &Handle<Image>) -> RgbaImage {
    capture::capture(app, target, SIZE).expect("a picture")
}

#[test]
fn a_removed_tree_takes_its_meshes_with_it_and_nothing_else() {
    let (mut app, trees, target) = app_with_firs(&[Transform::IDENTITY]);
    let stump = app.world_mut().resource_mut::<Assets<Mesh>>().add(Sphere::new(0.1));
    app.world_mut().entity_mut(trees[0]).insert(Mesh3d(stump)).with_child(Name::new("nest")).remove::<Tree>();
    (0..3).for_each(|_| capture::step(&mut app));
    let world = app.world_mut();
    assert_eq!(world.query::<&TreeMeshOf>().iter(world).count(), 0);
    assert!(world.get::<Mesh3d>(trees[0]).is_some(), "the game's mesh stays");
    let children = world.get::<Children>(trees[0]).expect("the nest stays");
    assert!(children.len() == 1 && world.get::<Name>(children[0]).is_some());
    assert!(covered(&next_picture(&mut app, &target)) < 0.01);
}

#[test]
fn a_tree_that_is_put_back_is_drawn_again() {
    let (mut app, trees, _) = app_with_firs(&[Transform::IDENTITY]);
    let tree = app.world_mut().entity_mut(trees[0]).take::<Tree>().expect("it is a tree");
    (0..3).for_each(|_| capture::step(&mut app));
    assert!(meshes(&app, trees[0]).is_empty());
    app.world_mut().entity_mut(trees[0]).insert(tree);
    wait_until_drawn(&mut app, &trees);
}

#[test]
fn a_clone_is_a_tree_of_its_own() {
    let (mut app, trees, _) = app_with_firs(&[Transform::IDENTITY]);
    let clone = app.world_mut().entity_mut(trees[0]).clone_and_spawn();
    app.world_mut().entity_mut(clone).insert(Transform::from_xyz(9.0, 0.0, 0.0));
    wait_until_drawn(&mut app, &[trees[0], clone]);
    let (original, cloned) = (rows(&app, trees[0]), rows(&app, clone));
    assert!(cloned.len() == original.len() && cloned[0] != original[0], "{cloned:?} and {original:?}");
    for mesh in meshes(&app, clone) {
        assert_eq!(app.world().get::<ChildOf>(mesh).map(ChildOf::parent), Some(clone));
    }
    // The row of the original is free once it is gone, and goes to the next tree alone.
    let tree = app.world().get::<Tree>(clone).expect("a tree").clone();
    app.world_mut().despawn(trees[0]);
    let next = app.world_mut().spawn((tree, Transform::from_xyz(-9.0, 0.0, 0.0))).id();
    wait_until_drawn(&mut app, &[clone, next]);
    assert!(rows(&app, next)[0] != rows(&app, clone)[0] && rows(&app, clone) == cloned);
}

#[test]
fn meshes_that_a_game_despawns_come_back() {
    let (mut app, trees, target) = app_with_firs(&[Transform::IDENTITY]);
    let before = covered(&next_picture(&mut app, &target));
    app.world_mut().entity_mut(trees[0]).despawn_related::<Children>();
    (0..4).for_each(|_| capture::step(&mut app));
    let parts: Vec<TreePart> =
        meshes(&app, trees[0]).iter().filter_map(|mesh| app.world().get::<TreePart>(*mesh).copied()).collect();
    assert!(parts.contains(&TreePart::Wood) && parts.contains(&TreePart::Leaves), "{parts:?}");
    let after = covered(&next_picture(&mut app, &target));
    assert!((after / before - 1.0).abs() < 0.05, "{before} covered, then {after}");
}

#[test]
fn visibility_that_a_game_sets_stays() {
    let places = [Transform::IDENTITY, Transform::from_xyz(9.0, 0.0, 0.0)];
    let (mut app, trees, target) = app_with_firs(&places);
    app.world_mut().entity_mut(trees[0]).insert(Visibility::Hidden);
    let mut cameras = app.world_mut().query_filtered::<Entity, With<Camera3d>>();
    let camera = cameras.single(app.world()).expect("one camera");
    for distance_m in [50.0, 400.0, 1500.0, 90.0, 50.0] {
        let eye = Transform::from_xyz(0.0, 11.0, distance_m).looking_at(Vec3::Y * 10.0, Vec3::Y);
        app.world_mut().entity_mut(camera).insert(eye);
        (0..4).for_each(|_| capture::step(&mut app));
        let own = trees.iter().map(|tree| *app.world().get::<Visibility>(*tree).expect("it has one"));
        assert_eq!(own.collect::<Vec<_>>(), [Visibility::Hidden, Visibility::Inherited], "at {distance_m} m");
    }
    let picture = next_picture(&mut app, &target);
    let left = picture.enumerate_pixels().filter(|(x, _, pixel)| *x < SIZE.0 / 2 && !is_background(pixel)).count();
    let right = picture.enumerate_pixels().filter(|(x, _, pixel)| *x >= SIZE.0 / 2 && !is_background(pixel)).count();
    assert!(right > 20 * left.max(1), "{left} pixels where the hidden tree stands, {right} where the other does");
}

#[test]
fn a_tree_is_in_the_pictures_of_cameras_of_its_layers() {
    let (mut app, trees, target) = app_with_firs(&[Transform::IDENTITY]);
    assert!(covered(&next_picture(&mut app, &target)) > 0.01);
    app.world_mut().entity_mut(trees[0]).insert(RenderLayers::layer(1));
    (0..3).for_each(|_| capture::step(&mut app));
    assert_eq!(covered(&next_picture(&mut app, &target)), 0.0, "a camera of layer 0 sees nothing of it");
    let other = capture::target(&mut app, SIZE);
    let eye = Transform::from_xyz(0.0, 11.0, 50.0).looking_at(Vec3::Y * 10.0, Vec3::Y);
    app.world_mut().spawn((capture::camera(&other), eye, RenderLayers::layer(1)));
    (0..3).for_each(|_| capture::step(&mut app));
    let meshes = meshes(&app, trees[0]);
    assert!(meshes.iter().all(|mesh| app.world().get::<RenderLayers>(*mesh) == Some(&RenderLayers::layer(1))));
    assert!(covered(&next_picture(&mut app, &other)) > 0.01, "a camera of layer 1 sees it");
}

#[test]
fn no_frame_is_without_trees_when_views_come() {
    let (mut app, _, target) = app_with_firs(&[Transform::IDENTITY]);
    let before = covered(&next_picture(&mut app, &target));
    let other = capture::target(&mut app, SIZE);
    let check = |app: &mut App, what: &str| {
        for frame in 0..3 {
            let now = covered(&next_picture(app, &target));
            assert!((now / before - 1.0).abs() < 0.02, "{before} covered, {now} in frame {frame} after {what}");
        }
    };
    app.world_mut().spawn((capture::camera(&other), Transform::from_xyz(0.0, 11.0, -50.0)));
    check(&mut app, "a camera");
    let overlay = bevy::camera::RenderTarget::Image(other.into());
    app.world_mut().spawn((Camera2d, Camera { order: 1, ..default() }, overlay));
    check(&mut app, "an overlay");
    let sun = DirectionalLight { shadow_maps_enabled: true, ..default() };
    app.world_mut().spawn((sun, Transform::default().looking_to(Vec3::new(0.3, -0.6, -0.7), Vec3::Y)));
    check(&mut app, "a sun with shadows");
}

/// Mean place across the picture of what is drawn in its upper third.
fn crown_x(picture: &RgbaImage) -> f32 {
    let drawn: Vec<f32> = picture
        .enumerate_pixels()
        .filter(|(_, y, pixel)| *y < SIZE.1 / 2 && !is_background(pixel))
        .map(|(x, ..)| x as f32)
        .collect();
    drawn.iter().sum::<f32>() / drawn.len().max(1) as f32
}

#[test]
fn a_mirrored_tree_leans_with_the_wind() {
    let lean = |scale: Vec3| {
        let (mut app, _, target) = app_with_firs(&[Transform::from_scale(scale)]);
        let calm = crown_x(&next_picture(&mut app, &target));
        // The wind blows to the right of the picture. The clock goes on until it has faded in.
        app.world_mut().insert_resource(Wind { speed: 30.0, direction: Dir2::X, fade_s: 0.1, ..default() });
        app.insert_resource(bevy::time::TimeUpdateStrategy::ManualDuration(Duration::from_millis(100)));
        (0..40).for_each(|_| app.update());
        let settled = support::update_until(&mut app, |world| world.resource::<ActiveSway>().is_settled());
        assert!(settled, "the wind did not come");
        (0..6).for_each(|_| capture::step(&mut app));
        crown_x(&next_picture(&mut app, &target)) - calm
    };
    let [upright, mirrored] = [Vec3::ONE, Vec3::new(-1.0, 1.0, 1.0)].map(lean);
    println!("leans by {upright} pixels, mirrored by {mirrored}");
    assert!(upright > 1.0 && mirrored > 1.0, "leans by {upright} pixels, mirrored by {mirrored}");
}
