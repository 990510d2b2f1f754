//! The settings of a fire, and their limits.

use crate::setting::{SettingError, require, require_colour};
use bevy::reflect::Reflect;
use serde::{Deserialize, Serialize};

/// Copies are at least this share of the whole, which makes 19,060 rhombs.
const SMALLEST_SHARE: f32 = 0.1;

/// The shape of a fire: Zaharia's seed and where its recursion ends.
#[derive(Clone, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct FireShape {
    /// Longest diagonal of the base rhomb, m: 0.01 to 20. A fire burns somewhat higher than it is wide.
    pub size_m: f32,
    /// Copies of the seed whose own size would be smaller, m, are left out: a tenth of `size_m` to `size_m`.
    pub threshold_m: f32,
    /// Shortest diagonal of the base rhomb over its longest: 0.05 to 1.
    pub base_ratio: f32,
    /// Longest diagonal of the three upright rhombs over that of the base: 0.1 to 3.
    pub tongue_length: f32,
    /// Shortest diagonal of the upright rhombs over their longest: 0.05 to 1.
    pub tongue_ratio: f32,
    /// Another seed is another fire of the same kind.
    pub seed: u64,
}

impl Default for FireShape {
    /// A camp fire.
    fn default() -> Self {
        Self { size_m: 0.8, threshold_m: 0.16, base_ratio: 0.8, tongue_length: 1.0, tongue_ratio: 0.38, seed: 0 }
    }
}

/// The colours, brightness and light of a fire. Colours are linear red, green, blue, each 0 to 1.
#[derive(Clone, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct FireLook {
    /// Colour at the centre of the base: reddish.
    pub inner_colour: [f32; 3],
    /// Colour towards the boundary: yellowish.
    pub outer_colour: [f32; 3],
    /// Luminance of one tongue where it is thickest, cd/m^2: 0 to 1e6. Where many lie behind one another a fire is as many
    /// times as bright.
    pub luminance_cd_m2: f32,
    /// Light that the fire gives, lm: 0 to 1e7. A candle gives 12, a camp fire some 10,000. 0 spawns no light.
    pub light_lm: f32,
    /// Its colour.
    pub light_colour: [f32; 3],
    /// Whether things cast shadows in its light.
    pub casts_shadows: bool,
    /// How often tongues rise, Hz: 0 to 10. Fires puff with 1.5 over the root of their width in metres (Cetegen & Ahmed 1993).
    pub flicker_hz: f32,
    /// How strongly the light flickers, 0 to 1: the most by which it differs from its mean, as a share.
    pub flicker_depth: f32,
    /// Wind at the fire over the wind at 10 m above open ground: 0 to 1. By the logarithmic profile 0.35 at half a metre over
    /// low growth; less behind a shelter.
    pub exposure: f32,
    /// Glowing sparks in the air at once: 0 to 1000.
    pub embers: u32,
    /// Strength of the glow around the flames, 0 to 1: light that is scattered in smoke, air and eye.
    pub glow: f32,
}

impl Default for FireLook {
    fn default() -> Self {
        Self {
            inner_colour: [1.0, 0.11, 0.004],
            outer_colour: [1.0, 0.34, 0.03],
            luminance_cd_m2: 60.0,
            light_lm: 14_000.0,
            light_colour: [1.0, 0.40, 0.10],
            casts_shadows: false,
            flicker_hz: 1.7,
            flicker_depth: 0.3,
            exposure: 0.3,
            embers: 24,
            glow: 0.3,
        }
    }
}

impl FireShape {
    /// Checks every field.
    ///
    /// # Errors
    /// The first field outside its domain.
    pub fn validate(&self) -> Result<(), SettingError> {
        require("size_m", self.size_m, 0.01..=20.0)?;
        require("threshold_m", self.threshold_m, SMALLEST_SHARE * self.size_m..=self.size_m)?;
        require("base_ratio", self.base_ratio, 0.05..=1.0)?;
        require("tongue_length", self.tongue_length, 0.1..=3.0)?;
        require("tongue_ratio", self.tongue_ratio, 0.05..=1.0)
    }
}

impl FireLook {
    /// Checks every field.
    ///
    /// # Errors
    /// The first field outside its domain.
    pub fn validate(&self) -> Result<(), SettingError> {
        require_colour("inner_colour", self.inner_colour)?;
        require_colour("outer_colour", self.outer_colour)?;
        require("luminance_cd_m2", self.luminance_cd_m2, 0.0..=1e6)?;
        require("light_lm", self.light_lm, 0.0..=1e7)?;
        require_colour("light_colour", self.light_colour)?;
        require("flicker_hz", self.flicker_hz, 0.0..=10.0)?;
        require("flicker_depth", self.flicker_depth, 0.0..=1.0)?;
        require("exposure", self.exposure, 0.0..=1.0)?;
        if self.embers > 1000 {
            return Err(SettingError::new("embers", self.embers, "0 to 1000"));
        }
        require("glow", self.glow, 0.0..=1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn defaults_are_valid() {
        FireShape::default().validate().unwrap();
        FireLook::default().validate().unwrap();
    }

    #[test]
    fn a_threshold_below_its_range_is_refused() {
        let error = FireShape { size_m: 1.0, threshold_m: 0.0, ..FireShape::default() }.validate().unwrap_err();
        assert_eq!(error.to_string(), "`threshold_m` is 0, but must be 0.1 to 1");
    }

    #[test]
    fn nan_and_infinity_are_refused() {
        assert!(FireShape { size_m: f32::NAN, ..FireShape::default() }.validate().is_err());
        assert!(FireLook { glow: f32::INFINITY, ..FireLook::default() }.validate().is_err());
    }
}
