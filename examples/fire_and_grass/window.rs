//! Text and keys of the window.

use crate::support::window::{CAMERA_KEYS, WIND_KEYS, change_wind, spawn_text};
use bevy::prelude::*;
use bevy_windwood::prelude::*;

/// Adds the text and the keys.
pub fn plugin(app: &mut App) {
    let keys = format!("{WIND_KEYS}    F  feed the fire");
    app.add_systems(Startup, spawn_text(&[CAMERA_KEYS, &keys])).add_systems(Update, (change_wind, feed_fire));
}

/// The fire grows by a quarter. After the largest it starts small again.
fn feed_fire(keys: Res<ButtonInput<KeyCode>>, mut fires: Query<&mut Fire>) {
    const SMALL_M: f32 = 0.4;
    const LARGE_M: f32 = 1.6;
    if !keys.just_pressed(KeyCode::KeyF) {
        return;
    }
    for mut fire in &mut fires {
        let size_m = if fire.shape.size_m > LARGE_M { SMALL_M } else { 1.25 * fire.shape.size_m };
        let growth = size_m / fire.shape.size_m;
        fire.shape.size_m = size_m;
        fire.shape.threshold_m *= growth;
        fire.look.light_lm *= growth * growth;
    }
}
