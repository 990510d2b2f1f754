//! Lesson 5: storm and seasons.
//!
//! Two resources are the weather. `Season` is the time of the year, from 0, midwinter, to 1. It is yours to run: a calendar, a slider, a jump.
//! Each species' file says when its leaves unfold, turn and fall. They do so in patches, each tree some days before its neighbour
//! (`Tree::season_days`), and with the leaves goes most of what the wind can hold on to: in winter the same gale sways a birch far less.
//!
//! `Wind` is the other. `speed` is the mean at a height of 10 m; how it grows with height, how strong gusts are and how large, follows from
//! the measured spectra over ground of that roughness. A change does not jump: the next wind is made in the background (a second or two),
//! and fades in over `fade_s`. Both a tree's lean and its swinging follow: drag grows with less than the square of the speed, as leaves and
//! twigs give way, and beams saturate, so that a hurricane does not break the picture.
//!
//! Here a minute is a year, and every quarter of it a front passes. Look how the larch, a conifer, turns yellow too, and how the spruce does
//! not. What else belongs to weather, rain or the colour of the light, is your game's.

#[path = "../support/mod.rs"]
mod support;

use bevy::{camera_controller::free_camera::FreeCamera, prelude::*};
use bevy_windwood::prelude::*;
use std::process::ExitCode;
use support::course::{Course, spawn_meadow};

/// A year lasts so long, s.
const YEAR_S: f32 = 60.0;
/// Mean wind before and behind a front, m/s.
const BREEZE_M_S: f32 = 4.0;
const STORM_M_S: f32 = 19.0;

/// Species, age in years, and place (x, z), m.
const WOOD: [(&str, f32, f32, f32); 7] = [
    ("maple", 40.0, -9.5, -2.0),
    ("birch", 25.0, -3.2, 1.5),
    ("norway_spruce", 35.0, 0.8, -6.5),
    ("larch", 35.0, 5.0, -1.5),
    ("beech", 60.0, 12.0, -5.0),
    ("poplar", 30.0, -5.5, -14.0),
    ("hazel", 10.0, 9.4, 3.5),
];

fn main() -> ExitCode {
    let course = Course::begin("05_storm_and_seasons");
    let mut app = App::new();
    app.add_plugins((course.engine(), WindwoodPlugins))
        // October, in the first storm of the autumn.
        .insert_resource(Season { year: 0.79 })
        .insert_resource(Wind { speed: STORM_M_S, direction: Dir2::X, fade_s: 3.0, ..default() })
        .add_systems(Startup, (plant, spawn_camera, spawn_meadow))
        .add_systems(Update, (pass_the_year, change_the_weather));
    course.run(&mut app, "Space  stops and runs the year")
}

fn plant(mut commands: Commands, assets: Res<AssetServer>) {
    for (number, (species, age_years, x, z)) in (0_u8..).zip(WOOD) {
        let species = assets.load(format!("species/{species}.species.ron"));
        // Some are up to nine days ahead of the others.
        let tree = Tree::new(species).with_age(age_years).with_season(f32::from(number % 4) * 3.0);
        commands.spawn((tree, Transform::from_xyz(x, 0.0, z)));
    }
}

fn pass_the_year(
    time: Res<Time>,
    keys: Res<ButtonInput<KeyCode>>,
    mut is_stopped: Local<bool>,
    mut season: ResMut<Season>,
) {
    *is_stopped ^= keys.just_pressed(KeyCode::Space);
    if !*is_stopped {
        season.year += time.delta_secs() / YEAR_S;
    }
}

/// Only a change that is asked for makes a new wind: writing the same speed again would not, but it is good manners not to.
fn change_the_weather(time: Res<Time>, mut wind: ResMut<Wind>) {
    let quarters = (time.elapsed_secs() / (0.25 * YEAR_S)) as u32;
    let speed = if quarters.is_multiple_of(2) { STORM_M_S } else { BREEZE_M_S };
    if wind.speed != speed {
        wind.speed = speed;
        // A front turns the wind as well.
        wind.direction = Rot2::degrees(-25.0) * wind.direction;
        info!("the wind changes to {speed} m/s");
    }
}

fn spawn_camera(mut commands: Commands) {
    let place = Transform::from_xyz(0.0, 2.0, 24.0).looking_at(Vec3::new(0.6, 6.0, 0.0), Vec3::Y);
    commands.spawn((Camera3d::default(), FreeCamera::default(), place));
}
