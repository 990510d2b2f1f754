//! A few trees of one species before a camera, drawn at any level.

use crate::capture;
use bevy::prelude::*;
use bevy_windwood::{
    lod::LevelDistances,
    prelude::*,
    scatter::{
        ForestPlan,
        plan::{Area, Shape, Stock},
    },
    tree::TreeModel,
};
use image::{DynamicImage, Rgb, RgbImage};
use std::{path::Path, time::Duration};

/// Height of the pictures, pixels, and their width.
const HEIGHT: u32 = 540;
const WIDTH: u32 = 720;
/// Vertical field of view, rad.
const FOV_RAD: f32 = std::f32::consts::FRAC_PI_4;
/// When the pictures are taken, s, and how long a frame takes.
const TIME_S: f64 = 40.0;
const FRAME_S: f64 = 1.0 / 60.0;
/// Trees are cards beyond this at the latest, m: farther than any change of level.
const TREES_TO_M: f32 = 1500.0;

/// What is to be drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shot {
    /// The full trees.
    Full,
    /// One of our lower levels alone: 1, 2, or 3, the card.
    Level(usize),
    /// A change of levels, the distance as a share of that at which the level ends.
    Fading(usize, f32),
    /// One of the paper's lower levels alone: 1 or 2.
    Paper(usize),
}

/// The trees and their camera.
pub struct Stand {
    app: App,
    camera: Entity,
    canvas: Handle<Image>,
    height_m: f32,
    /// Size of a tree in the picture, pixels.
    size_px: f32,
}

/// Whether a pixel shows no tree.
pub fn is_background(pixel: &Rgb<u8>) -> bool {
    pixel.0[0] > 180 && pixel.0[1] < 90 && pixel.0[2] > 180
}

impl Stand {
    /// Plants a species and waits for its levels.
    pub fn new(species: &str, season: Season) -> Result<Self, String> {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("assets/species/{species}.species.ron"));
        let text = std::fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
        let planted = Species::from_ron(&text).map_err(|error| error.to_string())?;
        let mature_years = planted.age.mature_years;
        let height_m = TreeModel::bake(&planted, mature_years, planted.seed).height_m();

        let mut app = App::new();
        app.add_plugins((capture::engine("levels", (WIDTH, HEIGHT), true), WindwoodPlugins));
        capture::begin(&mut app)?;
        let canvas = capture::canvas(&mut app, (WIDTH, HEIGHT));
        let world = app.world_mut();
        world.insert_resource(ClearColor(Color::srgb(1.0, 0.0, 1.0)));
        world.insert_resource(GlobalAmbientLight { brightness: 700.0, ..default() });
        world.insert_resource(season);
        world.insert_resource(Wind { speed: 8.0, ..default() });
        // There is but a sun.
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
        let camera = world.spawn((capture::camera(&canvas), lens, Transform::default())).id();
        let mut stand = Self { app, camera, canvas, height_m, size_px: 1.0 };
        stand.stand_back(400.0);
        stand.wait()?;
        Ok(stand)
    }

    /// Sizes on screen, pixels, at which our levels change.
    pub fn switching_px(&self) -> [f32; 3] {
        let LevelDistances { high_px, medium_px, .. } = LevelDistances::default();
        [high_px, (high_px * medium_px).sqrt(), medium_px]
    }

    /// Moves the camera to where trees have that size.
    pub fn stand_back(&mut self, size_px: f32) {
        self.size_px = size_px;
        let distance_m = self.distance_m();
        let middle_m = 0.48 * self.height_m;
        if let Some(mut at) = self.app.world_mut().get_mut::<Transform>(self.camera) {
            *at = Transform::from_xyz(0.0, middle_m, distance_m).looking_at(Vec3::Y * middle_m, Vec3::Y);
        }
    }

    /// From the camera to the trees, m.
    pub fn distance_m(&self) -> f32 {
        self.height_m * HEIGHT as f32 / (2.0 * (0.5 * FOV_RAD).tan() * self.size_px)
    }

    /// A tenth of a tree in the picture, pixels.
    pub fn tenth_px(&self) -> u32 {
        ((0.1 * self.size_px).round() as u32).max(1)
    }

    /// Left, top, width and height of what a sheet needs of the pictures.
    pub fn crop(&self) -> [u32; 4] {
        let height = (1.25 * self.size_px).min(HEIGHT as f32);
        let width = (1.3 * height).min(WIDTH as f32);
        [0.5 * (WIDTH as f32 - width), 0.5 * (HEIGHT as f32 - height), width, height].map(|length| length as u32)
    }

    /// Draws the trees at the moment.
    pub fn shoot(&mut self, shot: Shot) -> RgbImage {
        self.shoot_at(shot, TIME_S)
    }

    /// Draws them a frame later.
    pub fn shoot_later(&mut self, shot: Shot) -> RgbImage {
        self.shoot_at(shot, TIME_S + FRAME_S)
    }

    fn shoot_at(&mut self, shot: Shot, time_s: f64) -> RgbImage {
        let world = self.app.world_mut();
        let (style, distances) = detail(shot, self.size_px);
        let mut detail = world.resource_mut::<LevelOfDetail>();
        let other_style = detail.style != style;
        (detail.style, detail.distances) = (style, distances);
        *world.resource_mut::<WindClock>() = WindClock { time_s, previous_s: time_s };
        if other_style && let Err(error) = self.wait() {
            eprintln!("{error}");
        }
        capture::step(&mut self.app);
        match capture::capture(&mut self.app, &self.canvas, (WIDTH, HEIGHT)) {
            Ok(picture) => DynamicImage::ImageRgba8(picture).into_rgb8(),
            Err(error) => {
                eprintln!("{error}");
                RgbImage::new(WIDTH, HEIGHT)
            }
        }
    }

    /// Waits until the levels of a style have been made. Nothing tells it, so it is waited for as long as it ever takes.
    fn wait(&mut self) -> Result<(), String> {
        let set_active = |app: &mut App, camera, active| {
            if let Some(mut camera) = app.world_mut().get_mut::<Camera>(camera) {
                camera.is_active = active;
            }
        };
        set_active(&mut self.app, self.camera, true);
        (0..2).for_each(|_| self.app.update());
        let watcher = self.app.world_mut().get::<Transform>(self.camera).copied().unwrap_or_default();
        let watcher = self.app.world_mut().spawn((Viewpoint, watcher)).id();
        set_active(&mut self.app, self.camera, false);
        let mut rested = 0;
        for _ in 0..4000 {
            self.app.update();
            std::thread::sleep(Duration::from_millis(3));
            rested = if is_ready(self.app.world_mut()) { rested + 1 } else { 0 };
            if rested > 400 {
                break;
            }
        }
        self.app.world_mut().despawn(watcher);
        set_active(&mut self.app, self.camera, true);
        (0..4).for_each(|_| capture::step(&mut self.app));
        if rested > 400 { Ok(()) } else { Err("the trees did not get ready; see the warnings above".into()) }
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

/// The settings under which trees of a size, pixels, are drawn so.
fn detail(shot: Shot, size_px: f32) -> (LevelStyle, LevelDistances) {
    let with = |high: f32, medium: f32| LevelDistances {
        high_px: high * size_px,
        medium_px: medium * size_px,
        low_px: 0.1,
        ..default()
    };
    match shot {
        Shot::Full => (LevelStyle::Full, with(1.0, 1.0)),
        // The second level ends half way between the first and the last.
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
