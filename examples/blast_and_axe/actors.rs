//! Who does something: each is an entity with a component or a message of the crate's.

use crate::{options::Event, scene::BlastScene};
use bevy::prelude::*;
use bevy_windwood::prelude::*;

/// Where the charge lies, m.
const CHARGE: Vec3 = Vec3::new(-14.0, 0.5, 2.0);
/// Mass of TNT. Less would move the leaves, and hardly the stem.
const CHARGE_KG: f32 = 600.0;
/// Radius of the ball, m, its speed, m/s, and how far it goes to either side, m.
const BALL_M: f32 = 0.7;
const BALL_M_S: f32 = 3.0;
const BALL_WAY_M: f32 = 5.0;
/// Middle of the ball's way: through the meadow, and the side of the hazel.
const BALL_MIDDLE: Vec3 = Vec3::new(1.2, BALL_M, 6.5);
/// A light helicopter: radius of its rotor, m, weight, N, and height, m.
const ROTOR_M: f32 = 4.0;
const WEIGHT_N: f32 = 8000.0;
const ROTOR_HEIGHT_M: f32 = 7.0;
/// The birch is struck so often, s.
const STROKE_S: f64 = 1.4;

/// The tree that is struck.
#[derive(Component)]
pub struct Struck;

/// The ball.
#[derive(Component)]
pub struct Ball;

/// What the window's keys ask for.
#[derive(Message, Clone, Copy, PartialEq, Eq)]
pub enum Ask {
    Blast,
    Strike,
}

/// Spawns the ball and the rotor, where they are wanted.
pub fn spawn_actors(
    mut commands: Commands,
    scene: Res<BlastScene>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let mut matt = |base_color: Color| {
        materials.add(StandardMaterial { base_color, perceptual_roughness: 0.6, reflectance: 0.3, ..default() })
    };
    if scene.shows(Event::Ball) {
        let ball = meshes.add(Sphere::new(BALL_M).mesh().uv(48, 32));
        let red = matt(Color::srgb(0.75, 0.16, 0.10));
        commands.spawn((
            Ball,
            // As heavy as it looks: it presses with half a man's weight.
            Pusher { force_n: 400.0, ..Pusher::sphere(BALL_M) },
            (Mesh3d(ball), MeshMaterial3d(red)),
            Transform::from_translation(BALL_MIDDLE),
        ));
    }
    if scene.shows(Event::Helicopter) {
        let kind = SourceKind::Downwash { rotor_radius_m: ROTOR_M, thrust_n: WEIGHT_N, ground_m: 0.0 };
        let disc = meshes.add(Cylinder::new(ROTOR_M, 0.05).mesh().resolution(64));
        let glass = materials.add(StandardMaterial {
            base_color: Color::srgba(0.1, 0.1, 0.12, 0.35),
            alpha_mode: AlphaMode::Blend,
            ..default()
        });
        commands.spawn((
            WindSource::new(kind),
            (Mesh3d(disc), MeshMaterial3d(glass), bevy::light::NotShadowCaster),
            Transform::from_xyz(0.0, ROTOR_HEIGHT_M, 5.0),
        ));
    }
}

/// Asks for what pictures show, shortly after the first of them.
pub fn follow_script(
    scene: Res<BlastScene>,
    clock: Res<WindClock>,
    mut asks: MessageWriter<Ask>,
    mut done: Local<u32>,
) {
    let elapsed_s = clock.time_s - scene.options.scene.series.start;
    if !scene.options.scene.image.headless || clock.time_s == clock.previous_s || elapsed_s <= 0.0 {
        return;
    }
    let (ask, due) = match scene.options.event {
        Event::Blast => (Ask::Blast, 1),
        Event::Axe => (Ask::Strike, 1 + (elapsed_s / STROKE_S) as u32),
        Event::Ball | Event::Helicopter => return,
    };
    if *done < due {
        *done += 1;
        asks.write(ask);
    }
}

/// Sets off the charge, and strikes the tree.
pub fn act(
    mut commands: Commands,
    mut asks: MessageReader<Ask>,
    mut blows: MessageWriter<TreeImpulse>,
    struck: Query<(Entity, &Transform), With<Struck>>,
) {
    for ask in asks.read() {
        match ask {
            Ask::Blast => {
                let blast = WindSource::new(SourceKind::Blast { charge_kg: CHARGE_KG });
                commands.spawn((blast, Transform::from_translation(CHARGE)));
            }
            Ask::Strike => {
                // An axe of 2 kg at 15 m/s, at the height of the hip.
                let blow = |(tree, at): (Entity, &Transform)| TreeImpulse {
                    tree,
                    place: at.translation + Vec3::Y,
                    impulse_n_s: Vec3::new(30.0, 0.0, 0.0),
                };
                blows.write_batch(struck.iter().map(blow));
            }
        }
    }
}

/// The ball rolls to and fro.
pub fn roll_ball(scene: Res<BlastScene>, clock: Res<WindClock>, mut balls: Query<&mut Transform, With<Ball>>) {
    let elapsed_s = (clock.time_s - scene.options.scene.series.start).max(0.0) as f32;
    let way_m = (BALL_M_S * elapsed_s) % (4.0 * BALL_WAY_M);
    let x = if way_m < 2.0 * BALL_WAY_M { way_m - BALL_WAY_M } else { 3.0 * BALL_WAY_M - way_m };
    for mut ball in &mut balls {
        ball.translation = BALL_MIDDLE + Vec3::X * x;
        ball.rotation = Quat::from_rotation_z(-x / BALL_M);
    }
}
