//! When trees wake up and sleep.

use crate::setting::{SettingError, require};
use bevy::prelude::*;

/// When trees feel what a game does to them, and when they have come to rest.
#[derive(Resource, Reflect, Clone, Debug, PartialEq)]
#[reflect(Resource, Default)]
pub struct LiveSettings {
    /// A tree wakes up where a [`WindSource`](crate::wind::WindSource) blows so fast in its crown, m/s; 0.01 to 50.
    pub wake_speed_m_s: f32,
    /// A tree sleeps once no beam's tip is, or comes, so far out of where the wind alone would have it, rad; 0.000001 to 0.1.
    pub sleep_angle_rad: f32,
    /// Trees that are awake at once, at most; 0 to 65,535. Others are not touched.
    pub most_trees: u32,
}

impl Default for LiveSettings {
    fn default() -> Self {
        Self { wake_speed_m_s: 0.5, sleep_angle_rad: 3e-4, most_trees: 4096 }
    }
}

impl LiveSettings {
    /// Checks every field.
    ///
    /// # Errors
    /// The first field outside its domain.
    pub fn validate(&self) -> Result<(), SettingError> {
        require("wake_speed_m_s", self.wake_speed_m_s, 0.01..=50.0)?;
        require("sleep_angle_rad", self.sleep_angle_rad, 1e-6..=0.1)?;
        require("most_trees", self.most_trees, 0..=65_535)
    }
}
