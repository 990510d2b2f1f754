//! The level, a wood and a meadow on it, sky and sun.

use crate::{
    level::{self, HALF_M, Physics, height_m},
    options::{Options, OwnGround},
    support::{
        daylight::{haze, spawn_daylight},
        options::SceneOptions,
        scene::{Scene, no_plan_failed},
        window::{CAMERA_KEYS, spawn_text},
    },
};
use bevy::{math::DVec2, prelude::*};
use bevy_windwood::{
    prelude::*,
    terrain::{RayCastGround, TriangleGround},
};
use std::sync::Arc;

const PLAN: &str = "forests/mixed.forest.ron";
/// The meadow: its middle (x, z) and its side, m.
const MEADOW: (Vec2, f32) = (Vec2::new(12.0, 34.0), 36.0);

/// What the scene is made from.
#[derive(Resource)]
pub struct OwnGroundScene {
    pub options: Options,
}

impl Scene for OwnGroundScene {
    const TITLE: &'static str = "bevy_windwood: own ground";
    const SPEEDS_M_S: [f32; 2] = [8.0, 60.0];

    fn options(&self) -> &SceneOptions {
        &self.options.scene
    }

    fn wind(&self) -> Wind {
        Wind { direction: Dir2::X, ..default() }
    }

    fn picture_name(&self) -> &'static str {
        "own_ground"
    }

    fn camera_transform(&self) -> Transform {
        let above = |x: f32, z: f32, above_m: f32| {
            Vec3::new(x, height_m(DVec2::new(f64::from(x), f64::from(z))) as f32 + above_m, z)
        };
        Transform::from_translation(above(52.0, 60.0, 4.5)).looking_at(above(6.0, 18.0, 3.0), Vec3::Y)
    }

    fn camera_effects(&self) -> impl Bundle + use<> {
        haze(2500.0)
    }

    fn plugin(app: &mut App) {
        app.add_systems(Startup, spawn_scene);
    }

    fn window_plugin(app: &mut App) {
        app.add_systems(Startup, spawn_text(&[CAMERA_KEYS]));
    }

    fn is_spawned(&self, world: &mut World) -> Result<bool, String> {
        no_plan_failed(world)
    }
}

/// Spawns everything but the camera.
fn spawn_scene(
    mut commands: Commands,
    scene: Res<OwnGroundScene>,
    assets: Res<AssetServer>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) -> Result {
    let options = &scene.options;
    let mesh = level::mesh();
    let ground: Arc<dyn Ground> = match options.ground {
        // A function is ground already.
        OwnGround::Function => Arc::new(height_m),
        OwnGround::Mesh => Arc::new(TriangleGround::from_mesh(&mesh, Transform::IDENTITY)?),
        OwnGround::Rays => {
            let physics = Physics;
            Arc::new(RayCastGround::new(-20.0..=40.0, move |from, reach_m| physics.distance_down_m(from, reach_m))?)
        }
    };
    commands.spawn((
        Forest::new(assets.load(PLAN)),
        options.distances.settings(options.scene.image.headless),
        ForestGround(ground.clone()),
    ));
    // The ground of a meadow is asked in the meadow's own places.
    let (middle, side_m) = MEADOW;
    let below = ground.clone();
    let under_meadow = move |at: DVec2| below.height_m(at + middle.as_dvec2());
    commands.spawn((
        GrassPatch { sward: Sward { width_m: side_m, depth_m: side_m, ..default() }, ..default() },
        GrassGround(Arc::new(under_meadow)),
        Transform::from_xyz(middle.x, 0.0, middle.y),
    ));
    if options.ground == OwnGround::Function {
        commands.spawn((
            Terrain { ground, cover: None },
            TerrainSettings { reach_m: 2.0 * HALF_M, builds_at_once: 64, chunks_per_frame: 64, ..default() },
        ));
    } else {
        let earth = StandardMaterial {
            base_color: Color::srgb(0.29, 0.30, 0.17),
            perceptual_roughness: 1.0,
            reflectance: 0.1,
            ..default()
        };
        commands.spawn((Mesh3d(meshes.add(mesh)), MeshMaterial3d(materials.add(earth))));
    }
    spawn_daylight(&mut commands, &mut meshes, &mut materials, (Vec3::ZERO, 5000.0), (60.0, 300.0));
    Ok(())
}
