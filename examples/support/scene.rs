//! A scene: what an example says about itself to get a window and pictures.

use super::{effects, options::SceneOptions, pictures, start, window};
use bevy::{asset::LoadState, prelude::*};
use bevy_windwood::prelude::*;
use std::process::ExitCode;

/// A scene to fly through in a window, or to render to pictures.
pub trait Scene: Resource + Sized {
    /// Title of the window.
    const TITLE: &'static str;
    /// Speed of the camera in the window, m/s: usual, and while Shift is held.
    const SPEEDS_M_S: [f32; 2];
    /// Whether time has to run from one picture to the next, since something moves that is no function of it.
    const RUNS: bool = false;

    fn options(&self) -> &SceneOptions;

    /// The wind, except for what the options say of it.
    fn wind(&self) -> Wind;

    /// What pictures are called, without number and extension.
    fn picture_name(&self) -> &'static str;

    fn camera_transform(&self) -> Transform;

    /// Components of every camera besides projection and target: fog, exposure.
    fn camera_effects(&self) -> impl Bundle + use<Self>;

    /// Adds the system that spawns everything but the camera.
    fn plugin(app: &mut App);

    /// Adds the text and the keys of the window.
    fn window_plugin(app: &mut App);

    /// Whether all that has to be drawn has been spawned.
    ///
    /// # Errors
    /// If it never will be.
    fn is_spawned(&self, world: &mut World) -> Result<bool, String>;
}

/// Runs a scene.
pub fn run<S: Scene>(scene: S) -> ExitCode {
    let SceneOptions { wind, year, image, plain, .. } = scene.options().clone();
    let mut app = start::app(S::TITLE, &image);
    app.insert_resource(Wind { speed: wind.wind, seed: wind.seed, ..scene.wind() })
        .insert_resource(Season { year })
        .insert_resource(scene)
        .add_plugins(S::plugin);
    if !plain {
        effects::give_to_cameras(&mut app, !image.headless);
    }
    if image.headless {
        return start::exit_code(pictures::render::<S>(&mut app));
    }
    app.add_plugins((window::plugin::<S>, S::window_plugin)).run();
    ExitCode::SUCCESS
}

/// Whether forests may still grow: an error where the plan of one could not be loaded.
///
/// # Errors
/// With the plan's file.
pub fn no_plan_failed(world: &mut World) -> Result<bool, String> {
    let assets = world.resource::<AssetServer>().clone();
    for forest in world.query::<&Forest>().iter(world) {
        if let LoadState::Failed(error) = assets.load_state(&forest.plan) {
            let file = forest.plan.path().map_or_else(String::new, ToString::to_string);
            return Err(format!("{file}: {error}"));
        }
    }
    Ok(true)
}
