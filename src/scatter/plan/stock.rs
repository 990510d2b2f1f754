//! A species in an area: how much of it, how old, and on which ground.

use bevy::reflect::Reflect;
use serde::{Deserialize, Serialize};

use crate::setting::{SettingError, require};

/// Beyond any ground on Earth, up and down.
const HIGHEST_M: f32 = 1e5;

/// A species in an area.
#[derive(Clone, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Stock {
    /// The species' name.
    pub species: String,
    /// Its part of the plants, relative to the others'. domain: \[0, 1000000\].
    pub share: f32,
    /// Mean age. units: years, domain: \[0.1, 10000\].
    pub age_years: f32,
    /// Standard deviation of the age; ages are spread log-normally, many young and few old.
    /// units: years, domain: 0 to 3 times the mean.
    pub age_spread_years: f32,
    /// The age at which it has 95% of its full size by the plan's own law of growth, which gives stems in the store their
    /// [`plan_size`](crate::scatter::Planted::plan_size). Trees are drawn in the size of their species at their age.
    /// units: years, domain: \[1, 10000\].
    pub full_grown_years: f32,
    /// Standard deviation of the size of plants of the same age, relative. domain: \[0, 0.5\].
    pub size_spread: f32,
    /// How far it is ahead of the forest's season (behind, below 0). units: days, domain: \[-120, 120\].
    pub season_offset_days: f32,
    /// Standard deviation of that from plant to plant. units: days, domain: \[0, 60\].
    pub season_spread_days: f32,
    /// How far tints go from -1 to 1: 0 for all alike. domain: \[0, 1\].
    pub tint_spread: f32,
    /// The ground on which it grows, within the area's own limits.
    pub ground: GroundLimits,
}

impl Default for Stock {
    fn default() -> Self {
        Self {
            species: "oak".into(),
            share: 1.0,
            age_years: 80.0,
            age_spread_years: 30.0,
            full_grown_years: 100.0,
            size_spread: 0.08,
            season_offset_days: 0.0,
            season_spread_days: 4.0,
            tint_spread: 1.0,
            ground: GroundLimits::default(),
        }
    }
}

impl Stock {
    pub(super) fn validate(&self) -> Result<(), SettingError> {
        if self.species.is_empty() {
            return Err(SettingError::new("species", "empty", "the name of a species"));
        }
        require("share", self.share, 0.0..=1e6)?;
        require("age_years", self.age_years, 0.1..=1e4)?;
        require("age_spread_years", self.age_spread_years, 0.0..=3.0 * self.age_years)?;
        require("full_grown_years", self.full_grown_years, 1.0..=1e4)?;
        require("size_spread", self.size_spread, 0.0..=0.5)?;
        require("season_offset_days", self.season_offset_days, -120.0..=120.0)?;
        require("season_spread_days", self.season_spread_days, 0.0..=60.0)?;
        require("tint_spread", self.tint_spread, 0.0..=1.0)?;
        self.ground.validate().map_err(|error| error.inside("ground"))
    }
}

/// Ground on which something grows.
#[derive(Clone, Copy, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct GroundLimits {
    /// units: m, domain: \[-100000, 100000\].
    pub lowest_m: f32,
    /// units: m, domain: \[-100000, 100000\].
    pub highest_m: f32,
    /// The lower and upper limits are not lines but bands of this width, in which the growth thins out.
    /// units: m, domain: \[0, 1000\].
    pub fade_m: f32,
    /// Angle of the slope against the level. units: degrees, domain: \[0, 90\].
    pub steepest_deg: f32,
}

impl Default for GroundLimits {
    /// Any ground.
    fn default() -> Self {
        Self { lowest_m: -HIGHEST_M, highest_m: HIGHEST_M, fade_m: 0.0, steepest_deg: 90.0 }
    }
}

impl GroundLimits {
    pub(super) fn validate(&self) -> Result<(), SettingError> {
        require("lowest_m", self.lowest_m, -HIGHEST_M..=HIGHEST_M)?;
        require("highest_m", self.highest_m, self.lowest_m..=HIGHEST_M)?;
        require("fade_m", self.fade_m, 0.0..=1000.0)?;
        require("steepest_deg", self.steepest_deg, 0.0..=90.0)
    }

    /// Whether ground of this height and slope (rise over run) is within the limits. `chance`, from 0 to 1, decides in
    /// the bands where the growth thins out: they are centred on the limits.
    pub(in crate::scatter) fn admit(&self, height_m: f32, slope: f32, chance: f32) -> bool {
        let shift_m = (chance - 0.5) * self.fade_m;
        let upright = self.steepest_deg >= 90.0;
        (self.lowest_m + shift_m..=self.highest_m - shift_m).contains(&height_m)
            && (upright || slope <= libm::tanf(self.steepest_deg.to_radians()))
    }

    /// The share of chances with which [`admit`](Self::admit) admits ground of this height and slope, 0 to 1.
    pub(in crate::scatter) fn admitted(&self, height_m: f32, slope: f32) -> f32 {
        let admits = |step: u8| self.admit(height_m, slope, (f32::from(step) + 0.5) / f32::from(FADE_STEPS));
        (0..FADE_STEPS).filter(|step| admits(*step)).count() as f32 / f32::from(FADE_STEPS)
    }
}

/// Chances that are tried for a share.
const FADE_STEPS: u8 = 8;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ground_is_admitted_within_its_limits_with_a_falling_chance_in_the_bands() {
        let limits = GroundLimits { lowest_m: 100.0, highest_m: 900.0, fade_m: 40.0, steepest_deg: 45.0 };
        assert!(limits.admit(500.0, 0.99, 0.0));
        assert!(!limits.admit(500.0, 1.01, 0.0));
        let admitted = |height_m| (0..1000).filter(|&i| limits.admit(height_m, 0.0, i as f32 / 1000.0)).count();
        assert_eq!([70.0, 130.0, 870.0, 930.0].map(admitted), [0, 1000, 1000, 0]);
        assert!(admitted(900.0).abs_diff(500) <= 1);
        assert!(admitted(890.0).abs_diff(750) <= 1);
        assert!(admitted(110.0).abs_diff(750) <= 1);
        assert!(GroundLimits::default().admit(0.0, f32::INFINITY, 0.5));
    }

    #[test]
    fn limits_in_the_wrong_order_are_refused() {
        let limits = GroundLimits { lowest_m: 10.0, highest_m: 5.0, ..Default::default() };
        assert_eq!(limits.validate().unwrap_err().to_string(), "`highest_m` is 5, but must be 10 to 100000");
    }
}
