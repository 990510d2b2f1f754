//! The window: one tree, and keys that change its species, its age and the season.

use crate::{
    options::Options,
    studio::{Subject, camera_transform, projection},
    support::window::{CAMERA_KEYS, StatusText, show_status, spawn_text},
};
use bevy::{
    camera_controller::free_camera::{FreeCamera, FreeCameraPlugin},
    prelude::*,
};
use bevy_windwood::prelude::*;

/// The species and the age that are shown: places in their lists.
#[derive(Resource)]
struct Selection {
    species: usize,
    age: usize,
}

/// Ages to choose from, as shares of the mature age.
const AGES: [f32; 7] = [0.05, 0.1, 0.2, 0.45, 1.0, 1.4, 2.0];
/// How far a press of space moves the year.
const SEASON_STEP: f32 = 1.0 / 24.0;
const TREE_KEYS: &str = "Left Right  species    Up Down  age    Space  season";

/// Adds the camera, the keys and the text.
pub fn plugin(app: &mut App) {
    app.add_plugins(FreeCameraPlugin)
        .insert_resource(Selection { species: 0, age: 4 })
        .add_systems(Startup, (spawn_camera, spawn_text(&[CAMERA_KEYS, TREE_KEYS])))
        .add_systems(Update, (select, spawn_tree.run_if(resource_changed::<Selection>), (set_age, show_tree)).chain());
}

fn spawn_camera(mut commands: Commands) {
    let view = camera_transform(Subject::Whole, 16.0, 14.0, 1.4);
    commands.spawn((Camera3d::default(), FreeCamera::default(), projection(), view));
}

fn select(
    keys: Res<ButtonInput<KeyCode>>,
    options: Res<Options>,
    mut season: ResMut<Season>,
    mut selection: ResMut<Selection>,
) {
    let pressed = |key| usize::from(keys.just_pressed(key));
    let (left, right) = (pressed(KeyCode::ArrowLeft), pressed(KeyCode::ArrowRight));
    let (down, up) = (pressed(KeyCode::ArrowDown), pressed(KeyCode::ArrowUp));
    if left + right + up + down > 0 {
        let count = options.species.len();
        selection.species = (selection.species + right + (count - 1) * left) % count;
        selection.age = (selection.age + up).saturating_sub(down).min(AGES.len() - 1);
    }
    if keys.just_pressed(KeyCode::Space) {
        season.year = (season.year + SEASON_STEP).rem_euclid(1.0);
    }
}

fn spawn_tree(
    mut commands: Commands,
    selection: Res<Selection>,
    options: Res<Options>,
    assets: Res<AssetServer>,
    trees: Query<Entity, With<Tree>>,
) {
    trees.iter().for_each(|tree| commands.entity(tree).despawn());
    let species = assets.load(format!("species/{}.species.ron", options.species[selection.species]));
    commands.spawn((Tree::new(species).with_seed(options.wind.seed), Transform::default()));
}

/// Gives the tree its age once its species is known.
fn set_age(selection: Res<Selection>, species: Res<Assets<Species>>, mut trees: Query<&mut Tree>) {
    let Ok(mut tree) = trees.single_mut() else { return };
    let Some(kind) = species.get(&tree.species) else { return };
    let years = AGES[selection.age] * kind.age.mature_years;
    if tree.age_years != Some(years) {
        tree.age_years = Some(years);
    }
}

fn show_tree(
    selection: Res<Selection>,
    options: Res<Options>,
    season: Res<Season>,
    tree: Single<&Tree>,
    mut text: Single<&mut TextSpan, With<StatusText>>,
) {
    let name = &options.species[selection.species];
    let years = tree.age_years.unwrap_or_default();
    show_status(&mut text, format!("{name}, {years:.0} years, {:.0}% of the year", 100.0 * season.year));
}
