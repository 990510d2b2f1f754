//! Forests as entities.

use super::changes::ForestChanges;
use crate::{
    ground::Ground,
    scatter::ForestPlan,
    setting::{SettingError, require},
};
use bevy::prelude::*;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// A forest that grows from a plan, in the world's own frame. Its trees and impostors have its `RenderLayers`.
#[derive(Component, Reflect, Clone, Debug, PartialEq)]
#[reflect(Component)]
#[require(ForestSettings, ForestChanges, Transform, Visibility)]
pub struct Forest {
    /// Where what grows; hot reloads.
    pub plan: Handle<ForestPlan>,
}

impl Forest {
    /// A forest after that plan.
    pub fn new(plan: Handle<ForestPlan>) -> Self {
        Self { plan }
    }
}

/// How far trees stand as entities, and how much is done for them in a frame.
#[derive(Component, Reflect, Clone, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Component, Default)]
#[serde(default, deny_unknown_fields)]
pub struct ForestSettings {
    /// Folder of the species' files in the assets: `oak` is `FOLDER/oak.species.ron`.
    pub species_folder: String,
    /// Trees stand as far as this from a viewpoint. units: m, domain: \[0, 20000\].
    pub trees_to_m: f32,
    /// Beyond, trees are drawn as impostors as far as this; 0 for none. units: m, domain: \[0, 50000\].
    pub far_to_m: f32,
    /// Near cells whose trees are made ready at once, and tiles whose impostors are. domain: \[1, 64\].
    pub cells_at_once: u32,
    /// Trees that come in a frame, at most. domain: \[1, 100000\].
    pub trees_per_frame: u32,
    /// Trees of cells nearer than this to a viewpoint are [`Articulated`](crate::tree::Articulated); 0 for none. It costs work
    /// every frame for each of them. units: m, domain: \[0, 1000\].
    pub articulated_to_m: f32,
    /// Whether near cells feel the wind: each has a [`WindCell`](crate::wind::WindCell) in its middle, 10 m over the ground.
    pub wind_cells: bool,
    /// Whether near trees that are felled [fall](super::FallingTree), and lie there until nobody is near any longer. Otherwise they vanish.
    pub felled_trees_fall: bool,
}

impl Default for ForestSettings {
    fn default() -> Self {
        Self {
            species_folder: "species".into(),
            trees_to_m: 300.0,
            far_to_m: 2500.0,
            cells_at_once: 4,
            trees_per_frame: 64,
            articulated_to_m: 0.0,
            wind_cells: false,
            felled_trees_fall: true,
        }
    }
}

impl ForestSettings {
    /// Checks every setting.
    ///
    /// # Errors
    /// [`SettingError`] for the first that is wrong.
    pub fn validate(&self) -> Result<(), SettingError> {
        if self.species_folder.contains(['\\', ':']) {
            return Err(SettingError::new("species_folder", &self.species_folder, "a folder of the assets"));
        }
        require("trees_to_m", self.trees_to_m, 0.0..=2e4)?;
        require("far_to_m", self.far_to_m, 0.0..=5e4)?;
        require("cells_at_once", self.cells_at_once as f32, 1.0..=64.0)?;
        require("trees_per_frame", self.trees_per_frame as f32, 1.0..=1e5)?;
        require("articulated_to_m", self.articulated_to_m, 0.0..=1e3)
    }
}

/// Ground of your own for a [`Forest`], in place of the world's [`Terrain`](crate::terrain::Terrain). It is read on background threads. Where
/// it panics that is told once, with an error, and the tile of cells that was being planted stays bare.
#[derive(Component, Clone)]
pub struct ForestGround(pub Arc<dyn Ground>);

/// A cell of a [`Forest`] whose trees are entities: its children. A child of the forest.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq)]
pub struct ForestCell(pub IVec2);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn defaults_are_valid_and_slips_are_named() {
        ForestSettings::default().validate().unwrap();
        let error = ForestSettings { trees_to_m: f32::NAN, ..default() }.validate().unwrap_err().to_string();
        assert_eq!(error, "`trees_to_m` is NaN, but must be 0 to 20000");
        let error = ForestSettings { trees_per_frame: 0, ..default() }.validate().unwrap_err().to_string();
        assert!(error.starts_with("`trees_per_frame` is 0"), "{error}");
    }
}
