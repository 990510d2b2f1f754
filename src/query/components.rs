//! What a game gives entities to be told of trees and wind, and what trees are given.

use crate::{setting::SettingError, setting::require, tree::body::TreeCapsule};
use bevy::prelude::*;

/// Hears the wind: a value for each sound that a game mixes, at this entity's place. Written in
/// [`WindwoodSystems::Query`](crate::WindwoodSystems::Query).
///
/// What it costs depends on the trees within some 30 m.
#[derive(Component, Reflect, Clone, Copy, Debug, Default, PartialEq)]
#[reflect(Component, Default)]
#[require(Transform)]
pub struct WindListener {
    /// World height of the ground below, m. `None`: that of the nearest tree's foot, and 0 where there is none.
    pub ground_m: Option<f32>,
    /// The wind here, among the trees about, m/s in world axes.
    pub velocity: Vec3,
    /// Mean speed of the wind here, m/s.
    pub mean_m_s: f32,
    /// By how much the wind is faster than that now, m/s: below 0 in a lull.
    pub gust_m_s: f32,
    /// How strong the gust is, 0 to 1: 1 at three standard deviations. It follows within 0.2 s, and falls in 1 s.
    pub gust_level: f32,
    /// How loud the leaves about are, 0 to 1, linear in decibels: 0 at 20 dB(A), 1 at 70 dB(A). It follows within 0.1 s, and falls in
    /// 0.4 s.
    pub rustle_level: f32,
}

/// How trees about the viewers are given [`TreeColliders`].
#[derive(Resource, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Resource, Default)]
pub struct TreeColliderSettings {
    /// Trees nearer than this to a viewpoint have colliders; 0 for none. units: m, domain: \[0, 1000\].
    pub to_m: f32,
    /// Wood that is thinner than this at its root has none. units: m, domain: \[0, 10\].
    pub least_radius_m: f32,
    /// Trees that are given theirs in a frame, at most. domain: \[1, 10000\].
    pub trees_per_frame: u32,
}

impl Default for TreeColliderSettings {
    fn default() -> Self {
        Self { to_m: 0.0, least_radius_m: 0.05, trees_per_frame: 32 }
    }
}

impl TreeColliderSettings {
    /// Checks every setting.
    ///
    /// # Errors
    /// [`SettingError`] for the first that is wrong.
    pub fn validate(&self) -> Result<(), SettingError> {
        require("to_m", self.to_m, 0.0..=1e3)?;
        require("least_radius_m", self.least_radius_m, 0.0..=10.0)?;
        require("trees_per_frame", self.trees_per_frame, 1..=10_000)
    }
}

/// The colliders of a tree: its trunk and main limbs at rest, as capsules in its own coordinates. Trees about the viewers are given them
/// as [`TreeColliderSettings`] say.
///
/// They go with the tree's `Transform`, as when it falls, and do not sway: [`TreeRays::capsules`](super::TreeRays::capsules) gives the
/// same in the wind.
#[derive(Component, Clone, Debug, Default, PartialEq)]
#[component(immutable)]
pub struct TreeColliders {
    /// The capsules, tree-local.
    pub capsules: Vec<TreeCapsule>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn defaults_are_valid_and_slips_are_named() {
        TreeColliderSettings::default().validate().unwrap();
        let error = TreeColliderSettings { to_m: f32::NAN, ..default() }.validate().unwrap_err().to_string();
        assert_eq!(error, "`to_m` is NaN, but must be 0 to 1000");
        let error = TreeColliderSettings { trees_per_frame: 0, ..default() }.validate().unwrap_err().to_string();
        assert_eq!(error, "`trees_per_frame` is 0, but must be 1 to 10000");
    }
}
