//! Ground, sky, sun and trees.

use crate::{
    large,
    options::{Light, Options, View},
    small,
    support::{
        landscape::{FINEST_CELL_M, Landscape},
        meadow, mist,
        options::SceneOptions,
        scene::Scene,
    },
    undergrowth, window,
};
use bevy::{camera::Exposure, prelude::*};
use bevy_windwood::{prelude::*, scatter::ForestPlan, terrain::Cover};
use std::sync::Arc;

/// Under trees there is a tenth of the sky's light: an eye that gets used to it sees some two stops more.
const INSIDE: Exposure = Exposure { ev100: Exposure::EV100_BLENDER - 2.1 };

/// Width of the mist of a morning about the camera's first place, m.
const MIST_M: f32 = 180.0;

/// What the scene is made from.
#[derive(Resource)]
pub struct ForestScene {
    pub options: Options,
    pub landscape: Landscape,
}

impl Scene for ForestScene {
    const TITLE: &'static str = "bevy_windwood: forest";
    const SPEEDS_M_S: [f32; 2] = [12.0, 60.0];

    fn options(&self) -> &SceneOptions {
        &self.options.scene
    }

    /// Across the view, a little up the slope.
    fn wind(&self) -> Wind {
        let uphill = *self.landscape.uphill();
        let direction = Dir2::new(uphill.perp() + 0.35 * uphill).unwrap_or(Dir2::X);
        Wind { direction, roughness_m: 0.3, ..default() }
    }

    fn picture_name(&self) -> &'static str {
        "forest"
    }

    fn camera_transform(&self) -> Transform {
        let Self { options, landscape } = self;
        if options.extent.is_some() {
            return large::camera_transform(landscape);
        }
        let uphill = *landscape.uphill();
        let half_m = small::half_side_m(options.trees);
        let above = |at: Vec2, height_m: f32| Vec3::new(at.x, landscape.height_m(at.x, at.y) + height_m, at.y);
        let (eye, target) = match options.view {
            View::Hillside => {
                let eye = -uphill * (half_m * 1.12 + 30.0) + uphill.perp() * 0.2 * half_m;
                (above(eye, 0.16 * half_m + 5.0), above(uphill * 0.2 * half_m, 14.0))
            }
            View::Edge => {
                let eye = -uphill * (half_m + 30.0);
                (above(eye, 1.8), above(-uphill * (half_m - 4.0) + uphill.perp() * 3.0, 6.0))
            }
            View::Inside => {
                let eye = -uphill * (0.55 * half_m);
                (above(eye, 1.7), above(eye + uphill * 20.0 + uphill.perp() * 6.0, 2.6))
            }
            View::Aerial => (above(-uphill * half_m * 0.9, 1.1 * half_m + 20.0), above(Vec2::ZERO, 4.0)),
        };
        Transform::from_translation(eye).looking_at(target, Vec3::Y)
    }

    /// Clear among the trees, blue on the far ridges.
    fn camera_effects(&self) -> impl Bundle + use<> {
        let exposure = match self.options.view {
            View::Inside => INSIDE,
            View::Hillside | View::Edge | View::Aerial => Exposure::default(),
        };
        (self.options.light.daylight().haze(6500.0), exposure)
    }

    fn plugin(app: &mut App) {
        app.add_systems(Startup, spawn_scene);
    }

    fn window_plugin(app: &mut App) {
        window::plugin(app);
    }

    fn is_spawned(&self, world: &mut World) -> Result<bool, String> {
        Ok(self.options.trees == 0 || world.query::<&Tree>().iter(world).next().is_some())
    }
}

/// Spawns everything but the camera.
fn spawn_scene(
    mut commands: Commands,
    scene: Res<ForestScene>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
    mut plans: ResMut<Assets<ForestPlan>>,
) {
    let ForestScene { options, landscape } = &*scene;
    let cover: Option<Arc<dyn Cover>>;
    let mut look = GroundLook::default();
    if let Some(extent_m) = options.extent {
        let plan = large::plan(options, extent_m);
        cover = large::cover(&plan, landscape);
        let settings = large::settings(options, extent_m);
        look.canopy_from_m = settings.far_to_m.max(settings.trees_to_m);
        commands.spawn((Forest::new(plans.add(plan)), settings));
        large::spawn_hamlet(&mut commands, &mut meshes, &mut materials, landscape);
    } else {
        small::spawn_trees(&mut commands, &mut plans, landscape, options.trees, options.scene.wind.seed);
        // All trees are drawn, from wherever one looks: the ground never takes the colour of crowns.
        look.canopy_from_m = 1e5;
        cover = Some(Arc::new(small::Floor::new(options.trees)));
        undergrowth::spawn_undergrowth(&mut commands, &mut plans, landscape, options.trees, options.scene.wind.seed);
        let meadow_m = small::meadow(landscape, options.trees, options.scene.wind.seed);
        meadow::spawn_meadow(&mut commands, meadow_m, cover.clone(), options.scene.wind.seed);
    }
    let finest_cell_m = FINEST_CELL_M;
    commands.spawn((
        Terrain { ground: landscape.ground.clone(), cover },
        look,
        TerrainSettings { finest_cell_m, reach_m: 14_000.0, chunks_per_frame: 64, builds_at_once: 64, ..default() },
    ));
    let sky = (Vec3::Y * landscape.height_m(0.0, 0.0), 40_000.0);
    let daylight = options.light.daylight();
    let sun = daylight.spawn(&mut commands, &mut meshes, &mut materials, sky, (55.0, 420.0));
    if options.light == Light::Morning {
        let size_m = Vec3::new(MIST_M, 0.5 * MIST_M, MIST_M);
        mist::lay(&mut commands, sun, daylight.haze_colour(), scene.camera_transform().translation, size_m);
    }
}
