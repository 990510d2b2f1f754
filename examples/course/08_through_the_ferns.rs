//! Lesson 8: a character walks through the ferns.
//!
//! `Pusher` is a body that parts branches: a ball or a capsule on any entity. Its default is a walker, 0.3 m in radius and 1.8 m tall, that leans
//! on a branch with 150 N. What it meets is bent until it lies beside the body, but not further than that force bends it: so fronds of bracken
//! give way altogether, a hazel's rods swing aside, and the pine's trunk does not care. When the body has passed, each of them swings back at
//! its own frequency and comes to rest. Grass lies down, too.
//!
//! A pusher does not stop the character; that is left to your physics and to `TreeColliders`. Here the only thing in the way is a trunk, and
//! the character is kept off it by its distance.
//!
//! The ferns are a `Forest` of their own, with a plan of its own, which is there only as far as such small plants are seen: nothing sets them
//! apart from trees but their species. `ForestPlan` is the same as the file of lesson 3, but written in code.
//!
//! The character walks by itself, and turns at the end of its way. With the arrow keys you steer it.

#[path = "../support/mod.rs"]
mod support;

use bevy::prelude::*;
use bevy_windwood::{
    prelude::*,
    scatter::{
        ForestPlan,
        counts::CountModel,
        plan::{Area, Shape, Stock},
    },
};
use std::process::ExitCode;
use support::course::{Course, spawn_meadow};

/// Of the character, m/s.
const SPEED_M_S: f32 = 1.5;
/// It turns so far from the middle of its way, m.
const TURNS_AT_M: f32 = 7.0;
/// The trunk of the pine, which nobody walks through: its place (x, z) and its radius, m.
const PINE: (Vec2, f32) = (Vec2::new(3.4, -2.6), 0.3);

/// Who walks, and where to.
#[derive(Component)]
struct Character {
    direction: Vec2,
}

fn main() -> ExitCode {
    let course = Course::begin("08_through_the_ferns").picture_after(4.4);
    let mut app = App::new();
    app.add_plugins((course.engine(), WindwoodPlugins))
        .insert_resource(Wind { speed: 2.5, ..default() })
        .add_systems(Startup, (spawn_character, plant, spawn_meadow))
        .add_systems(Update, (walk, follow).chain());
    course.run(&mut app, "arrow keys  steer the character")
}

fn spawn_character(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let red = StandardMaterial { base_color: Color::srgb(0.72, 0.16, 0.10), perceptual_roughness: 0.7, ..default() };
    // The entity is at the middle of the body, 0.9 m above its feet, and so is the capsule that pushes.
    commands.spawn((
        Character { direction: Vec2::X },
        Pusher::default(),
        (Mesh3d(meshes.add(Capsule3d::new(0.3, 1.2))), MeshMaterial3d(materials.add(red))),
        Transform::from_xyz(-TURNS_AT_M, 0.9, 0.0),
    ));
    commands.spawn((Camera3d::default(), Transform::default()));
}

fn plant(mut commands: Commands, assets: Res<AssetServer>, mut plans: ResMut<Assets<ForestPlan>>) {
    let stock = |species: &str, share: f32, age_years: f32| Stock {
        species: species.into(),
        share,
        age_years,
        age_spread_years: 0.3 * age_years,
        ..default()
    };
    let ferns = Area {
        shape: Shape::Rectangle { min_m: [-14.0, -9.0], max_m: [14.0, 1.8] },
        density_per_ha: 14000.0,
        // In groups, and nearly closed.
        pattern: CountModel::NegativeBinomial { k: 3.0 },
        quadrat_m: 2.5,
        least_distance_m: 0.45,
        stock: vec![stock("bracken", 8.0, 4.0), stock("bilberry", 1.0, 8.0)],
        ..default()
    };
    let plan = plans.add(ForestPlan { seed: 2, cell_m: 16.0, areas: vec![ferns], ..default() });
    commands.spawn((Forest::new(plan), ForestSettings { trees_to_m: 40.0, far_to_m: 100.0, ..default() }));
    for (species, seed, age_years, place) in [
        ("scots_pine", 4, 70.0, PINE.0),
        ("hazel", 2, 4.0, Vec2::new(2.2, 0.5)),
        ("birch", 6, 20.0, Vec2::new(-7.5, -6.0)),
        ("norway_spruce", 3, 12.0, Vec2::new(8.0, -7.0)),
        ("beech", 1, 45.0, Vec2::new(-2.5, -14.0)),
    ] {
        let tree = Tree::new(assets.load(format!("species/{species}.species.ron"))).with_seed(seed).with_age(age_years);
        commands.spawn((tree, Transform::from_xyz(place.x, 0.0, place.y)));
    }
}

/// A game has its own way to move a character: whatever it is, the pusher goes where its entity goes.
fn walk(
    time: Res<Time>,
    keys: Res<ButtonInput<KeyCode>>,
    mut characters: Query<(&mut Character, &mut Transform), Without<Camera3d>>,
) {
    let axis = |up, down| f32::from(i8::from(keys.pressed(up)) - i8::from(keys.pressed(down)));
    let wish = Vec2::new(axis(KeyCode::ArrowRight, KeyCode::ArrowLeft), axis(KeyCode::ArrowDown, KeyCode::ArrowUp));
    for (mut character, mut at) in &mut characters {
        let here = at.translation.xz();
        if let Some(wish) = wish.try_normalize() {
            character.direction = wish;
        } else if here.length() > TURNS_AT_M && here.dot(character.direction) > 0.0 {
            character.direction = -here.normalize();
        }
        let mut next = here + character.direction * SPEED_M_S * time.delta_secs();
        let (pine, radius_m) = PINE;
        let least_m = radius_m + 0.3;
        if next.distance(pine) < least_m {
            next = pine + (next - pine).normalize_or(Vec2::X) * least_m;
        }
        at.translation = Vec3::new(next.x, at.translation.y, next.y);
    }
}

/// The camera stays before the character, and looks after it.
fn follow(
    character: Single<&Transform, (With<Character>, Without<Camera3d>)>,
    mut camera: Single<&mut Transform, With<Camera3d>>,
) {
    let at = character.translation;
    **camera =
        Transform::from_xyz(0.7 * at.x + 0.6, 2.3, at.z + 4.8).looking_at(at - Vec3::new(0.5, 0.25, 0.0), Vec3::Y);
}
