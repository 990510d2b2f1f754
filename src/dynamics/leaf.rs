//! How leaves answer the wind.

use bevy::reflect::Reflect;
use serde::{Deserialize, Serialize};

/// How far and how fast the leaves of a species turn and flutter.
#[derive(Clone, Copy, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct LeafResponse {
    /// Share of the way a leaf turns its face out of a strong wind, 0 to 1.
    pub turn: f32,
    /// Wind speed at which leaves begin to move, m/s.
    pub onset_speed_m_s: f32,
    /// Wind speed at which they are fully turned, m/s.
    pub full_speed_m_s: f32,
    /// Amplitude of the flutter, radians.
    pub flutter_angle_rad: f32,
    /// Frequency of the flutter, Hz.
    pub flutter_frequency_hz: f32,
}

impl Default for LeafResponse {
    fn default() -> Self {
        Self {
            turn: 0.6,
            onset_speed_m_s: 1.0,
            full_speed_m_s: 12.0,
            flutter_angle_rad: 0.25,
            flutter_frequency_hz: 4.0,
        }
    }
}
