//! Walking through the gallery in a window.

use crate::{
    options::Options,
    studio::{FIELD_OF_VIEW, Look, viewpoint},
};
use bevy::{camera_controller::free_camera::FreeCamera, prelude::*};
use bevy_windwood::prelude::*;

/// What is on show.
#[derive(Resource, Default)]
struct Exhibit {
    species: usize,
    age: usize,
}

/// Ages that up and down go through, as shares of the mature age.
const AGES: [f32; 7] = [0.05, 0.1, 0.2, 0.45, 1.0, 1.4, 2.0];
/// How far a press of space moves the year.
const SEASON_STEP: f32 = 1.0 / 24.0;

/// A camera to fly, and keys that change what is on show.
pub fn plugin(app: &mut App) {
    app.add_plugins(bevy::camera_controller::free_camera::FreeCameraPlugin)
        .insert_resource(Exhibit { species: 0, age: 4 })
        .add_systems(Startup, open)
        .add_systems(Update, (change, show.run_if(resource_changed::<Exhibit>), label));
}

#[derive(Component)]
struct Label;

fn open(mut commands: Commands) {
    let lens = PerspectiveProjection { fov: FIELD_OF_VIEW, far: 2000.0, ..default() };
    let view = viewpoint(Look::Whole, 16.0, 14.0, 1.4);
    commands.spawn((Camera3d::default(), FreeCamera::default(), Projection::Perspective(lens), view));
    commands.spawn((Label, Text::default(), Node { margin: UiRect::all(Val::Px(12.0)), ..default() }));
}

fn change(
    keys: Res<ButtonInput<KeyCode>>,
    options: Res<Options>,
    mut season: ResMut<Season>,
    mut exhibit: ResMut<Exhibit>,
) {
    let pressed = |key| usize::from(keys.just_pressed(key));
    let (left, right) = (pressed(KeyCode::ArrowLeft), pressed(KeyCode::ArrowRight));
    let (down, up) = (pressed(KeyCode::ArrowDown), pressed(KeyCode::ArrowUp));
    if left + right + up + down > 0 {
        let count = options.species.len();
        exhibit.species = (exhibit.species + right + (count - 1) * left) % count;
        exhibit.age = (exhibit.age + up).saturating_sub(down).min(AGES.len() - 1);
    }
    if keys.just_pressed(KeyCode::Space) {
        season.year = (season.year + SEASON_STEP).rem_euclid(1.0);
    }
}

fn show(
    mut commands: Commands,
    exhibit: Res<Exhibit>,
    options: Res<Options>,
    assets: Res<AssetServer>,
    trees: Query<Entity, With<Tree>>,
) {
    trees.iter().for_each(|tree| commands.entity(tree).despawn());
    let species = assets.load(format!("species/{}.species.ron", options.species[exhibit.species]));
    commands.spawn((Tree::new(species).with_seed(options.seed), Transform::default()));
}

/// Says what is on show, and gives the tree its age once its species is known.
fn label(
    exhibit: Res<Exhibit>,
    options: Res<Options>,
    season: Res<Season>,
    species: Res<Assets<Species>>,
    mut trees: Query<&mut Tree>,
    mut labels: Query<&mut Text, With<Label>>,
) {
    let Ok(mut tree) = trees.single_mut() else { return };
    let Some(kind) = species.get(&tree.species) else { return };
    let years = AGES[exhibit.age] * kind.age.mature_years;
    if tree.age_years != Some(years) {
        tree.age_years = Some(years);
    }
    let Ok(mut text) = labels.single_mut() else { return };
    let name = &options.species[exhibit.species];
    let said = format!(
        "{name}, {years:.0} years, {:.0}% of the year\narrows: species, age    space: season",
        100.0 * season.year
    );
    if text.0 != said {
        text.0 = said;
    }
}
