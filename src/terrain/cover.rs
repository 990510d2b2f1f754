//! What grows on the ground.

use bevy::math::DVec2;

/// What grows on the ground, seen from afar.
pub trait Cover: Send + Sync {
    /// Share of the ground about a place that is under trees, 0 to 1.
    fn share(&self, place: DVec2) -> f32;
}
