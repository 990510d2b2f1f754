//! Text and keys of the window.

use crate::{
    actors::Ask,
    support::window::{CAMERA_KEYS, WIND_KEYS, change_wind, spawn_text},
};
use bevy::prelude::*;

/// Adds the text and the keys.
pub fn plugin(app: &mut App) {
    let keys = format!("{WIND_KEYS}    B  blast    X  axe");
    app.add_systems(Startup, spawn_text(&[CAMERA_KEYS, &keys])).add_systems(Update, (change_wind, ask));
}

fn ask(keys: Res<ButtonInput<KeyCode>>, mut asks: MessageWriter<Ask>) {
    for (key, wish) in [(KeyCode::KeyB, Ask::Blast), (KeyCode::KeyX, Ask::Strike)] {
        if keys.just_pressed(key) {
            asks.write(wish);
        }
    }
}
