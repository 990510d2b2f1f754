//! The window: a camera to fly, and a text that says how and what is drawn.

use crate::scene::{Setting, camera_transform, haze};
use bevy::{
    camera_controller::free_camera::{FreeCamera, FreeCameraPlugin},
    prelude::*,
};
use bevy_windwood::{forest::FarBlocks, prelude::*, terrain::TerrainChunks};

/// Adds the camera, its keys and the text.
pub fn plugin(app: &mut App) {
    app.add_plugins(FreeCameraPlugin)
        .add_systems(Startup, (spawn_camera, spawn_text))
        .add_systems(Update, (keep_above_ground, tell));
}

fn spawn_camera(mut commands: Commands, setting: Res<Setting>) {
    commands.spawn((
        Camera3d::default(),
        Projection::Perspective(PerspectiveProjection { far: 100_000.0, ..default() }),
        camera_transform(&setting),
        FreeCamera { walk_speed: 20.0, run_speed: 400.0, ..default() },
        haze(),
    ));
}

/// Nobody flies through a mountain.
fn keep_above_ground(setting: Res<Setting>, mut camera: Single<&mut Transform, With<Camera3d>>) {
    let at = camera.translation;
    let lowest = setting.ground.height_m(at.x, at.z) + 1.7;
    if at.y < lowest {
        camera.translation.y = lowest;
    }
}

#[derive(Component)]
struct Told;

fn spawn_text(mut commands: Commands) {
    let font = || TextFont { font_size: FontSize::Px(15.0), ..default() };
    commands
        .spawn((
            Text::new("W A S D  fly    Q E  down, up    Shift  fast    right mouse  look\n"),
            font(),
            Node { position_type: PositionType::Absolute, left: px(12), top: px(10), ..default() },
        ))
        .with_child((TextSpan::default(), font(), Told));
}

fn tell(
    camera: Single<&Transform, With<Camera3d>>,
    chunks: Query<&TerrainChunks>,
    trees: Query<(), With<Tree>>,
    far: Query<&FarBlocks>,
    mut text: Single<&mut TextSpan, With<Told>>,
) {
    let drawn: usize = chunks.iter().map(TerrainChunks::drawn).sum();
    let far: usize = far.iter().map(FarBlocks::trees).sum();
    let told =
        format!("{:.0} m above the sea    {drawn} chunks    {} trees, {far} far", camera.translation.y, trees.count());
    if text.0 != told {
        text.0 = told;
    }
}
