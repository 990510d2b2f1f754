//! Settings of level of detail.

use crate::{
    lod::LodScreenSizes,
    setting::{SettingError, require},
};
use bevy::prelude::*;
use serde::{Deserialize, Serialize};

/// How much of a tree is drawn at which size on screen.
#[derive(Resource, Reflect, Clone, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Resource, Default)]
#[serde(default, deny_unknown_fields)]
pub struct LevelOfDetail {
    /// What the levels are.
    pub style: LevelStyle,
    /// Where they end, and the quality in one number.
    pub distances: LodScreenSizes,
    /// Over this share of a distance, to either side, one level fades into the next. domain: \[0.02, 0.3\].
    pub fade: f32,
    /// Trees whose level changes in a frame, at most, and half as many that get their first; each takes some microseconds.
    /// domain: \[1, 1000000\].
    pub changes_per_frame: u32,
}

/// What stands for a tree that is too small on screen to be drawn in full.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum LevelStyle {
    /// Its own meshes, thinned twice, and in a [`Forest`](crate::forest) impostors beyond.
    #[default]
    Thinned,
    /// Setas, Gomes & Rebordão's: a trunk and an envelope of leaves, beyond it four plain polygons.
    Paper,
    /// Nothing: it is drawn in full as far as it is an entity.
    Full,
}

impl Default for LevelOfDetail {
    fn default() -> Self {
        Self { style: LevelStyle::default(), distances: LodScreenSizes::default(), fade: 0.1, changes_per_frame: 128 }
    }
}

impl LevelOfDetail {
    /// Checks every field.
    ///
    /// # Errors
    /// The first field outside its domain.
    pub fn validate(&self) -> Result<(), SettingError> {
        self.distances.validate().map_err(|error| error.inside("distances"))?;
        require("fade", self.fade, 0.02..=0.3)?;
        require("changes_per_frame", self.changes_per_frame as f32, 1.0..=1e6)
    }
}

/// The last valid [`LevelOfDetail`].
#[derive(Resource, Default)]
pub(crate) struct ActiveLevelOfDetail(pub LevelOfDetail);

/// Takes changed settings over, if they are valid.
pub(crate) fn apply_level_of_detail(wanted: Res<LevelOfDetail>, mut active: ResMut<ActiveLevelOfDetail>) {
    if !wanted.is_changed() {
        return;
    }
    match wanted.validate() {
        Ok(()) => active.0 = wanted.clone(),
        Err(error) => warn!("level of detail: {error}; {:?} stays", active.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn defaults_are_valid_and_errors_name_the_field() {
        LevelOfDetail::default().validate().unwrap();
        let error = LevelOfDetail { fade: 0.9, ..default() }.validate().unwrap_err().to_string();
        assert_eq!(error, "`fade` is 0.9, but must be 0.02 to 0.3");
        let distances = LodScreenSizes { quality: 0.0, ..default() };
        let error = LevelOfDetail { distances, ..default() }.validate().unwrap_err().to_string();
        assert!(error.starts_with("`distances.quality` is 0"), "{error}");
    }
}
