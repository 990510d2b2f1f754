//! Lesson 6: blast and axe.
//!
//! Until something touches it, a tree is a pure function of time and place: the wind's tables answer for it. Three things touch trees: a wind
//! of your own (`WindSource`: a blast, a rotor, a jet, a vortex), a blow (the message `TreeImpulse`), and a body that pushes (`Pusher`, in
//! lesson 8). A touched tree is woken: its beams get oscillators of the same frequencies and dampings, which add to what the wind does. When
//! they are still it sleeps again. You switch nothing on, and a wood in which nothing happens costs nothing.
//!
//! How far a tree is thrown follows from its wood. An axe of 2 kg at 15 m/s, 30 N s, shakes a young birch to the top; an old oak hardly notices.
//! A blast is over in milliseconds, and so twigs answer it and trunks do not, unless it is large.
//!
//! A tree that is given `FallingTree` hinges at its cut, falls by its own weight against the drag of its crown, and comes to rest. It is your
//! game that decides when it has been struck often enough. In a `Forest` stems are felled by `ForestEditor::fell`, near and far: lesson 7.
//!
//! Here every 12 s a birch is struck four times and felled, a charge goes off, and a new birch stands. X strikes, and B is another charge.

#[path = "../support/mod.rs"]
mod support;

use bevy::{camera_controller::free_camera::FreeCamera, prelude::*};
use bevy_windwood::prelude::*;
use std::process::ExitCode;
use support::course::{Course, spawn_meadow};

/// From one felling to the next, s.
const ROUND_S: f32 = 12.0;
/// Blows, and what follows, after the begin of a round, s.
const BLOWS_S: [f32; 4] = [0.5, 1.2, 1.9, 2.6];
const FELLED_S: f32 = 3.2;
const BLAST_S: f32 = 5.3;
/// Place of the birch.
const BIRCH: Vec3 = Vec3::new(-1.5, 0.0, 0.0);

/// The birch that is struck.
#[derive(Component)]
struct Struck;

/// What goes off.
#[derive(Component)]
struct Charge;

fn main() -> ExitCode {
    let course = Course::begin("06_blast_and_axe").picture_after(f64::from(BLAST_S) + 0.3);
    let mut app = App::new();
    app.add_plugins((course.engine(), WindwoodPlugins))
        .insert_resource(Wind { speed: 3.0, direction: Dir2::X, ..default() })
        .add_systems(Startup, (plant, spawn_camera, spawn_meadow))
        .add_systems(Update, follow_the_clock);
    course.run(&mut app, "X  axe    B  blast")
}

fn plant(mut commands: Commands, assets: Res<AssetServer>) {
    commands.spawn(birch(&assets));
    // 400 kg of TNT, as in a large aerial bomb. A blast blows once; this one is over long since, and blows again when its age is set to 0.
    let charge = WindSource { age_s: 1e6, ..WindSource::new(SourceKind::Blast { charge_kg: 400.0 }) };
    commands.spawn((Charge, charge, Transform::from_xyz(-6.0, 0.5, 5.0)));
    for (species, age_years, x, z) in [
        ("birch", 16.0, 4.5, -1.0),
        ("hazel", 9.0, 7.2, 2.2),
        ("hawthorn", 12.0, -7.0, -3.0),
        ("scots_pine", 40.0, -9.5, -12.0),
        ("birch", 24.0, 9.5, -11.0),
    ] {
        let tree = Tree::new(assets.load(format!("species/{species}.species.ron"))).with_age(age_years);
        commands.spawn((tree, Transform::from_xyz(x, 0.0, z)));
    }
}

fn birch(assets: &AssetServer) -> impl Bundle {
    let birch = Tree::new(assets.load("species/birch.species.ron")).with_seed(3).with_age(14.0);
    (Struck, birch, Transform::from_translation(BIRCH))
}

fn follow_the_clock(
    mut commands: Commands,
    (time, keys): (Res<Time>, Res<ButtonInput<KeyCode>>),
    assets: Res<AssetServer>,
    birches: Query<(Entity, Has<FallingTree>, Has<FallenTree>), With<Struck>>,
    stumps: Query<Entity, With<Stump>>,
    mut charge: Single<&mut WindSource, With<Charge>>,
    mut blows: MessageWriter<TreeImpulse>,
) {
    let now_s = time.elapsed_secs() % ROUND_S;
    let is_now = |moment_s: f32| (now_s - time.delta_secs()..now_s).contains(&moment_s);
    for (tree, falls, has_fallen) in &birches {
        if !falls && (BLOWS_S.into_iter().any(is_now) || keys.just_pressed(KeyCode::KeyX)) {
            blows.write(TreeImpulse { tree, place: BIRCH + Vec3::Y, impulse_n_s: Vec3::new(-30.0, 0.0, 8.0) });
        }
        if !falls && !has_fallen && is_now(FELLED_S) {
            commands.entity(tree).insert(FallingTree { direction: Some(Vec2::new(-1.0, 0.25)), cut_m: 0.5 });
        }
        if has_fallen && is_now(0.0) {
            commands.entity(tree).despawn();
            stumps.iter().for_each(|stump| commands.entity(stump).despawn());
            commands.spawn(birch(&assets));
        }
    }
    if is_now(BLAST_S) || keys.just_pressed(KeyCode::KeyB) {
        charge.age_s = 0.0;
    }
}

fn spawn_camera(mut commands: Commands) {
    let place = Transform::from_xyz(1.0, 1.7, 13.2).looking_at(Vec3::new(0.6, 3.3, 0.0), Vec3::Y);
    commands.spawn((Camera3d::default(), FreeCamera::default(), place));
}
