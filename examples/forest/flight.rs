//! The window: a camera to fly, keys for the wind, and a text that says so.

use crate::scene::{Setting, camera_transform, haze};
use bevy::{
    camera_controller::free_camera::{FreeCamera, FreeCameraPlugin},
    prelude::*,
};
use bevy_windwood::{prelude::*, wind::WindGizmos};

/// Adds the camera, the keys and the help text.
pub fn plugin(app: &mut App) {
    app.add_plugins(FreeCameraPlugin)
        .add_systems(Startup, (spawn_camera, spawn_help, spawn_wind_cells))
        .add_systems(Update, (change_wind, tell_wind));
}

fn spawn_camera(mut commands: Commands, setting: Res<Setting>) {
    commands.spawn((
        Camera3d::default(),
        Projection::Perspective(PerspectiveProjection { far: 60_000.0, ..default() }),
        camera_transform(&setting),
        FreeCamera { walk_speed: 12.0, run_speed: 60.0, ..default() },
        haze(),
    ));
}

/// A raster of cells over the wood, drawn as arrows when they are asked for.
fn spawn_wind_cells(mut commands: Commands, setting: Res<Setting>) {
    for row in -8..=8 {
        for column in -8..=8 {
            let (x, z) = (column as f32 * 16.0, row as f32 * 16.0);
            let ground_m = setting.ground.height_m(x, z);
            commands.spawn((WindCell::above(ground_m), Transform::from_xyz(x, ground_m + 18.0, z)));
        }
    }
}

#[derive(Component)]
struct WindText;

fn spawn_help(mut commands: Commands) {
    let help = "W A S D  fly    Q E  down, up    Shift  faster    right mouse  look\n\
                Up Down  wind speed    Left Right  wind direction    G  gustiness    H  arrows\n";
    commands
        .spawn((
            Text::new(help),
            TextFont { font_size: FontSize::Px(15.0), ..default() },
            Node { position_type: PositionType::Absolute, left: px(12), top: px(10), ..default() },
        ))
        .with_child((TextSpan::default(), TextFont { font_size: FontSize::Px(15.0), ..default() }, WindText));
}

/// Speed steps of 1 m/s, direction steps of 15 degrees. A new wind is built in the background and fades in.
fn change_wind(keys: Res<ButtonInput<KeyCode>>, mut wind: ResMut<Wind>, mut arrows: ResMut<WindGizmos>) {
    let pressed = |key| keys.just_pressed(key);
    let faster = f32::from(i8::from(pressed(KeyCode::ArrowUp)) - i8::from(pressed(KeyCode::ArrowDown)));
    if faster != 0.0 {
        wind.speed = (wind.speed + faster).clamp(0.0, 40.0);
    }
    let veer = f32::from(i8::from(pressed(KeyCode::ArrowRight)) - i8::from(pressed(KeyCode::ArrowLeft)));
    if veer != 0.0 {
        wind.direction = Rot2::degrees(15.0 * veer) * wind.direction;
    }
    if pressed(KeyCode::KeyG) {
        wind.gustiness = if wind.gustiness >= 2.0 { 0.0 } else { wind.gustiness + 0.5 };
    }
    if pressed(KeyCode::KeyH) {
        arrows.enabled = !arrows.enabled;
    }
}

fn tell_wind(wind: Res<Wind>, active: Res<ActiveWind>, mut text: Single<&mut TextSpan, With<WindText>>) {
    if wind.is_changed() || active.is_changed() {
        let state = if active.is_settled() { "" } else { "  (changing)" };
        text.0 = format!("wind {:.0} m/s, gustiness {:.1}{state}", wind.speed, wind.gustiness);
    }
}
