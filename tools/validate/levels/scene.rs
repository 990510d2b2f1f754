//! A few trees of one species in front of a camera, rendered at any level.

use crate::support::capture;
use bevy::prelude::*;
use bevy_windwood::{
    lod::LodScreenSizes,
    prelude::*,
    scatter::{
        ForestPlan,
        plan::{Area, Shape, Stock},
    },
    tree::TreeModel,
};
use image::{DynamicImage, Rgb, RgbImage};
use std::{path::Path, time::Duration};

/// Size of the pictures, pixels.
const WIDTH: u32 = 720;
const HEIGHT: u32 = 540;
/// Vertical field of view, rad.
const FOV_RAD: f32 = std::f32::consts::FRAC_PI_4;
/// Time of the pictures, s.
const TIME_S: f64 = 40.0;
/// Time between two frames, s.
const FRAME_S: f64 = 1.0 / 60.0;
/// Distance up to which trees are entities, m: farther than any change of level.
const TREES_TO_M: f32 = 1500.0;

/// What is rendered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shot {
    /// The full trees.
    Full,
    /// One of our coarser levels alone: 1, 2, or 3, the impostor.
    Level(usize),
    /// A change of levels, at a share of the distance at which the finer level ends.
    Fading(usize, f32),
    /// One of the levels of the paper alone: 1 or 2.
    Paper(usize),
}

/// The trees and their camera.
pub struct TestScene {
    app: App,
    camera: Entity,
    target: Handle<Image>,
    height_m: f32,
    /// Size of a tree in the picture, pixels.
    size_px: f32,
}

/// Whether a pixel shows no tree.
pub fn is_background(pixel: &Rgb<u8>) -> bool {
    pixel.0[0] > 180 && pixel.0[1] < 90 && pixel.0[2] > 180
}

impl TestScene {
    /// Spawns trees of a species and waits for their levels.
    pub fn new(species: &str, season: Season) -> Result<Self, String> {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("assets/species/{species}.species.ron"));
        let text = std::fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
        let kind = Species::from_ron(&text).map_err(|error| error.to_string())?;
        let mature_years = kind.age.mature_years;
        let height_m = TreeModel::bake(&kind, mature_years, kind.seed).height_m();

        let mut app = App::new();
        app.add_plugins((capture::headless_engine(None), WindwoodPlugins));
        capture::begin(&mut app)?;
        let target = capture::target(&mut app, (WIDTH, HEIGHT));
        let world = app.world_mut();
        world.insert_resource(ClearColor(Color::srgb(1.0, 0.0, 1.0)));
        world.insert_resource(GlobalAmbientLight { brightness: 700.0, ..default() });
        world.insert_resource(season);
        world.insert_resource(Wind { speed: 8.0, ..default() });
        // The sun is the only light.
        world.insert_resource(TreeLighting::SunOnly);
        world.resource_mut::<LevelOfDetail>().changes_per_frame = 1_000_000;
        let plan = plan(species, mature_years, height_m);
        let plan = world.resource_mut::<Assets<ForestPlan>>().add(plan);
        let settings = ForestSettings {
            trees_to_m: TREES_TO_M,
            far_to_m: 2.0 * TREES_TO_M,
            cells_at_once: 64,
            trees_per_frame: 1000,
            ..default()
        };
        world.spawn((Forest::new(plan), settings));
        world.spawn((
            DirectionalLight { illuminance: 12_000.0, ..default() },
            Transform::default().looking_to(Vec3::new(-0.5, -0.7, -0.4), Vec3::Y),
        ));
        let lens = Projection::Perspective(PerspectiveProjection { fov: FOV_RAD, far: 5000.0, ..default() });
        let camera = world.spawn((capture::camera(&target), lens, Transform::default())).id();
        let mut scene = Self { app, camera, target, height_m, size_px: 1.0 };
        scene.set_size_px(400.0);
        scene.wait_for_levels()?;
        Ok(scene)
    }

    /// Sizes at which our levels change, pixels.
    pub fn switching_px(&self) -> [f32; 3] {
        let LodScreenSizes { high_px, medium_px, .. } = LodScreenSizes::default();
        [high_px, (high_px * medium_px).sqrt(), medium_px]
    }

    /// Moves the camera to where trees have that size.
    pub fn set_size_px(&mut self, size_px: f32) {
        self.size_px = size_px;
        let distance_m = self.distance_m();
        let middle_m = 0.48 * self.height_m;
        if let Some(mut at) = self.app.world_mut().get_mut::<Transform>(self.camera) {
            *at = Transform::from_xyz(0.0, middle_m, distance_m).looking_at(Vec3::Y * middle_m, Vec3::Y);
        }
    }

    /// Distance from the camera to the trees, m.
    pub fn distance_m(&self) -> f32 {
        self.height_m * HEIGHT as f32 / (2.0 * (0.5 * FOV_RAD).tan() * self.size_px)
    }

    /// A tenth of the height of a tree in the picture, pixels.
    pub fn tenth_px(&self) -> u32 {
        ((0.1 * self.size_px).round() as u32).max(1)
    }

    /// Left, top, width and height of the part of a picture that shows trees.
    pub fn crop(&self) -> [u32; 4] {
        let height = (1.25 * self.size_px).min(HEIGHT as f32);
        let width = (1.3 * height).min(WIDTH as f32);
        [0.5 * (WIDTH as f32 - width), 0.5 * (HEIGHT as f32 - height), width, height].map(|length| length as u32)
    }

    /// Renders the trees.
    pub fn render(&mut self, shot: Shot) -> RgbImage {
        self.render_at(shot, TIME_S)
    }

    /// Renders the trees a frame later.
    pub fn render_next_frame(&mut self, shot: Shot) -> RgbImage {
        self.render_at(shot, TIME_S + FRAME_S)
    }

    fn render_at(&mut self, shot: Shot, time_s: f64) -> RgbImage {
        let world = self.app.world_mut();
        let (style, screen_sizes) = level_settings(shot, self.size_px);
        let mut detail = world.resource_mut::<LevelOfDetail>();
        let other_style = detail.style != style;
        (detail.style, detail.screen_sizes) = (style, screen_sizes);
        *world.resource_mut::<WindClock>() = WindClock { time_s, previous_s: time_s };
        if other_style && let Err(error) = self.wait_for_levels() {
            eprintln!("{error}");
        }
        capture::step(&mut self.app);
        match capture::capture(&mut self.app, &self.target, (WIDTH, HEIGHT)) {
            Ok(picture) => DynamicImage::ImageRgba8(picture).into_rgb8(),
            Err(error) => {
                eprintln!("{error}");
                RgbImage::new(WIDTH, HEIGHT)
            }
        }
    }

    /// Waits for the levels of a style. Nothing reports that they are complete: the forest must have been ready for 400 updates.
    fn wait_for_levels(&mut self) -> Result<(), String> {
        let set_active = |app: &mut App, camera, active| {
            if let Some(mut camera) = app.world_mut().get_mut::<Camera>(camera) {
                camera.is_active = active;
            }
        };
        set_active(&mut self.app, self.camera, true);
        (0..2).for_each(|_| self.app.update());
        let viewpoint = self.app.world_mut().get::<Transform>(self.camera).copied().unwrap_or_default();
        let viewpoint = self.app.world_mut().spawn((Viewpoint, viewpoint)).id();
        set_active(&mut self.app, self.camera, false);
        let mut ready_updates = 0;
        for _ in 0..4000 {
            self.app.update();
            std::thread::sleep(Duration::from_millis(3));
            ready_updates = if is_ready(self.app.world_mut()) { ready_updates + 1 } else { 0 };
            if ready_updates > 400 {
                break;
            }
        }
        self.app.world_mut().despawn(viewpoint);
        set_active(&mut self.app, self.camera, true);
        (0..4).for_each(|_| capture::step(&mut self.app));
        if ready_updates > 400 { Ok(()) } else { Err("the trees did not get ready; see the warnings above".into()) }
    }
}

fn is_ready(world: &mut World) -> bool {
    let trees = world.query_filtered::<(), With<Tree>>().iter(world).count();
    world.resource::<ActiveSway>().is_ready() && trees > 0 && capture::forests_are_drawn(world)
}

/// Some eight trees of one size in a row across the view.
fn plan(species: &str, mature_years: f32, height_m: f32) -> ForestPlan {
    let [across_m, along_m] = [0.7 * height_m, 0.1 * height_m];
    let stock = Stock {
        species: species.into(),
        age_years: mature_years,
        age_spread_years: 0.0,
        size_spread: 0.0,
        season_spread_days: 0.0,
        ..default()
    };
    let area = Area {
        shape: Shape::Rectangle { min_m: [-across_m, -along_m], max_m: [across_m, along_m] },
        density_per_ha: 8.0 * 1e4 / (4.0 * across_m * along_m),
        least_distance_m: 0.0,
        stock: vec![stock],
        ..default()
    };
    ForestPlan { seed: 5, areas: vec![area], ..default() }
}

/// The settings at which trees of a size, pixels, are rendered as the shot says.
fn level_settings(shot: Shot, size_px: f32) -> (LevelStyle, LodScreenSizes) {
    let with =
        |high: f32, medium: f32| LodScreenSizes { high_px: high * size_px, medium_px: medium * size_px, ..default() };
    match shot {
        Shot::Full => (LevelStyle::Full, with(1.0, 1.0)),
        // The second level ends at the geometric mean of the other two sizes.
        Shot::Level(1) => (LevelStyle::Thinned, with(4.0, 1.0 / 16.0)),
        Shot::Level(2) => (LevelStyle::Thinned, with(16.0, 0.25)),
        Shot::Level(_) => (LevelStyle::Thinned, with(64.0, 3.0)),
        Shot::Fading(0, share) => (LevelStyle::Thinned, with(share, 1.0 / 16.0)),
        Shot::Fading(1, share) => (LevelStyle::Thinned, with(8.0, share * share / 8.0)),
        Shot::Fading(_, share) => (LevelStyle::Thinned, with(64.0, share)),
        Shot::Paper(1) => (LevelStyle::Paper, with(4.0, 0.1)),
        Shot::Paper(_) => (LevelStyle::Paper, with(16.0, 4.0)),
    }
}
