//! Lesson 2: a species of your own.
//!
//! A species is a text file, and no code. `assets/course/rowan.species.ron`, which belongs to this lesson, is short: what it leaves out
//! takes its default, which is an oak's. It says how large the crown is and of which shape, how branches leave the trunk, what the wood
//! weighs and how stiff it is, what leaves look like, and when they unfold, turn and fall. How the tree moves follows from this: nobody draws
//! or animates it. Thin wood with large leaves swings slowly, a stout bough hardly at all.
//!
//! Start this lesson, open the file in an editor beside it, change `radius_m: 2.6` to `4.0`, and save. The trees grow anew within a second.
//! (Bevy does this with its feature `file_watcher`.) A slip does no harm: the log names the field, its value and what is allowed, and the
//! last good trees stay.
//!
//! Trees of one species share their models. The file asks for four variants, and each tree is one of these, by its seed. A tree's age is its
//! own: it is grown at steps of a third, so that a wood of all ages has few models.
//!
//! All fields are in `docs/guide/species.md`. The workbench edits them by hand and eye: `cargo run --features editor --example workbench`.

#[path = "../support/mod.rs"]
mod support;

use bevy::{camera_controller::free_camera::FreeCamera, prelude::*};
use bevy_windwood::prelude::*;
use std::process::ExitCode;
use support::course::{Course, spawn_meadow};

/// Relative to `assets`. The ending tells Bevy that it is a species.
const FILE: &str = "course/rowan.species.ron";

/// Ages, years, and places from left to right, m.
const ROW: [(f32, f32); 4] = [(4.0, -5.4), (10.0, -3.2), (22.0, 0.4), (45.0, 5.6)];

fn main() -> ExitCode {
    let course = Course::begin("02_your_species");
    let mut app = App::new();
    app.add_plugins((course.engine(), WindwoodPlugins))
        .insert_resource(Wind { speed: 6.0, ..default() })
        // Berries are not drawn, but early autumn is when a rowan is looked at.
        .insert_resource(Season { year: 0.725 })
        .add_systems(Startup, (plant_a_row, spawn_camera, spawn_meadow))
        .add_systems(Update, (tell_of_the_file, pass_the_year));
    course.run(&mut app, "Space  a month passes")
}

fn plant_a_row(mut commands: Commands, assets: Res<AssetServer>) {
    let rowan: Handle<Species> = assets.load(FILE);
    for (seed, (age_years, x)) in (1..).zip(ROW) {
        commands
            .spawn((Tree::new(rowan.clone()).with_seed(seed).with_age(age_years), Transform::from_xyz(x, 0.0, 0.0)));
    }
}

/// A species is an asset like any other: what happens to its file is told by Bevy's messages, and it can be read.
fn tell_of_the_file(mut files: MessageReader<AssetEvent<Species>>, species: Res<Assets<Species>>) {
    for file in files.read() {
        let (AssetEvent::Added { id } | AssetEvent::Modified { id }) = *file else { continue };
        let Some(species) = species.get(id) else { continue };
        info!(
            "`{}` as it is now: {} variants, mature at {} years",
            species.name, species.variants, species.age.mature_years
        );
    }
}

/// The year goes from 0, midwinter, to 1; it wraps around.
fn pass_the_year(keys: Res<ButtonInput<KeyCode>>, mut season: ResMut<Season>) {
    if keys.just_pressed(KeyCode::Space) {
        season.year += 1.0 / 12.0;
    }
}

fn spawn_camera(mut commands: Commands) {
    let place = Transform::from_xyz(1.0, 1.6, 12.6).looking_at(Vec3::new(0.6, 3.7, 0.0), Vec3::Y);
    commands.spawn((Camera3d::default(), FreeCamera::default(), place));
}
