//! Ground, woods, sky and sun.

use crate::{
    options::{Options, View},
    support::{
        daylight::Daylight,
        landscape::{FINEST_CELL_M, Landscape},
        meadow,
        options::SceneOptions,
        scene::{Scene, no_plan_failed},
    },
    window,
};
use bevy::{math::DVec2, prelude::*};
use bevy_windwood::{
    forest::PlanCover,
    prelude::*,
    scatter::{ForestPlan, Planter},
    terrain::Cover,
};
use noise::{NoiseFn, OpenSimplex};
use std::sync::Arc;

/// Distances between clumps of grass, and between the tufts at their edges, m.
const CLUMP_M: f64 = 3.5;
const TUFT_M: f64 = 0.6;
/// Slope up to which grass grows everywhere.
const GRASSY_SLOPE: f64 = 0.7;

const PLAN: &str = "forests/rockies.forest.ron";

/// What the scene is made from.
#[derive(Resource)]
pub struct TerrainScene {
    pub options: Options,
    pub landscape: Landscape,
}

impl Scene for TerrainScene {
    const TITLE: &'static str = "bevy_windwood: terrain";
    const SPEEDS_M_S: [f32; 2] = [20.0, 400.0];

    fn options(&self) -> &SceneOptions {
        &self.options.scene
    }

    fn wind(&self) -> Wind {
        Wind { direction: Dir2::X, roughness_m: 0.3, ..default() }
    }

    fn picture_name(&self) -> &'static str {
        match self.options.view {
            View::Valley => "terrain_valley",
            View::Summit => "terrain_summit",
            View::Aerial => "terrain_aerial",
            View::Patches => "terrain_patches",
        }
    }

    fn camera_transform(&self) -> Transform {
        let above = |x: f32, z: f32, height_m: f32| Vec3::new(x, self.landscape.height_m(x, z) + height_m, z);
        let (eye, target) = match self.options.view {
            View::Valley => (above(300.0, 556.0, 2.2), above(225.0, 450.0, 11.0)),
            View::Summit => (above(2300.0, 21_300.0, 6.0), above(1000.0, 22_900.0, -60.0)),
            View::Aerial => (above(5200.0, 17_500.0, 900.0), above(1180.0, 22_700.0, -500.0)),
            View::Patches => (above(-250.0, 230.0, 42.0), above(30.0, 0.0, -12.0)),
        };
        Transform::from_translation(eye).looking_at(target, Vec3::Y)
    }

    /// Clear for kilometres, and blue at the horizon.
    fn camera_effects(&self) -> impl Bundle + use<> {
        Daylight::AFTERNOON.haze(19_000.0)
    }

    fn plugin(app: &mut App) {
        app.add_systems(Startup, spawn_scene);
    }

    fn window_plugin(app: &mut App) {
        window::plugin(app);
    }

    fn is_spawned(&self, world: &mut World) -> Result<bool, String> {
        no_plan_failed(world)
    }
}

/// Spawns everything but the camera.
fn spawn_scene(
    mut commands: Commands,
    scene: Res<TerrainScene>,
    assets: Res<AssetServer>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let TerrainScene { options, landscape } = &*scene;
    let headless = options.scene.image.headless;
    let forest = options.distances.settings(headless);
    // Pictures wait for the ground. A window must not.
    let (builds_at_once, chunks_per_frame) = if headless { (64, 64) } else { (8, 4) };
    let cover = options.has_woods().then(|| cover(landscape)).flatten();
    if options.view == View::Valley {
        meadow::spawn_meadow(&mut commands, meadow_m(landscape, cover.clone()), cover.clone(), 1);
    }
    commands.spawn((
        Terrain { ground: landscape.ground.clone(), cover },
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
            canopy_from_m: if options.has_trees() { forest.far_to_m.max(forest.trees_to_m) } else { 0.0 },
            ..default()
        },
    ));
    if options.has_trees() {
        commands.spawn((Forest::new(assets.load(PLAN)), forest));
    }
    let [from, to] = landscape.corners_m.map(DVec2::as_vec2);
    let middle = 0.5 * (from + to);
    let sky = (Vec3::new(middle.x, 2500.0, middle.y), 60_000.0);
    Daylight::AFTERNOON.spawn(&mut commands, &mut meshes, &mut materials, sky, (60.0, 600.0));
}

/// The height of the ground where grass grows, m: not on steep ground, and less under trees.
fn meadow_m(landscape: &Landscape, cover: Option<Arc<dyn Cover>>) -> impl Fn(DVec2) -> f64 + use<> {
    let (landscape, clumps) = (landscape.clone(), OpenSimplex::new(1));
    move |at| {
        let shade = cover.as_ref().map_or(0.0, |cover| f64::from(cover.share(at)));
        let lack = 2.2 * shade + 3.0 * (landscape.ground.slope(at) - GRASSY_SLOPE).max(0.0) - 0.9;
        let noise = |scale_m: f64| clumps.get((at / scale_m).to_array());
        let is_bare = noise(CLUMP_M) + 0.4 * noise(TUFT_M) < lack;
        if is_bare { f64::NAN } else { f64::from(landscape.height_m(at.x as f32, at.y as f32)) }
    }
}

/// The woods as a colour of the ground, for where no tree is drawn.
fn cover(landscape: &Landscape) -> Option<Arc<dyn Cover>> {
    let planter = ForestPlan::from_ron(include_str!("../../assets/forests/rockies.forest.ron"))
        .and_then(|plan| Ok(Planter::new(&plan)?))
        .inspect_err(|error| error!("{PLAN}: {error}"))
        .ok()?;
    Some(Arc::new(PlanCover::new(planter, landscape.ground.clone())))
}
