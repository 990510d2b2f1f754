//! Ground, woods, sky and sun.

use crate::{
    capture,
    daylight::{self, spawn_daylight},
    landscape::{FINEST_CELL_M, Landscape},
    options::{Options, View},
};
use bevy::{asset::LoadState, math::DVec2, pbr::DistanceFog, prelude::*};
use bevy_windwood::{
    forest::PlanCover,
    prelude::*,
    scatter::{ForestPlan, Planter},
    terrain::TerrainChunks,
};

/// What pictures of it are called.
pub fn name(options: &Options) -> &'static str {
    match options.view {
        View::Valley => "terrain_valley",
        View::Summit => "terrain_summit",
        View::Aerial => "terrain_aerial",
    }
}

const PLAN: &str = "forests/rockies.forest.ron";

/// What the scene is made from.
#[derive(Resource)]
pub struct Setting {
    pub options: Options,
    pub ground: Landscape,
}

/// Where the camera stands for a view: above a place (x, z), looking at a height above another, m.
pub fn camera_transform(setting: &Setting) -> Transform {
    let above = |x: f32, z: f32, height_m: f32| Vec3::new(x, setting.ground.height_m(x, z) + height_m, z);
    let (eye, target) = match setting.options.view {
        View::Valley => (above(300.0, 556.0, 2.2), above(225.0, 450.0, 11.0)),
        View::Summit => (above(2300.0, 21_300.0, 6.0), above(1000.0, 22_900.0, -60.0)),
        View::Aerial => (above(5200.0, 17_500.0, 900.0), above(1180.0, 22_700.0, -500.0)),
    };
    Transform::from_translation(eye).looking_at(target, Vec3::Y)
}

/// Clear for kilometres, and blue at the horizon.
pub fn haze() -> DistanceFog {
    daylight::haze(19_000.0)
}

/// Whether the wind blows, the ground is there and every tree is drawn; an error if that will never be.
pub fn is_ready(world: &mut World, _: &Options) -> Result<bool, String> {
    let assets = world.resource::<AssetServer>().clone();
    let plan = world.query::<&Forest>().iter(world).map(|forest| assets.load_state(&forest.plan)).next();
    if let Some(LoadState::Failed(error)) = plan {
        return Err(format!("{PLAN}: {error}"));
    }
    if let Some(tree) = world.query::<&Tree>().iter(world).find(|tree| assets.load_state(&tree.species).is_failed()) {
        return Err(format!("{:?} could not be loaded; the reason stands above", tree.species.path()));
    }
    let grounded = world.query::<&TerrainChunks>().iter(world).all(TerrainChunks::is_complete);
    Ok(world.resource::<ActiveSway>().is_ready() && grounded && capture::forests_are_drawn(world))
}

/// Spawns everything but the camera.
pub fn build(
    mut commands: Commands,
    setting: Res<Setting>,
    assets: Res<AssetServer>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let Setting { options, ground } = &*setting;
    // Pictures wait for the ground; a window must not.
    let (builds_at_once, chunks_per_frame) = if options.headless { (64, 64) } else { (8, 4) };
    commands.spawn((
        Terrain { ground: ground.ground.clone(), cover: cover(ground) },
        TerrainSettings {
            finest_cell_m: FINEST_CELL_M,
            reach_m: 40_000.0,
            builds_at_once,
            chunks_per_frame,
            ..default()
        },
        GroundLook {
            grass_line_m: 3450.0,
            snow_line_m: 4050.0,
            canopy_from_m: if options.no_trees { 0.0 } else { options.far_to.max(options.trees_to) },
            ..default()
        },
    ));
    if !options.no_trees {
        commands.spawn((
            Forest::new(assets.load(PLAN)),
            ForestSettings {
                trees_to_m: options.trees_to,
                far_to_m: options.far_to,
                cells_at_once: if options.headless { 64 } else { 4 },
                trees_per_frame: if options.headless { 100_000 } else { 64 },
                ..default()
            },
        ));
    }
    let [from, to] = ground.corners_m.map(DVec2::as_vec2);
    let middle = 0.5 * (from + to);
    let sky = (Vec3::new(middle.x, 2500.0, middle.y), 60_000.0);
    spawn_daylight(&mut commands, &mut meshes, &mut materials, sky, (60.0, 600.0));
}

/// The woods as the ground sees them from afar.
fn cover(ground: &Landscape) -> Option<std::sync::Arc<dyn bevy_windwood::terrain::Cover>> {
    let planter = ForestPlan::from_ron(include_str!("../../assets/forests/rockies.forest.ron"))
        .and_then(|plan| Planter::new(&plan))
        .inspect_err(|error| error!("{PLAN}: {error}"))
        .ok()?;
    Some(std::sync::Arc::new(PlanCover::new(planter, ground.ground.clone())))
}
