//! Lesson 1: a tree that stands in the wind.
//!
//! A tree is an entity with a `Tree` component, at the place of its `Transform`. That is all. The component names a species, which is a file
//! (here `assets/species/oak.species.ron`); the file is loaded and a few individuals of the species are grown in the background, a second or
//! so. Then the entity gets a `Grown` component, and is drawn.
//!
//! The wind is the resource `Wind`: a mean speed 10 m above the ground, and a direction. It is no single number that swings to and fro, but a
//! field of turbulence with the spectra that were measured over land, and so gusts come over the meadow from one side, and reach one tree
//! after another. Change the resource at any time: the next wind is made in the background, and the two fade into each other.
//!
//! Every branch is a beam that bends and rings in this wind at its own frequencies. This costs the CPU nothing per tree: the answers to all
//! frequencies stand in a table, and the GPU reads it.
//!
//! `WindwoodPlugins` goes after Bevy's `DefaultPlugins`. (Here `course.engine()` stands for these: in a window they are what they always are.
//! Without a display there is no window, and a picture is written.)

#[path = "../support/mod.rs"]
mod support;

use bevy::{camera_controller::free_camera::FreeCamera, prelude::*};
use bevy_windwood::prelude::*;
use std::process::ExitCode;
use support::course::{Course, spawn_meadow};

fn main() -> ExitCode {
    let course = Course::begin("01_a_tree");
    let mut app = App::new();
    app.add_plugins((course.engine(), WindwoodPlugins))
        // A fresh breeze from the left.
        .insert_resource(Wind { speed: 9.0, direction: Dir2::X, ..default() })
        .add_systems(Startup, (plant, spawn_camera, spawn_meadow))
        .add_systems(Update, (welcome, change_the_wind));
    course.run(&mut app, "1 calm    2 breeze    3 gale")
}

fn plant(mut commands: Commands, assets: Res<AssetServer>) {
    // As old as the species is when it is mature. Which individual stands here follows from its place.
    commands.spawn((Tree::new(assets.load("species/oak.species.ron")), Transform::from_xyz(-3.0, 0.0, -4.0)));
    // What follows from the place, or from the species, can also be said: another seed is another individual.
    let birch = Tree::new(assets.load("species/birch.species.ron")).with_seed(5).with_age(18.0);
    commands.spawn((birch, Transform::from_xyz(8.5, 0.0, 0.5)));
}

/// A tree can be used as soon as it is spawned. When it has its model, it is told like this.
fn welcome(grown: Query<(Entity, &Transform), Added<Grown>>) {
    for (tree, at) in &grown {
        info!("tree {tree} stands at {}", at.translation);
    }
}

fn change_the_wind(keys: Res<ButtonInput<KeyCode>>, mut wind: ResMut<Wind>) {
    for (key, speed) in [(KeyCode::Digit1, 1.5), (KeyCode::Digit2, 9.0), (KeyCode::Digit3, 20.0)] {
        if keys.just_pressed(key) {
            wind.speed = speed;
        }
    }
}

fn spawn_camera(mut commands: Commands) {
    let place = Transform::from_xyz(4.0, 1.7, 17.5).looking_at(Vec3::new(1.4, 6.0, 0.0), Vec3::Y);
    commands.spawn((Camera3d::default(), FreeCamera::default(), place));
}
