//! The window: a camera to fly, keys for the wind and the fire, and a text that says so.

use crate::scene::{Setting, camera_transform, haze};
use bevy::{
    camera_controller::free_camera::{FreeCamera, FreeCameraPlugin},
    prelude::*,
};
use bevy_windwood::prelude::*;

/// Adds the camera, the keys and the help text.
pub fn plugin(app: &mut App) {
    app.add_plugins(FreeCameraPlugin)
        .add_systems(Startup, (spawn_camera, spawn_help))
        .add_systems(Update, (change_wind, feed_fire));
}

fn spawn_camera(mut commands: Commands, setting: Res<Setting>) {
    commands.spawn((
        Camera3d::default(),
        camera_transform(&setting),
        FreeCamera { walk_speed: 4.0, run_speed: 16.0, ..default() },
        haze(),
    ));
}

fn spawn_help(mut commands: Commands) {
    let help = "W A S D  fly    Q E  down, up    Shift  faster    right mouse  look\n\
                Up Down  wind speed    Left Right  wind direction    F  feed the fire";
    commands.spawn((
        Text::new(help),
        TextFont { font_size: FontSize::Px(15.0), ..default() },
        Node { position_type: PositionType::Absolute, left: px(12), top: px(10), ..default() },
    ));
}

/// Speed steps of 1 m/s, direction steps of 15 degrees. A new wind is built in the background and fades in.
fn change_wind(keys: Res<ButtonInput<KeyCode>>, mut wind: ResMut<Wind>) {
    let pressed = |key| keys.just_pressed(key);
    let faster = f32::from(i8::from(pressed(KeyCode::ArrowUp)) - i8::from(pressed(KeyCode::ArrowDown)));
    if faster != 0.0 {
        wind.speed = (wind.speed + faster).clamp(0.0, 40.0);
    }
    let veer = f32::from(i8::from(pressed(KeyCode::ArrowRight)) - i8::from(pressed(KeyCode::ArrowLeft)));
    if veer != 0.0 {
        wind.direction = Rot2::degrees(15.0 * veer) * wind.direction;
    }
}

/// The fire grows by a quarter, and starts small again.
fn feed_fire(keys: Res<ButtonInput<KeyCode>>, mut fires: Query<&mut Fire>) {
    const SMALL_M: f32 = 0.4;
    const LARGE_M: f32 = 1.6;
    if !keys.just_pressed(KeyCode::KeyF) {
        return;
    }
    for mut fire in &mut fires {
        let grown = if fire.shape.size_m > LARGE_M { SMALL_M } else { 1.25 * fire.shape.size_m };
        let share = grown / fire.shape.size_m;
        fire.shape.size_m = grown;
        fire.shape.threshold_m *= share;
        fire.look.light_lm *= share * share;
    }
}
