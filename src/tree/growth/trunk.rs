//! The trunk of a tree, or the stems of a shrub: the settings that all generators share.

use bevy::reflect::Reflect;
use serde::{Deserialize, Serialize};

use super::habit::Habit;
use crate::setting::{SettingError, require};

/// The first branch of all.
#[derive(Clone, Copy, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Trunk {
    /// Length when mature from the ground to where it ends or dissolves into limbs, m: 0.5 to the envelope's top.
    pub height_m: f32,
    /// Radius of the thickest stem at the ground without the root flare, m: 0.01 to 5.
    pub radius_m: f32,
    /// Beams it is made of, 1 to 6.
    pub segments: u32,
    /// Stems from the ground, 1 to 32: a tree has one, a shrub several.
    pub stems: u32,
    /// Radius of the circle on which several stems stand, m: 0 to 5.
    pub stem_spread_m: f32,
    /// Random part of the stems' lengths, 0 to 0.9.
    pub stem_length_spread: f32,
    /// Largest lean from the vertical, degrees: 0 to 60. Several stems lean apart.
    pub lean_deg: f32,
    /// How much each segment turns at random, degrees: 0 to 45.
    pub crook_deg: f32,
    /// How much wider than the trunk the roots start, as a share of the radius, 0 to 2.
    pub flare: f32,
    /// Height over which the flare falls to 1/e, m: 0.05 to 5.
    pub flare_height_m: f32,
    /// Number of buttresses, 0 to 9.
    pub buttresses: u32,
}

impl Default for Trunk {
    fn default() -> Self {
        Self {
            height_m: 8.0,
            radius_m: 0.4,
            segments: 2,
            stems: 1,
            stem_spread_m: 0.3,
            stem_length_spread: 0.2,
            lean_deg: 4.0,
            crook_deg: 6.0,
            flare: 0.5,
            flare_height_m: 0.5,
            buttresses: 5,
        }
    }
}

impl Trunk {
    /// The trunk of an individual that is so much as high and so much as thick as the mature one.
    #[must_use]
    pub fn scaled(&self, height: f32, girth: f32) -> Self {
        Self {
            height_m: self.height_m * height,
            radius_m: self.radius_m * girth,
            stem_spread_m: self.stem_spread_m * girth,
            flare_height_m: self.flare_height_m * girth,
            ..*self
        }
    }

    pub(super) fn validate(&self, top_m: f32) -> Result<(), SettingError> {
        require("height_m", self.height_m, 0.5..=top_m)?;
        require("radius_m", self.radius_m, 0.01..=5.0)?;
        require("segments", self.segments as f32, 1.0..=6.0)?;
        require("stems", self.stems as f32, 1.0..=32.0)?;
        require("stem_spread_m", self.stem_spread_m, 0.0..=5.0)?;
        require("stem_length_spread", self.stem_length_spread, 0.0..=0.9)?;
        require("lean_deg", self.lean_deg, 0.0..=60.0)?;
        require("crook_deg", self.crook_deg, 0.0..=45.0)?;
        require("flare", self.flare, 0.0..=2.0)?;
        require("flare_height_m", self.flare_height_m, 0.05..=5.0)?;
        require("buttresses", self.buttresses as f32, 0.0..=9.0)
    }

    /// How the trunk runs at a share of its mature height: a young one has fewer beams.
    pub(super) fn habit(&self, height_share: f32) -> Habit {
        let segments = (self.segments as f32 * height_share.min(1.0).sqrt()).ceil().max(1.0) as u32;
        Habit { segments, crook_rad: self.crook_deg.to_radians(), rise: 0.0, sag: 0.0 }
    }
}
