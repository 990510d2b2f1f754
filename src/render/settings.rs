//! Settings of level of detail.

use crate::{
    lod::{LodBakeSettings, LodScreenSizes},
    setting::{SettingError, require, valid_or_last},
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
    pub screen_sizes: LodScreenSizes,
    /// Over this share of a distance, to either side, one level fades into the next. domain: \[0.02, 0.3\].
    pub fade: f32,
    /// The same between a tree's last level and its impostor, which differ by more than two levels do. domain: \[0.02, 0.3\].
    pub impostor_fade: f32,
    /// Beyond so many of a tree's heights its impostor casts its shadow in the maps of suns, where it has one. Masked leaves in shadow maps
    /// are what a forest costs most. domain: \[0.5, 1000\].
    pub shadow_impostors_from_heights: f32,
    /// Trees whose level changes in a frame, at most, and half as many that get their first; each takes some microseconds.
    /// domain: \[1, 1000000\].
    pub changes_per_frame: u32,
    /// How lower levels are made. A change makes them all anew, in the background.
    pub bake: LodBakeSettings,
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
        Self {
            style: LevelStyle::default(),
            screen_sizes: LodScreenSizes::default(),
            fade: 0.05,
            impostor_fade: 0.1,
            shadow_impostors_from_heights: 1.0,
            changes_per_frame: 128,
            bake: LodBakeSettings::default(),
        }
    }
}

impl LevelOfDetail {
    /// Checks every field.
    ///
    /// # Errors
    /// The first field outside its domain.
    pub fn validate(&self) -> Result<(), SettingError> {
        self.screen_sizes.validate().map_err(|error| error.inside("screen_sizes"))?;
        require("fade", self.fade, 0.02..=0.3)?;
        require("impostor_fade", self.impostor_fade, 0.02..=0.3)?;
        require("shadow_impostors_from_heights", self.shadow_impostors_from_heights, 0.5..=1000.0)?;
        require("changes_per_frame", self.changes_per_frame as f32, 1.0..=1e6)?;
        self.bake.validate().map_err(|error| error.inside("bake"))
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
    active.0 = valid_or_last("level of detail", &*wanted, LevelOfDetail::validate, Some(&active.0));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lod::ImpostorSettings;

    #[test]
    fn defaults_are_valid_and_errors_name_the_field() {
        LevelOfDetail::default().validate().unwrap();
        let error = LevelOfDetail { fade: 0.9, ..default() }.validate().unwrap_err().to_string();
        assert_eq!(error, "`fade` is 0.9, but must be 0.02 to 0.3");
        let screen_sizes = LodScreenSizes { quality: 0.0, ..default() };
        let error = LevelOfDetail { screen_sizes, ..default() }.validate().unwrap_err().to_string();
        assert!(error.starts_with("`screen_sizes.quality` is 0"), "{error}");
        let bake = LodBakeSettings { impostor: ImpostorSettings { rays: 9, ..default() }, ..default() };
        let error = LevelOfDetail { bake, ..default() }.validate().unwrap_err().to_string();
        assert_eq!(error, "`bake.impostor.rays` is 9, but must be 1 to 4");
    }
}
