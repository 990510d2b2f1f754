//! Lesson 3: a wood on the ground of your game.
//!
//! A `Forest` grows after a plan: a file that says where which trees grow, how densely, how old, and what is kept free of them. Nobody places
//! the trees, and they are not saved: the same plan and seed give the same wood on every machine. About the viewer its trees are entities
//! like those of the first lessons, farther off they are pictures that lean with the same wind, and all of it comes and goes in the background.
//!
//! Your level is already there, and so the wood has to stand on it. `ForestGround` is given anything that can tell its height at a place:
//!
//! - a function of the place, if your ground is one (key 1),
//! - the mesh that you draw, by `TriangleGround` (key 2),
//! - your physics engine, by `RayCastGround`, which casts rays down (key 3).
//!
//! All three are the same hills here, and so nothing moves when you change between them: trees that stand where they stood are kept. A meadow
//! takes the same (`GrassGround`). Where the height is no number there is no ground, and nothing grows: here on the path.
//!
//! If you have no ground yet, `Terrain` draws any such function to the horizon: see `docs/guide/ground.md`.

#[path = "../support/mod.rs"]
mod support;

use bevy::{
    camera_controller::free_camera::FreeCamera,
    light::NotShadowCaster,
    math::{DVec2, DVec3},
    mesh::VertexAttributeValues,
    prelude::*,
};
use bevy_windwood::{
    prelude::*,
    terrain::{RayCastGround, TriangleGround},
};
use std::{process::ExitCode, sync::Arc};
use support::course::Course;

fn main() -> ExitCode {
    let course = Course::begin("03_a_wood_on_your_ground");
    let mut app = App::new();
    app.add_plugins((course.engine(), WindwoodPlugins))
        .insert_resource(Wind { speed: 8.0, direction: Dir2::X, ..default() })
        .add_systems(Startup, (spawn_level, spawn_camera))
        .add_systems(Update, change_ground);
    course.run(&mut app, "1 function    2 mesh    3 rays")
}

/// The height of the level, m: it stands for what a game has.
fn height_m(at: DVec2) -> f64 {
    let hills = 7.0 * (at.x / 43.0).sin() * (at.y / 37.0).cos() + 2.0 * (at.x / 17.0 + at.y / 23.0).sin();
    // A flat valley runs through.
    hills.max(-3.0)
}

/// The mesh that the game draws.
fn level_mesh() -> Mesh {
    let mut mesh = Mesh::from(Plane3d::default().mesh().size(320.0, 320.0).subdivisions(79));
    if let Some(VertexAttributeValues::Float32x3(positions)) = mesh.attribute_mut(Mesh::ATTRIBUTE_POSITION) {
        for [x, y, z] in positions {
            *y = height_m(DVec2::new(f64::from(*x), f64::from(*z))) as f32;
        }
    }
    mesh.compute_smooth_normals();
    mesh
}

/// What a physics engine answers to a ray straight down: the distance to the level, m, if it is within reach.
fn distance_down_m(from: DVec3, reach_m: f64) -> Option<f64> {
    let distance_m = from.y - height_m(DVec2::new(from.x, from.z));
    (0.0..=reach_m).contains(&distance_m).then_some(distance_m)
}

fn spawn_level(
    mut commands: Commands,
    assets: Res<AssetServer>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) -> Result {
    let mesh = level_mesh();
    let ground: Arc<dyn Ground> = Arc::new(TriangleGround::from_mesh(&mesh, Transform::IDENTITY)?);
    commands.spawn((
        Forest::new(assets.load("forests/mixed.forest.ron")),
        ForestSettings { trees_to_m: 120.0, far_to_m: 400.0, ..default() },
        ForestGround(ground.clone()),
    ));
    // Grass over the whole clearing, but not on the path.
    let on_path = |at: DVec2| (at.y - 40.0 + 0.1 * at.x).abs() < 1.5;
    let meadow = move |at: DVec2| if on_path(at) { f64::NAN } else { ground.height_m(at) };
    let sward = Sward { width_m: 12.0, depth_m: 12.0, tufts_per_m2: 11.0, ..default() };
    let look = GrassLook { thins_from_m: 14.0, vanishes_at_m: 60.0, ..default() };
    let field = GrassField { patch: GrassPatch { sward, look, ..default() }, patches_per_frame: 16 };
    commands.spawn((field, GrassGround(Arc::new(meadow)), NotShadowCaster));
    let base_color = Color::srgb(0.30, 0.26, 0.17);
    let earth = StandardMaterial { base_color, perceptual_roughness: 1.0, reflectance: 0.1, ..default() };
    commands.spawn((Mesh3d(meshes.add(mesh)), MeshMaterial3d(materials.add(earth))));
    Ok(())
}

/// Ground may be another at any time: the forest is planted anew on it, and keeps every tree that has not moved.
fn change_ground(
    mut commands: Commands,
    keys: Res<ButtonInput<KeyCode>>,
    forest: Single<Entity, With<Forest>>,
) -> Result {
    let ground: Arc<dyn Ground> = if keys.just_pressed(KeyCode::Digit1) {
        Arc::new(height_m)
    } else if keys.just_pressed(KeyCode::Digit2) {
        Arc::new(TriangleGround::from_mesh(&level_mesh(), Transform::IDENTITY)?)
    } else if keys.just_pressed(KeyCode::Digit3) {
        // Rays start at the upper of these heights, and end at the lower.
        Arc::new(RayCastGround::new(-20.0..=40.0, distance_down_m)?)
    } else {
        return Ok(());
    };
    commands.entity(*forest).insert(ForestGround(ground));
    Ok(())
}

fn spawn_camera(mut commands: Commands) {
    let above = |x: f32, z: f32, above_m: f32| {
        Vec3::new(x, height_m(DVec2::new(f64::from(x), f64::from(z))) as f32 + above_m, z)
    };
    let place = Transform::from_translation(above(41.0, 45.0, 2.0)).looking_at(above(2.0, 33.0, 5.0), Vec3::Y);
    commands.spawn((Camera3d::default(), FreeCamera::default(), place));
}
