//! What can be chosen about an export.

use crate::{
    lod::LodBakeSettings,
    setting::{SettingError, require},
};
use bevy::reflect::Reflect;
use serde::{Deserialize, Serialize};

/// The most joints that a skin has: so many bytes tell them apart, and engines pose them without a second buffer.
pub const MOST_JOINTS: u32 = 255;

/// How a tree is exported.
#[derive(Clone, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ExportSettings {
    /// Time of the year that is baked into colours and masks: 0 midwinter, 0.5 midsummer. domain: 0 to 1.
    pub year: f32,
    /// The tree's own shade. domain: -1 to 1.
    pub tint: f32,
    /// Which levels of detail.
    pub levels: ExportLevels,
    /// How leaves are seen from behind, in a GLB.
    pub leaf_sides: LeafSides,
    /// How the lower levels are made.
    pub bake: LodBakeSettings,
    /// How the sway is baked.
    pub motion: MotionSettings,
}

/// Which levels of detail are exported.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Reflect, Serialize, Deserialize)]
pub enum ExportLevels {
    /// One: 0 is the full tree. domain: 0 to the number of `bake.decimations`.
    One(u32),
    /// All, the lower ones behind `MSFT_lod`: programs that do not know it draw the full tree.
    Lod,
    /// All, as nodes of the scene, which the program that reads them is to choose from: `NAME_LOD0`, `NAME_LOD1` and so on.
    Nodes,
}

/// How leaves are seen from behind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Reflect, Serialize, Deserialize)]
pub enum LeafSides {
    /// Every triangle of a leaf is there twice, once for each side, on the same vertices. Both sides have the normals of the upper one, so
    /// that light models the crown as it does in this crate's own pictures.
    #[default]
    Twice,
    /// Once, in a material that is double-sided. Programs turn its normals for the side that is seen, so that crowns are darker.
    DoubleSided,
}

/// How the sway of a tree becomes a skeleton and an animation.
#[derive(Clone, Copy, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct MotionSettings {
    /// Joints of the skeleton, the one in the ground among them. domain: 2 to 255.
    pub joints: u32,
    /// Length of the loop. A longer one than the wind's period becomes this period, which closes by itself. units: s, domain: 1 to 3600.
    pub loop_s: f32,
    /// Over so much of its end the loop goes over into its beginning. units: s, domain: 0.1 to half of `loop_s`.
    pub fade_s: f32,
    /// Keys a second. domain: 2 to 120.
    pub rate_hz: f32,
    /// Time of the wind at which the loop begins. units: s, domain: 0 to 1e6.
    pub start_s: f64,
}

impl Default for ExportSettings {
    /// A full tree in summer.
    fn default() -> Self {
        Self {
            year: 0.55,
            tint: 0.0,
            levels: ExportLevels::One(0),
            leaf_sides: LeafSides::default(),
            bake: LodBakeSettings::default(),
            motion: MotionSettings::default(),
        }
    }
}

impl Default for MotionSettings {
    /// Sixteen seconds: some sways of a tall tree, and a gust.
    fn default() -> Self {
        Self { joints: 64, loop_s: 16.0, fade_s: 4.0, rate_hz: 30.0, start_s: 0.0 }
    }
}

impl ExportSettings {
    /// Checks every field.
    ///
    /// # Errors
    /// The first field outside its domain.
    pub fn validate(&self) -> Result<(), SettingError> {
        require("year", self.year, 0.0..=1.0)?;
        require("tint", self.tint, -1.0..=1.0)?;
        self.bake.validate().map_err(|error| error.inside("bake"))?;
        if let ExportLevels::One(level) = self.levels {
            require("levels", level, 0..=self.bake.decimations.len() as u32)?;
        }
        self.motion.validate().map_err(|error| error.inside("motion"))
    }
}

impl MotionSettings {
    fn validate(&self) -> Result<(), SettingError> {
        require("joints", self.joints, 2..=MOST_JOINTS)?;
        require("loop_s", self.loop_s, 1.0..=3600.0)?;
        require("fade_s", self.fade_s, 0.1..=0.5 * self.loop_s)?;
        require("rate_hz", self.rate_hz, 2.0..=120.0)?;
        require("start_s", self.start_s, 0.0..=1e6)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_name_the_field_the_value_and_what_is_allowed() {
        let refused = |change: fn(&mut ExportSettings)| {
            let mut settings = ExportSettings::default();
            change(&mut settings);
            settings.validate().unwrap_err().to_string()
        };
        assert_eq!(refused(|it| it.year = f32::NAN), "`year` is NaN, but must be 0 to 1");
        assert_eq!(refused(|it| it.levels = ExportLevels::One(3)), "`levels` is 3, but must be 0 to 2");
        assert_eq!(refused(|it| it.motion.joints = 256), "`motion.joints` is 256, but must be 2 to 255");
        assert_eq!(refused(|it| it.motion.fade_s = 9.0), "`motion.fade_s` is 9, but must be 0.1 to 8");
        assert_eq!(refused(|it| it.bake.impostor.rays = 9), "`bake.impostor.rays` is 9, but must be 1 to 4");
        ExportSettings::default().validate().unwrap();
    }

    #[test]
    fn settings_survive_writing_and_reading() {
        let settings = ExportSettings { levels: ExportLevels::Lod, year: 0.8, ..ExportSettings::default() };
        let written = ron::to_string(&settings).unwrap();
        assert_eq!(ron::from_str::<ExportSettings>(&written).unwrap(), settings);
    }
}
