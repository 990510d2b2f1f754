//! Ground, sky, sun and trees.

use crate::{
    capture,
    daylight::{self, spawn_daylight},
    landscape::{FINEST_CELL_M, Landscape},
    options::{Options, View},
    planting, wide,
};
use bevy::{pbr::DistanceFog, prelude::*};
use bevy_windwood::{prelude::*, scatter::ForestPlan, terrain::TerrainChunks};

/// What pictures of it are called.
pub fn name(_: &Options) -> &'static str {
    "forest"
}

/// What the scene is made from.
#[derive(Resource)]
pub struct Setting {
    pub options: Options,
    pub ground: Landscape,
}

/// The wind blows across the view, a little up the slope.
pub fn wind_direction(ground: &Landscape) -> Dir2 {
    let uphill = *ground.uphill();
    Dir2::new(uphill.perp() + 0.35 * uphill).unwrap_or(Dir2::X)
}

/// Where the camera stands for a view.
pub fn camera_transform(setting: &Setting) -> Transform {
    let Setting { options, ground } = setting;
    if options.extent.is_some() {
        return wide::camera_transform(ground);
    }
    let uphill = *ground.uphill();
    let half = planting::half_side_m(options.trees);
    let on_ground = |at: Vec2, height: f32| Vec3::new(at.x, ground.height_m(at.x, at.y) + height, at.y);
    let (eye, target) = match options.view {
        View::Hillside => {
            let eye = -uphill * (half * 1.12 + 30.0) + uphill.perp() * 0.2 * half;
            (on_ground(eye, 0.16 * half + 5.0), on_ground(uphill * 0.2 * half, 14.0))
        }
        View::Edge => {
            let eye = -uphill * (half + 17.0);
            (on_ground(eye, 1.8), on_ground(-uphill * (half - 4.0) + uphill.perp() * 3.0, 6.0))
        }
        View::Aerial => (on_ground(-uphill * half * 0.9, 1.1 * half + 20.0), on_ground(Vec2::ZERO, 4.0)),
    };
    Transform::from_translation(eye).looking_at(target, Vec3::Y)
}

/// Clear in the wood, blue on the far ridges.
pub fn haze() -> DistanceFog {
    daylight::haze(6500.0)
}

/// Whether the wind blows and every tree is drawn; an error if that will never be.
pub fn is_ready(world: &mut World, options: &Options) -> Result<bool, String> {
    let assets = world.resource::<AssetServer>().clone();
    if let Some(tree) = world.query::<&Tree>().iter(world).find(|tree| assets.load_state(&tree.species).is_failed()) {
        return Err(format!("{:?} could not be loaded; the reason stands above", tree.species.path()));
    }
    let bald = world.query_filtered::<(), (With<GrassPatch>, Without<Mesh3d>)>().iter(world).count();
    let trees = world.query_filtered::<(), With<Tree>>().iter(world).count();
    let planted = trees > 0 || options.trees == 0;
    let grounded = world.query::<&TerrainChunks>().iter(world).all(TerrainChunks::is_complete);
    Ok(world.resource::<ActiveSway>().is_ready()
        && planted
        && bald == 0
        && grounded
        && capture::forests_are_drawn(world))
}

/// Spawns everything but the camera.
pub fn build(
    mut commands: Commands,
    setting: Res<Setting>,
    assets: Res<AssetServer>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
    mut plans: ResMut<Assets<ForestPlan>>,
) {
    let Setting { options, ground } = &*setting;
    let mut cover = None;
    let mut look = GroundLook::default();
    if let Some(extent_m) = options.extent {
        let plan = wide::plan(options, extent_m);
        cover = wide::cover(&plan, ground);
        let settings = wide::settings(options, extent_m);
        look.canopy_from_m = settings.far_to_m.max(settings.trees_to_m);
        commands.spawn((Forest::new(plans.add(plan)), settings));
        wide::spawn_hamlet(&mut commands, &mut meshes, &mut materials, ground);
    } else {
        let places = planting::places(ground, options.trees, options.seed);
        planting::plant(&mut commands, &assets, &places);
    }
    let finest_cell_m = FINEST_CELL_M;
    commands.spawn((
        Terrain { ground: ground.ground.clone(), cover },
        look,
        TerrainSettings { finest_cell_m, reach_m: 14_000.0, chunks_per_frame: 64, builds_at_once: 64, ..default() },
    ));
    let sky = (Vec3::Y * ground.height_m(0.0, 0.0), 40_000.0);
    spawn_daylight(&mut commands, &mut meshes, &mut materials, sky, (55.0, 420.0));
}
