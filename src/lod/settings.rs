//! What can be chosen about lower levels of detail, and the limits that keep every choice finite.

use crate::setting::{SettingError, require};
use bevy::reflect::Reflect;
use serde::{Deserialize, Serialize};
use std::ops::RangeInclusive;

/// The most levels of one tree that are meshes of its own: the grown tree and what it is decimated to.
pub const MOST_LEVELS: usize = 3;
const MOST_DECIMATIONS: usize = MOST_LEVELS - 1;
/// Least share of the sprays that a decimated tree keeps.
pub(crate) const LEAST_LEAF_SHARE: f32 = 0.2;

/// All lower levels of a tree.
#[derive(Clone, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct LodBakeSettings {
    /// Decimated meshes, from the finest to the coarsest: none to 2.
    pub decimations: Vec<Decimation>,
    /// The envelope of leaves.
    pub envelope: EnvelopeSettings,
    /// The atlas of impostors.
    pub impostor: ImpostorSettings,
}

/// How the meshes of a tree are decimated.
#[derive(Clone, Copy, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Decimation {
    /// Branches that are thinner at their root are left out, and all that grows on them. Radius, units: m, domain: 0 (none
    /// is) to 10.
    pub least_radius_m: f32,
    /// Share of the sprays of leaves that stay, enlarged so that they have the area of all. domain: 0.2 to 1: the bounds of trees have
    /// room for no larger leaves.
    pub leaf_share: f32,
}

/// The envelope of leaves, its texture and the cone of the trunk.
#[derive(Clone, Copy, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct EnvelopeSettings {
    /// Texels around the crown. domain: a power of two, 8 to 1024.
    pub width_texels: u32,
    /// Texels along its height, in each frame. domain: a power of two, 8 to 1024.
    pub height_texels: u32,
    /// Frames in the animation of its sway. domain: 1 (at rest) to 16.
    pub frames: u32,
    /// Rays of a texel, each way. domain: 1 to 8.
    pub rays: u32,
    /// Share of the crown that the envelope, while it is smooth, encloses. domain: 0.5 to 1.
    pub enclosed: f32,
    /// Vertices around the envelope. domain: 3 to 64.
    pub sides: u32,
    /// Segments of the envelope from its base to its top. domain: 2 to 64.
    pub segments: u32,
    /// How far its vertices leave the smooth envelope at random, to both sides, as a share of the radius. domain: 0 to 0.5.
    pub roughness: f32,
    /// Another seed is another roughness.
    pub seed: u64,
}

/// The atlas of impostors.
#[derive(Clone, Copy, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ImpostorSettings {
    /// Views along a side of the grid of directions. domain: a power of two, 2 to 32.
    pub views_per_side: u32,
    /// Longer side of a view's tile in the atlas, texels; its coverage has twice as many. domain: a power of two, 16 to 512.
    pub tile_texels: u32,
    /// Rays of a texel of the coverage, each way. domain: 1 to 4.
    pub rays: u32,
}

impl Default for LodBakeSettings {
    /// Two decimations, for trees of half and a quarter of a screen, before the envelope and the impostors.
    fn default() -> Self {
        Self {
            decimations: vec![
                Decimation { least_radius_m: 0.02, leaf_share: 0.5 },
                Decimation { least_radius_m: 0.05, leaf_share: 0.2 },
            ],
            envelope: EnvelopeSettings::default(),
            impostor: ImpostorSettings::default(),
        }
    }
}

impl Default for Decimation {
    /// The full tree.
    fn default() -> Self {
        Self { least_radius_m: 0.0, leaf_share: 1.0 }
    }
}

impl Default for EnvelopeSettings {
    fn default() -> Self {
        Self {
            width_texels: 128,
            height_texels: 64,
            frames: 4,
            rays: 2,
            enclosed: 0.95,
            sides: 12,
            segments: 8,
            roughness: 0.08,
            seed: 0,
        }
    }
}

impl Default for ImpostorSettings {
    /// Views some 15 degrees apart.
    fn default() -> Self {
        Self { views_per_side: 8, tile_texels: 64, rays: 1 }
    }
}

impl LodBakeSettings {
    /// Checks every field.
    ///
    /// # Errors
    /// The first field outside its domain.
    pub fn validate(&self) -> Result<(), SettingError> {
        if self.decimations.len() > MOST_DECIMATIONS {
            let allowed = format!("at most {MOST_DECIMATIONS} long");
            return Err(SettingError::new("decimations", format!("{} long", self.decimations.len()), allowed));
        }
        for (index, decimation) in self.decimations.iter().enumerate() {
            decimation.validate().map_err(|error| error.inside(&format!("decimations[{index}]")))?;
        }
        self.envelope.validate().map_err(|error| error.inside("envelope"))?;
        self.impostor.validate().map_err(|error| error.inside("impostor"))
    }
}

impl Decimation {
    fn validate(&self) -> Result<(), SettingError> {
        require("least_radius_m", self.least_radius_m, 0.0..=10.0)?;
        require("leaf_share", self.leaf_share, LEAST_LEAF_SHARE..=1.0)
    }
}

impl EnvelopeSettings {
    fn validate(&self) -> Result<(), SettingError> {
        require_power_of_two("width_texels", self.width_texels, 8..=1024)?;
        require_power_of_two("height_texels", self.height_texels, 8..=1024)?;
        require("frames", self.frames as f32, 1.0..=16.0)?;
        require("rays", self.rays as f32, 1.0..=8.0)?;
        require("enclosed", self.enclosed, 0.5..=1.0)?;
        require("sides", self.sides as f32, 3.0..=64.0)?;
        require("segments", self.segments as f32, 2.0..=64.0)?;
        require("roughness", self.roughness, 0.0..=0.5)
    }
}

impl ImpostorSettings {
    fn validate(&self) -> Result<(), SettingError> {
        require_power_of_two("views_per_side", self.views_per_side, 2..=32)?;
        require_power_of_two("tile_texels", self.tile_texels, 16..=512)?;
        require("rays", self.rays as f32, 1.0..=4.0)
    }
}

fn require_power_of_two(field: &str, value: u32, allowed: RangeInclusive<u32>) -> Result<(), SettingError> {
    if allowed.contains(&value) && value.is_power_of_two() {
        return Ok(());
    }
    let allowed = format!("a power of two, {} to {}", allowed.start(), allowed.end());
    Err(SettingError::new(field, value, allowed))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn defaults_are_valid() {
        LodBakeSettings::default().validate().unwrap();
    }

    #[test]
    fn errors_name_the_path_of_the_field() {
        let mut settings = LodBakeSettings::default();
        settings.impostor.tile_texels = 100;
        let error = settings.validate().unwrap_err().to_string();
        assert_eq!(error, "`impostor.tile_texels` is 100, but must be a power of two, 16 to 512");
        settings.envelope.enclosed = f32::NAN;
        let error = settings.validate().unwrap_err().to_string();
        assert_eq!(error, "`envelope.enclosed` is NaN, but must be 0.5 to 1");
        settings.envelope.frames = 17;
        let error = settings.validate().unwrap_err().to_string();
        assert_eq!(error, "`envelope.frames` is 17, but must be 1 to 16");
        settings.envelope.frames = 0;
        let error = settings.validate().unwrap_err().to_string();
        assert_eq!(error, "`envelope.frames` is 0, but must be 1 to 16");
        settings.decimations[1].leaf_share = 0.0;
        let error = settings.validate().unwrap_err().to_string();
        assert_eq!(error, "`decimations[1].leaf_share` is 0, but must be 0.2 to 1");
        settings.decimations = vec![Decimation::default(); 3];
        let error = settings.validate().unwrap_err().to_string();
        assert_eq!(error, "`decimations` is 3 long, but must be at most 2 long");
    }

    #[test]
    fn settings_survive_writing_and_reading() {
        let settings = LodBakeSettings::default();
        let written = ron::to_string(&settings).unwrap();
        assert_eq!(ron::from_str::<LodBakeSettings>(&written).unwrap(), settings);
        assert_eq!(ron::from_str::<LodBakeSettings>("()").unwrap(), settings);
    }
}
