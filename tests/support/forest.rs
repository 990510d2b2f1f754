//! A small forest of firs in front of a camera.

use super::{capture, covered, headless_app, light_plainly, update_until};
use bevy::{prelude::*, render::render_resource::WgpuLimits};
use bevy_windwood::{
    prelude::*,
    scatter::{
        ForestPlan,
        plan::{Area, Shape, Stock},
    },
};
use image::RgbaImage;
use std::time::Duration;

const SIZE: (u32, u32) = (320, 180);

/// A forest, its camera, and the target of the camera.
pub struct TestForest {
    pub app: App,
    pub camera: Entity,
    target: Handle<Image>,
}

impl TestForest {
    /// Firs in a square of 400 m around the origin on level ground, in cells of 32 m. All of them are drawn. The device is held
    /// to `limits`.
    pub fn new(settings: ForestSettings, limits: Option<WgpuLimits>) -> Self {
        let mut app = headless_app(Duration::ZERO, limits);
        capture::begin(&mut app).expect("a graphics device");
        let target = capture::target(&mut app, SIZE);
        let area = Area {
            shape: Shape::Rectangle { min_m: [-200.0; 2], max_m: [200.0; 2] },
            density_per_ha: 25.0,
            stock: vec![Stock { species: "fir".into(), age_years: 60.0, age_spread_years: 10.0, ..default() }],
            ..default()
        };
        let plan = ForestPlan { seed: 3, cell_m: 32.0, areas: vec![area], ..default() };
        let world = app.world_mut();
        let plan = world.resource_mut::<Assets<ForestPlan>>().add(plan);
        light_plainly(world);
        world.spawn((Forest::new(plan), ForestSettings { trees_per_frame: 10_000, cells_at_once: 64, ..settings }));
        let eye = Transform::from_xyz(0.0, 12.0, 0.0).looking_to(Vec3::NEG_Z, Vec3::Y);
        let camera = world.spawn((capture::camera(&target), eye)).id();
        let ready = update_until(&mut app, |world| {
            world.resource::<ActiveSway>().is_ready() && capture::forests_are_drawn(world)
        });
        assert!(ready, "the forest was not drawn in time");
        Self { app, camera, target }
    }

    /// Moves the camera.
    pub fn look(&mut self, from: Vec3, towards: Vec3) {
        *self.app.world_mut().get_mut::<Transform>(self.camera).expect("a camera") =
            Transform::from_translation(from).looking_to(towards, Vec3::Y);
    }

    /// A picture, after some frames in which everything settles.
    pub fn picture(&mut self) -> RgbaImage {
        (0..6).for_each(|_| capture::step(&mut self.app));
        capture::capture(&mut self.app, &self.target, SIZE).expect("a picture")
    }

    /// Share of the picture that is not background.
    pub fn covered(&mut self) -> f32 {
        covered(&self.picture())
    }
}
