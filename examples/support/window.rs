//! The window: a camera to fly, text in a corner, keys for the wind.

use super::{capture::FAR_M, scene::Scene};
use bevy::{
    camera_controller::free_camera::{FreeCamera, FreeCameraPlugin},
    prelude::*,
};
use bevy_windwood::prelude::*;

/// Help for the keys of the camera.
pub const CAMERA_KEYS: &str = "W A S D  fly    Q E  down, up    Shift  faster    right mouse  look";
/// Help for the keys of [`change_wind`].
pub const WIND_KEYS: &str = "Up Down  wind speed    Left Right  wind direction";

/// The part of the text that changes.
#[derive(Component)]
pub struct StatusText;

/// Adds the camera of a scene.
pub fn plugin<S: Scene>(app: &mut App) {
    app.add_plugins(FreeCameraPlugin).add_systems(Startup, spawn_camera::<S>);
}

fn spawn_camera<S: Scene>(mut commands: Commands, scene: Res<S>) {
    let [walk_speed, run_speed] = S::SPEEDS_M_S;
    commands.spawn((
        Camera3d::default(),
        Projection::Perspective(PerspectiveProjection { far: FAR_M, ..default() }),
        scene.camera_transform(),
        FreeCamera { walk_speed, run_speed, ..default() },
        scene.camera_effects(),
    ));
}

/// A system that spawns the text: lines that stay, and below them [`StatusText`].
pub fn spawn_text(lines: &[&str]) -> impl FnMut(Commands) + use<> {
    let lines: String = lines.iter().flat_map(|line| [*line, "\n"]).collect();
    move |mut commands: Commands| {
        let font = || TextFont { font_size: FontSize::Px(15.0), ..default() };
        let corner = Node { position_type: PositionType::Absolute, left: px(12), top: px(10), ..default() };
        commands.spawn((Text::new(&lines), font(), corner)).with_child((TextSpan::default(), font(), StatusText));
    }
}

/// Shows a status. Text that has not changed is not laid out again.
pub fn show_status(span: &mut Mut<TextSpan>, status: String) {
    if span.0 != status {
        span.0 = status;
    }
}

/// Steps of 1 m/s and of 15 degrees. A new wind is synthesised in the background and fades in.
pub fn change_wind(keys: Res<ButtonInput<KeyCode>>, mut wind: ResMut<Wind>) {
    let step = |up, down| f32::from(i8::from(keys.just_pressed(up)) - i8::from(keys.just_pressed(down)));
    let faster = step(KeyCode::ArrowUp, KeyCode::ArrowDown);
    if faster != 0.0 {
        wind.speed = (wind.speed + faster).clamp(0.0, 40.0);
    }
    let turn = step(KeyCode::ArrowRight, KeyCode::ArrowLeft);
    if turn != 0.0 {
        wind.direction = Rot2::degrees(15.0 * turn) * wind.direction;
    }
}
