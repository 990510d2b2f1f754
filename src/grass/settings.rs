//! The settings of a meadow, and their limits.

use crate::setting::{SettingError, require, require_colour};
use bevy::reflect::Reflect;
use serde::{Deserialize, Serialize};

/// Most blades of one patch: some 2 million vertices, or 100 MB. Larger meadows are several patches.
const MOST_BLADES: u32 = 300_000;

/// Where the blades of a patch stand, and their sizes and shapes.
#[derive(Clone, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Sward {
    /// Extent along the patch's x axis, m: 0.1 to 1000. The patch lies about its own origin.
    pub width_m: f32,
    /// Extent along its z axis, m: 0.1 to 1000.
    pub depth_m: f32,
    /// Tufts on a square metre: 0.001 to 10000.
    pub tufts_per_m2: f32,
    /// The blades of one tuft.
    pub tuft: Tuft,
    /// Share of the blades that are dry, 0 to 1.
    pub dry_share: f32,
    /// Another seed is another meadow of the same kind.
    pub seed: u64,
}

impl Default for Sward {
    /// A small summer meadow, knee-high.
    fn default() -> Self {
        Self { width_m: 16.0, depth_m: 16.0, tufts_per_m2: 12.0, tuft: Tuft::default(), dry_share: 0.12, seed: 0 }
    }
}

/// Blades that grow from closely positioned points.
#[derive(Clone, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Tuft {
    /// Number of blades: 1 to 1000.
    pub blades: u32,
    /// Length of the shortest blade, m: 0.005 to `longest_m`.
    pub shortest_m: f32,
    /// Length of the longest blade, m: up to 5.
    pub longest_m: f32,
    /// Width of the narrowest blade at its base, m: 0.0002 to `widest_m`.
    pub narrowest_m: f32,
    /// Width of the widest blade at its base, m: up to 0.2.
    pub widest_m: f32,
    /// How far blades lean out, 0 to 1: the most is this share of a right angle. 1 is Zaharia's formula as printed.
    pub spread: f32,
    /// Radius of the spot from which they grow, m: 0 to 2.
    pub radius_m: f32,
    /// How far a blade droops from root to tip in still air, as a share of a right angle, 0 to 1. 0 is Zaharia's straight
    /// blade.
    pub droop: f32,
    /// How much tufts differ in height, 0 to 1. At 0 all lengths are uniformly distributed, as Zaharia's. At 1 some tufts have
    /// mostly long blades and others mostly short ones, within the same limits.
    pub clumping: f32,
}

impl Default for Tuft {
    fn default() -> Self {
        Self {
            blades: 16,
            shortest_m: 0.12,
            longest_m: 0.5,
            narrowest_m: 0.004,
            widest_m: 0.010,
            spread: 0.45,
            radius_m: 0.12,
            droop: 0.5,
            clumping: 0.6,
        }
    }
}

/// Colours and distances. Colours are linear red, green, blue, each 0 to 1.
#[derive(Clone, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct GrassLook {
    /// Colour at the root, where little light comes.
    pub root_colour: [f32; 3],
    /// Colour at the tip.
    pub tip_colour: [f32; 3],
    /// Colour of dry blades.
    pub dry_colour: [f32; 3],
    /// Share of the light that passes through a blade, 0 to 1.
    pub translucency: f32,
    /// Share of the sky's light that comes through closed crowns to the grass below them ([`GrassShade`](super::GrassShade)), 0 to 1.
    pub sky_under_trees: f32,
    /// Nearer than this, m, ever fewer blades are drawn, and within its half none: 0 to 10000. For broad blades, that stand for those of
    /// another meadow where this thins out.
    pub appears_from_m: f32,
    /// Farther than this, m, ever fewer blades are drawn, and the rest so much wider: 0.1 to 10000.
    pub thins_from_m: f32,
    /// At this distance, m, the last blades have shrunk to nothing: 1 to 10000.
    pub vanishes_at_m: f32,
}

impl Default for GrassLook {
    /// The colours of the grass of [`GroundLook`](crate::terrain::GroundLook), so that the ground between blades is as a meadow.
    fn default() -> Self {
        Self {
            root_colour: [0.05, 0.075, 0.02],
            tip_colour: [0.145, 0.20, 0.048],
            dry_colour: [0.22, 0.20, 0.10],
            translucency: 0.35,
            sky_under_trees: 0.1,
            appears_from_m: 0.0,
            thins_from_m: 18.0,
            vanishes_at_m: 90.0,
        }
    }
}

/// How blades respond to the wind.
#[derive(Clone, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct GrassResponse {
    /// Wind, in m/s at the reference height of 10 m, in which a tip turns by 0.71 of the most it can
    /// ([`TIP_ANGLE_LIMIT_RAD`](super::spine::TIP_ANGLE_LIMIT_RAD)): 0.1 to 1000. Stiff grass has a high one.
    pub half_bend_speed_m_s: f32,
    /// Greatest angle of a blade's own flutter about each of two axes, rad: 0 to 1.
    pub flutter_rad: f32,
    /// Frequency of the flutter, Hz: 0 to 20.
    pub flutter_hz: f32,
    /// Frequency with which blades swing that a body has pushed aside and left, Hz: 0.1 to 20. Wheat has 2 to 3.
    pub swing_hz: f32,
    /// Their damping by critical damping: 0.05 to 0.95.
    pub swing_damping_ratio: f32,
}

impl Default for GrassResponse {
    /// By eye: a fresh breeze of 8 m/s bends a meadow by some 35 degrees.
    fn default() -> Self {
        Self { half_bend_speed_m_s: 10.0, flutter_rad: 0.08, flutter_hz: 2.2, swing_hz: 2.0, swing_damping_ratio: 0.2 }
    }
}

impl Sward {
    /// Number of tufts.
    pub(super) fn tufts(&self) -> u32 {
        (self.width_m * self.depth_m * self.tufts_per_m2).round().max(1.0) as u32
    }

    /// Number of blades.
    pub fn blades(&self) -> u64 {
        u64::from(self.tufts()) * u64::from(self.tuft.blades)
    }

    /// Checks every field.
    ///
    /// # Errors
    /// The first field outside its domain, or `tufts_per_m2` where all in all there are too many blades.
    pub fn validate(&self) -> Result<(), SettingError> {
        require("width_m", self.width_m, 0.1..=1000.0)?;
        require("depth_m", self.depth_m, 0.1..=1000.0)?;
        require("tufts_per_m2", self.tufts_per_m2, 0.001..=10_000.0)?;
        require("dry_share", self.dry_share, 0.0..=1.0)?;
        self.tuft.validate().map_err(|error| error.inside("tuft"))?;
        if self.blades() > u64::from(MOST_BLADES) {
            let most = MOST_BLADES as f32 / (self.width_m * self.depth_m * self.tuft.blades as f32);
            let allowed = format!("at most {most}, so that the patch has no more than {MOST_BLADES} blades");
            return Err(SettingError::new("tufts_per_m2", self.tufts_per_m2, allowed));
        }
        Ok(())
    }
}

impl Tuft {
    /// Checks every field.
    ///
    /// # Errors
    /// The first field outside its domain.
    pub fn validate(&self) -> Result<(), SettingError> {
        if !(1..=1000).contains(&self.blades) {
            return Err(SettingError::new("blades", self.blades, "1 to 1000"));
        }
        require("longest_m", self.longest_m, 0.005..=5.0)?;
        require("shortest_m", self.shortest_m, 0.005..=self.longest_m)?;
        require("widest_m", self.widest_m, 0.0002..=0.2)?;
        require("narrowest_m", self.narrowest_m, 0.0002..=self.widest_m)?;
        require("spread", self.spread, 0.0..=1.0)?;
        require("radius_m", self.radius_m, 0.0..=2.0)?;
        require("droop", self.droop, 0.0..=1.0)?;
        require("clumping", self.clumping, 0.0..=1.0)
    }
}

impl GrassLook {
    /// Checks every field.
    ///
    /// # Errors
    /// The first field outside its domain.
    pub fn validate(&self) -> Result<(), SettingError> {
        require_colour("root_colour", self.root_colour)?;
        require_colour("tip_colour", self.tip_colour)?;
        require_colour("dry_colour", self.dry_colour)?;
        require("translucency", self.translucency, 0.0..=1.0)?;
        require("appears_from_m", self.appears_from_m, 0.0..=10_000.0)?;
        require("thins_from_m", self.thins_from_m, 0.1..=10_000.0)?;
        require("vanishes_at_m", self.vanishes_at_m, 1.0..=10_000.0)
    }
}

impl GrassResponse {
    /// Checks every field.
    ///
    /// # Errors
    /// The first field outside its domain.
    pub fn validate(&self) -> Result<(), SettingError> {
        require("half_bend_speed_m_s", self.half_bend_speed_m_s, 0.1..=1000.0)?;
        require("flutter_rad", self.flutter_rad, 0.0..=1.0)?;
        require("flutter_hz", self.flutter_hz, 0.0..=20.0)?;
        require("swing_hz", self.swing_hz, 0.1..=20.0)?;
        require("swing_damping_ratio", self.swing_damping_ratio, 0.05..=0.95)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn defaults_are_valid() {
        Sward::default().validate().unwrap();
        GrassLook::default().validate().unwrap();
        GrassResponse::default().validate().unwrap();
    }

    #[test]
    fn a_value_out_of_range_is_named_with_its_path_and_what_is_allowed() {
        let tuft = Tuft { shortest_m: 0.9, ..Tuft::default() };
        let error = Sward { tuft, ..Sward::default() }.validate().unwrap_err();
        assert_eq!(error.to_string(), "`tuft.shortest_m` is 0.9, but must be 0.005 to 0.5");
        let error = Sward { width_m: f32::NAN, ..Sward::default() }.validate().unwrap_err();
        assert_eq!(error.to_string(), "`width_m` is NaN, but must be 0.1 to 1000");
    }

    #[test]
    fn too_many_blades_are_refused() {
        let lawn = Sward { width_m: 1000.0, depth_m: 1000.0, tufts_per_m2: 10_000.0, ..Sward::default() };
        let error = lawn.validate().unwrap_err();
        assert_eq!(error.field, "tufts_per_m2");
    }
}
