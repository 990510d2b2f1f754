//! Text and keys of the window, and the wind as arrows.

use crate::{
    scene::ForestScene,
    support::window::{CAMERA_KEYS, StatusText, WIND_KEYS, change_wind, show_status, spawn_text},
};
use bevy::prelude::*;
use bevy_windwood::{prelude::*, wind::WindGizmos};

/// Adds the text, the keys and the arrows.
pub fn plugin(app: &mut App) {
    let keys = format!("{WIND_KEYS}    G  gustiness    H  arrows");
    app.add_systems(Startup, (spawn_text(&[CAMERA_KEYS, &keys]), spawn_wind_cells))
        .add_systems(Update, (change_wind, change_gustiness, show_arrows, show_wind));
    #[cfg(feature = "editor")]
    add_workbench(app);
}

/// F2 opens the workbench over the forest, with the species that has most trees.
#[cfg(feature = "editor")]
fn add_workbench(app: &mut App) {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/species/oak.species.ron");
    app.add_plugins(bevy_windwood::editor::EditorPlugin { file: Some(file.into()), ..default() });
}

/// A grid of wind cells over the forest. They are drawn as arrows.
fn spawn_wind_cells(mut commands: Commands, scene: Res<ForestScene>) {
    for row in -8..=8 {
        for column in -8..=8 {
            let (x, z) = (column as f32 * 16.0, row as f32 * 16.0);
            let ground_m = scene.landscape.height_m(x, z);
            commands.spawn((WindCell::above(ground_m), Transform::from_xyz(x, ground_m + 18.0, z)));
        }
    }
}

fn change_gustiness(keys: Res<ButtonInput<KeyCode>>, mut wind: ResMut<Wind>) {
    if keys.just_pressed(KeyCode::KeyG) {
        wind.gustiness = if wind.gustiness >= 2.0 { 0.0 } else { wind.gustiness + 0.5 };
    }
}

fn show_arrows(keys: Res<ButtonInput<KeyCode>>, mut arrows: ResMut<WindGizmos>) {
    if keys.just_pressed(KeyCode::KeyH) {
        arrows.enabled = !arrows.enabled;
    }
}

fn show_wind(wind: Res<Wind>, active: Res<ActiveWind>, mut text: Single<&mut TextSpan, With<StatusText>>) {
    let state = if active.is_settled() { "" } else { "  (changing)" };
    show_status(&mut text, format!("wind {:.0} m/s, gustiness {:.1}{state}", wind.speed, wind.gustiness));
}
