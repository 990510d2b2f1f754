//! Meadow, fire, logs and trees.

use crate::{
    fireplace, ground,
    options::{Options, View},
    support::{dusk, options::SceneOptions, scene::Scene},
    window,
};
use bevy::{light::NotShadowCaster, math::DVec2, prelude::*};
use bevy_windwood::prelude::*;
use std::sync::Arc;

/// What the scene is made from.
#[derive(Resource)]
pub struct MeadowScene {
    pub options: Options,
}

impl Scene for MeadowScene {
    const TITLE: &'static str = "bevy_windwood: fire and grass";
    const SPEEDS_M_S: [f32; 2] = [4.0, 16.0];

    fn options(&self) -> &SceneOptions {
        &self.options.scene
    }

    /// Across the view and a little towards the viewer.
    fn wind(&self) -> Wind {
        let direction = Dir2::new(Vec2::new(0.93, 0.36)).unwrap_or(Dir2::X);
        Wind { direction, roughness_m: 0.05, gustiness: 1.6, ..default() }
    }

    fn picture_name(&self) -> &'static str {
        "fire_and_grass"
    }

    fn camera_transform(&self) -> Transform {
        let (eye, target) = match self.options.view {
            View::Fire => (Vec3::new(0.9, 1.15, 5.2), Vec3::new(0.0, 0.72, 0.0)),
            View::Meadow => (Vec3::new(2.5, 2.3, 9.0), Vec3::new(0.0, 0.2, -4.0)),
            View::Close => (Vec3::new(0.3, 0.75, 2.2), Vec3::new(0.0, 0.5, 0.0)),
        };
        Transform::from_translation(eye).looking_at(target, Vec3::Y)
    }

    fn camera_effects(&self) -> impl Bundle + use<> {
        dusk::camera_effects()
    }

    fn plugin(app: &mut App) {
        app.add_systems(Startup, spawn_scene);
    }

    fn window_plugin(app: &mut App) {
        window::plugin(app);
    }

    fn is_spawned(&self, world: &mut World) -> Result<bool, String> {
        Ok(self.options.no_trees || world.query::<&Tree>().iter(world).next().is_some())
    }
}

/// Spawns everything but the camera.
fn spawn_scene(
    mut commands: Commands,
    scene: Res<MeadowScene>,
    assets: Res<AssetServer>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
    mut images: ResMut<Assets<Image>>,
) {
    let seed = scene.options.scene.wind.seed;
    let earth = StandardMaterial { perceptual_roughness: 1.0, reflectance: 0.05, ..default() };
    commands.spawn((Mesh3d(meshes.add(ground::mesh())), MeshMaterial3d(materials.add(earth))));
    spawn_meadow(&mut commands, seed);
    commands.spawn((
        Fire { shape: FireShape { seed, ..default() }, look: FireLook { casts_shadows: true, ..default() } },
        Transform::from_xyz(0.0, 0.03, 0.0),
    ));
    fireplace::spawn_fireplace(&mut commands, &mut meshes, &mut materials, &mut images, seed);
    if !scene.options.no_trees {
        spawn_trees(&mut commands, &assets);
    }
    dusk::spawn_light(&mut commands, &mut meshes, &mut materials);
}

/// Spawns a dense patch around the fire and a sparse one with broader blades behind it.
fn spawn_meadow(commands: &mut Commands, seed: u64) {
    let tuft = Tuft { shortest_m: 0.10, longest_m: 0.42, narrowest_m: 0.006, widest_m: 0.013, ..default() };
    let near = Sward { width_m: 14.0, depth_m: 11.0, tufts_per_m2: 11.0, tuft: tuft.clone(), seed, ..default() };
    let broad = Tuft { blades: 12, narrowest_m: 0.025, widest_m: 0.045, radius_m: 0.4, longest_m: 0.5, ..tuft };
    let far = Sward { width_m: 60.0, depth_m: 34.0, tufts_per_m2: 0.6, tuft: broad, seed: seed + 1, ..near.clone() };
    for (sward, middle) in [(near, Vec2::new(0.0, 0.3)), (far, Vec2::new(0.0, -22.2))] {
        let height_m = move |at: DVec2| f64::from(ground::meadow_height_m(at.as_vec2() + middle));
        commands.spawn((
            GrassPatch { sward, ..default() },
            GrassGround(Arc::new(height_m)),
            Transform::from_xyz(middle.x, 0.0, middle.y),
            NotShadowCaster,
        ));
    }
}

/// Spawns the trees behind the meadow.
fn spawn_trees(commands: &mut Commands, assets: &AssetServer) {
    let places = [("oak", -9.5, -15.0, 0.9), ("fir", 8.0, -17.0, 0.75), ("fir", 12.5, -21.0, 0.95)];
    for (species, x, z, scale) in places {
        let at = Vec3::new(x, ground::height_m(Vec2::new(x, z)) - 0.1, z);
        commands.spawn((
            Tree::new(assets.load(format!("species/{species}.species.ron"))),
            Transform::from_translation(at).with_scale(Vec3::splat(scale)),
            NotShadowCaster,
        ));
    }
}
