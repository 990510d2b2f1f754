//! Text of the window, and a camera that stays above the ground.

use crate::{
    scene::TerrainScene,
    support::window::{CAMERA_KEYS, StatusText, show_status, spawn_text},
};
use bevy::prelude::*;
use bevy_windwood::{forest::ForestImpostors, prelude::*, terrain::TerrainChunks};

/// Adds the text, and keeps the camera above the ground.
pub fn plugin(app: &mut App) {
    app.add_systems(Startup, spawn_text(&[CAMERA_KEYS])).add_systems(Update, (keep_above_ground, show_counts));
}

fn keep_above_ground(scene: Res<TerrainScene>, mut camera: Single<&mut Transform, With<Camera3d>>) {
    let at = camera.translation;
    let lowest_m = scene.landscape.height_m(at.x, at.z) + 1.7;
    if at.y < lowest_m {
        camera.translation.y = lowest_m;
    }
}

fn show_counts(
    camera: Single<&Transform, With<Camera3d>>,
    chunks: Query<&TerrainChunks>,
    trees: Query<(), With<Tree>>,
    far: Query<&ForestImpostors>,
    mut text: Single<&mut TextSpan, With<StatusText>>,
) {
    let height_m = camera.translation.y;
    let chunks: usize = chunks.iter().map(TerrainChunks::drawn).sum();
    let (trees, far): (usize, usize) = (trees.count(), far.iter().map(ForestImpostors::trees).sum());
    show_status(
        &mut text,
        format!("{height_m:.0} m above sea level    {chunks} chunks    {trees} trees, {far} as impostors"),
    );
}
