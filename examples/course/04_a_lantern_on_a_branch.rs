//! Lesson 4: a lantern that hangs on a branch.
//!
//! Branches are bent on the GPU, and so no entity knows where they are. A tree that is `Articulated` is posed on the CPU as well, by the same
//! formulas: each of its beams becomes an entity, a `Beam`, whose `Transform` rides on the branch, with +Y along it. `deepest_order: 1` asks
//! for the trunk and the boughs that leave it, and no more; it costs work for every such beam in every frame, so give it to the trees that
//! need it.
//!
//! What is fixed to a branch, such as a nest or a sign, is simply a child of the beam. What hangs from it is not: a lantern keeps upright,
//! and swings after the bough when this moves. So here it is an entity of its own, with a component that names its beam, and one system:
//! a pendulum whose point of suspension is where the beam is now. The system runs after `WindwoodSystems::Pose`, when beams are where they
//! will be drawn in this frame.
//!
//! Which bough? `Beam::index` is the index of its beam in the model's skeleton, where the shape of the tree at rest can be read: this lesson
//! looks for a low bough that reaches towards the viewer. `Beam::at` says where on the beam it rides, from its root, 0, to its tip, 1.
//!
//! Blow at it: key 1 is a breeze, key 2 half a gale, and B a blast of 200 kg of TNT 15 m away.

#[path = "../support/mod.rs"]
mod support;

use bevy::{camera_controller::free_camera::FreeCamera, light::NotShadowCaster, prelude::*};
use bevy_windwood::{prelude::*, tree::TreeModel};
use std::process::ExitCode;
use support::course::{Course, spawn_meadow};

/// Distance from the bough to the middle of the lantern, m.
const CHAIN_M: f32 = 0.55;

/// Hangs from a beam.
#[derive(Component)]
struct HangsFrom {
    beam: Entity,
    velocity: Vec3,
}

fn main() -> ExitCode {
    let course = Course::begin("04_a_lantern_on_a_branch").in_the_evening().picture_after(2.0);
    let mut app = App::new();
    app.add_plugins((course.engine(), WindwoodPlugins))
        .insert_resource(Wind { speed: 6.0, direction: Dir2::X, ..default() })
        .add_systems(Startup, (plant, spawn_camera, spawn_meadow))
        .add_systems(Update, (hang_a_lantern, blow))
        .add_systems(PostUpdate, swing.after(WindwoodSystems::Pose).before(TransformSystems::Propagate));
    course.run(&mut app, "1 breeze    2 half a gale    B blast")
}

fn plant(mut commands: Commands, assets: Res<AssetServer>) {
    let oak = Tree::new(assets.load("species/oak.species.ron")).with_seed(2);
    commands.spawn((oak, Articulated { deepest_order: 1, leaves: false }, Transform::default()));
}

/// Runs once: when the tree has its model, all of its beams are spawned.
fn hang_a_lantern(
    mut commands: Commands,
    new: Query<(Entity, &Beam, &BeamOf), Added<Beam>>,
    trees: Query<&Grown>,
    models: Res<Assets<TreeModel>>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    // The farther a bough's tip reaches towards the viewer, the better, if one can hang a lantern there from a ladder.
    let reach_m = |(_, beam, of): &(Entity, &Beam, &BeamOf)| {
        let model = models.get(&trees.get(of.0).ok()?.model)?;
        let bough = &model.skeleton.beams[beam.index as usize];
        let tip = bough.path(1.0);
        (bough.order == 1 && (2.4..4.0).contains(&tip.y)).then_some(tip.z + 0.5 * tip.x)
    };
    let found = new.iter().max_by(|a, b| reach_m(a).unwrap_or(f32::MIN).total_cmp(&reach_m(b).unwrap_or(f32::MIN)));
    let Some((beam, ..)) = found else { return };
    let glass = StandardMaterial { emissive: LinearRgba::rgb(6.0, 2.6, 0.7), ..default() };
    let iron = StandardMaterial { base_color: Color::srgb(0.05, 0.05, 0.06), perceptual_roughness: 0.6, ..default() };
    let iron = MeshMaterial3d(materials.add(iron));
    let lantern =
        commands.spawn((HangsFrom { beam, velocity: Vec3::ZERO }, Transform::default(), Visibility::default()));
    let lantern = lantern.id();
    let part = |mesh, y: f32| (Mesh3d(mesh), Transform::from_xyz(0.0, y, 0.0), ChildOf(lantern), NotShadowCaster);
    commands.spawn((part(meshes.add(Cylinder::new(0.075, 0.19)), 0.0), MeshMaterial3d(materials.add(glass))));
    commands.spawn((part(meshes.add(Cylinder::new(0.10, 0.03)), -0.11), iron.clone()));
    commands.spawn((part(meshes.add(Cone::new(0.13, 0.10)), 0.15), iron.clone()));
    commands.spawn((part(meshes.add(Cylinder::new(0.006, CHAIN_M - 0.15)), 0.5 * (CHAIN_M + 0.15)), iron));
    let light = PointLight { color: Color::srgb(1.0, 0.72, 0.42), intensity: 30_000.0, range: 25.0, ..default() };
    commands.spawn((light, ChildOf(lantern)));
}

/// A pendulum below its beam: it falls, is braked by the air, and is held at the length of its chain.
fn swing(
    time: Res<Time>,
    beams: Query<&Transform, (With<Beam>, Without<HangsFrom>)>,
    mut lanterns: Query<(&mut HangsFrom, &mut Transform)>,
) {
    let step_s = time.delta_secs();
    for (mut hangs, mut at) in &mut lanterns {
        let Ok(bough) = beams.get(hangs.beam) else { continue };
        let before = at.translation;
        let fallen = before + hangs.velocity * step_s + Vec3::NEG_Y * (9.81 * step_s * step_s);
        let down = (fallen - bough.translation).try_normalize().filter(|_| step_s > 0.0).unwrap_or(Vec3::NEG_Y);
        at.translation = bough.translation + down * CHAIN_M;
        at.rotation = Quat::from_rotation_arc(Vec3::NEG_Y, down);
        let is_new = step_s == 0.0 || before == Vec3::ZERO;
        hangs.velocity = if is_new { Vec3::ZERO } else { (at.translation - before) / step_s * (-0.4 * step_s).exp() };
    }
}

fn blow(mut commands: Commands, keys: Res<ButtonInput<KeyCode>>, mut wind: ResMut<Wind>) {
    for (key, speed) in [(KeyCode::Digit1, 6.0), (KeyCode::Digit2, 16.0)] {
        if keys.just_pressed(key) {
            wind.speed = speed;
        }
    }
    if keys.just_pressed(KeyCode::KeyB) {
        let blast = WindSource::new(SourceKind::Blast { charge_kg: 200.0 });
        commands.spawn((blast, Transform::from_xyz(-15.0, 1.0, 0.0)));
    }
}

fn spawn_camera(mut commands: Commands) {
    let place = Transform::from_xyz(1.6, 1.6, 8.4).looking_at(Vec3::new(-0.9, 2.9, 0.0), Vec3::Y);
    commands.spawn((Camera3d::default(), FreeCamera::default(), place));
}
