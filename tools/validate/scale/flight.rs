//! The flight over the forest.

use super::{FRAMES_PER_S, SIDE_M, SPEED_M_S};
use bevy::prelude::*;
use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};

/// A camera that flies in smooth random curves, the same in every run.
pub struct Flight {
    pub camera: Entity,
    at: Transform,
    turn_rad_s: f32,
    /// The turn rate that it changes to, and for how much longer.
    wanted_rad_s: f32,
    left_s: f32,
    random: Xoshiro256PlusPlus,
}

impl Flight {
    /// Spawns the camera in the middle of the forest.
    pub fn start(app: &mut App) -> Self {
        let at = Transform::from_xyz(0.0, 15.0, 0.0);
        let lens = PerspectiveProjection { aspect_ratio: 16.0 / 9.0, far: 1.5 * SIDE_M, ..default() };
        let camera = app.world_mut().spawn((Camera3d::default(), Projection::Perspective(lens), at)).id();
        let random = Xoshiro256PlusPlus::seed_from_u64(20);
        Self { camera, at, turn_rad_s: 0.0, wanted_rad_s: 0.0, left_s: 0.0, random }
    }

    /// Moves the camera by the way of a frame.
    pub fn advance(&mut self, app: &mut App) {
        let frame_s = 1.0 / FRAMES_PER_S;
        self.left_s -= frame_s;
        if self.left_s <= 0.0 {
            (self.wanted_rad_s, self.left_s) =
                (self.random.random_range(-0.6..0.6), self.random.random_range(1.0..4.0));
        }
        self.turn_rad_s += (self.wanted_rad_s - self.turn_rad_s) * frame_s / 0.5;
        self.at.rotate_y(self.turn_rad_s * frame_s);
        self.at.translation += self.at.forward() * SPEED_M_S * frame_s;
        self.place(app, |_| ());
    }

    /// Changes the transform of the camera.
    pub fn place(&mut self, app: &mut App, change: impl FnOnce(&mut Transform)) {
        change(&mut self.at);
        if let Some(mut at) = app.world_mut().get_mut::<Transform>(self.camera) {
            *at = self.at;
        }
    }
}
