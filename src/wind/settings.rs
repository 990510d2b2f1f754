//! The settings of a wind field, and the limits that keep every field finite.

use super::spectrum::{CoherenceDecay, DecayCoefficients};
use crate::setting::{SettingError, require};
use bevy::{math::Dir2, reflect::Reflect};
use std::ops::RangeInclusive;

/// m/s. No hurricane has a mean speed above 75 m/s.
const SPEED: RangeInclusive<f32> = 0.0..=75.0;
/// From ice to the centre of a city.
const ROUGHNESS_M: RangeInclusive<f32> = 1e-4..=2.0;
/// With the greatest roughness length, 10 m above ground is still e of them above the displacement plane, where the
/// logarithmic law begins to hold.
const DISPLACEMENT_M: RangeInclusive<f32> = 0.0..=4.5;
const GUSTINESS: RangeInclusive<f32> = 0.0..=3.0;
const DECAY: RangeInclusive<f32> = 0.0..=100.0;

const TIME_SAMPLES: RangeInclusive<u32> = 16..=65_536;
const COLUMNS: RangeInclusive<u32> = 1..=128;
/// The work grows with the cube of the levels.
const LEVELS: RangeInclusive<u32> = 1..=32;
/// 16 bytes each: 128 MiB.
const MOST_SAMPLES: u64 = 1 << 23;
const TIME_STEP_S: RangeInclusive<f32> = 0.005..=2.0;
const COLUMN_SPACING_M: RangeInclusive<f32> = 0.1..=1000.0;
const LEVEL_SPACING_M: RangeInclusive<f32> = 0.1..=100.0;

/// Everything that determines a [`WindField`](super::WindField). Where [`Wind`](super::Wind) has the same setting, it has
/// the same name.
#[derive(Clone, Debug, PartialEq, Reflect)]
pub struct FieldSettings {
    /// Mean wind speed 10 m above ground. units: m/s, domain: \[0, 75\].
    pub speed: f32,
    /// Where the mean wind blows to, in the world's (X, Z).
    pub direction: Dir2,
    /// z0, the roughness length of the ground: 0.01 for low grass to 1 for a pine forest (the paper's section
    /// 3.1.1). units: m, domain: \[0.0001, 2\].
    pub roughness_m: f32,
    /// d, the height of the plane on which the wind profile stands; about 0.7 of the height of a dense canopy.
    /// units: m, domain: \[0, 4.5\], because the speed is given at 10 m and must be above the canopy there.
    pub displacement_m: f32,
    /// Factor on the standard deviation of the turbulence; 1 = the spectra's own. domain: \[0, 3\].
    pub gustiness: f32,
    /// Selects the realisation. The same settings with the same seed give the same field, bit by bit.
    pub seed: u64,
    /// How finely and how far the field reaches.
    pub resolution: FieldResolution,
    /// What to do about the variance that the resolution leaves out.
    pub band: TurbulenceBand,
    /// How fast coherence is lost with distance.
    pub coherence: CoherenceDecay,
}

/// The grid of a field: time x across x height.
#[derive(Clone, Copy, Debug, PartialEq, Reflect)]
pub struct FieldResolution {
    /// Samples in a period of time; a power of two. domain: \[16, 65536\].
    pub time_samples: u32,
    /// Columns in a period across the wind. domain: \[1, 128\]. With one column the wind is the same everywhere across.
    pub columns: u32,
    /// Levels in height. domain: \[1, 32\]. The product of the three counts is at most 2^23.
    pub levels: u32,
    /// units: s, domain: \[0.005, 2\]. The field knows frequencies below 1 / (2 `time_step_s`).
    pub time_step_s: f32,
    /// units: m, domain: \[0.1, 1000\].
    pub column_spacing_m: f32,
    /// Also the height of the lowest level above ground. units: m, domain: \[0.1, 100\].
    pub level_spacing_m: f32,
}

/// What to do about turbulence outside the band of frequencies that a sampled field resolves: from one cycle in a period
/// to half a cycle in a sample.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
pub enum TurbulenceBand {
    /// Every resolved frequency has its true power, so that the variance is the resolved band's (algorithm 3 without
    /// its step 5).
    #[default]
    TrueSpectrum,
    /// The whole variance is squeezed into the resolved band, which raises the power of every resolved frequency
    /// (algorithm 3, step 5).
    TrueVariance,
}

impl Default for FieldSettings {
    /// A fresh breeze over open country with scattered trees: turbulence of 0.21 of the mean speed at 10 m.
    fn default() -> Self {
        Self {
            speed: 8.0,
            direction: Dir2::X,
            roughness_m: 0.1,
            displacement_m: 0.0,
            gustiness: 1.0,
            seed: 0,
            resolution: FieldResolution::default(),
            band: TurbulenceBand::default(),
            coherence: CoherenceDecay::default(),
        }
    }
}

impl Default for FieldResolution {
    /// 128 s x 128 m x 40 m: the height of a forest, frequencies up to 8 Hz.
    fn default() -> Self {
        Self {
            time_samples: 2048,
            columns: 16,
            levels: 16,
            time_step_s: 1.0 / 16.0,
            column_spacing_m: 8.0,
            level_spacing_m: 2.5,
        }
    }
}

impl FieldResolution {
    /// The period in time, s.
    pub fn period_s(&self) -> f64 {
        f64::from(self.time_samples) * f64::from(self.time_step_s)
    }

    /// The period across the wind, m.
    pub fn width_m(&self) -> f64 {
        f64::from(self.columns) * f64::from(self.column_spacing_m)
    }

    /// Height of a level above ground, m: the lowest, level 0, is one spacing up.
    pub(super) fn level_height_m(&self, level: usize) -> f32 {
        (level as f32 + 1.0) * self.level_spacing_m
    }

    fn samples(&self) -> u64 {
        u64::from(self.time_samples) * u64::from(self.columns) * u64::from(self.levels)
    }
}

impl FieldSettings {
    /// Whether a field can be made of these settings; if not, the first thing that is wrong.
    pub fn validate(&self) -> Result<(), SettingError> {
        match self.clamped().1.into_iter().next() {
            Some(error) => Err(error),
            None => Ok(()),
        }
    }

    /// The nearest settings that are allowed, and what was wrong with these. What is not a number becomes the default.
    pub(super) fn clamped(&self) -> (Self, Vec<SettingError>) {
        let mut settings = self.clone();
        let errors = settings.clamp();
        (settings, errors)
    }

    fn clamp(&mut self) -> Vec<SettingError> {
        let default = Self::default();
        let mut limits = Limits::default();
        limits.number("speed", &mut self.speed, SPEED, default.speed);
        limits.direction("direction", &mut self.direction, default.direction);
        limits.number("roughness_m", &mut self.roughness_m, ROUGHNESS_M, default.roughness_m);
        limits.number("displacement_m", &mut self.displacement_m, DISPLACEMENT_M, default.displacement_m);
        limits.number("gustiness", &mut self.gustiness, GUSTINESS, default.gustiness);
        limits.resolution(&mut self.resolution, &default.resolution);
        let CoherenceDecay { along, across, up } = &mut self.coherence;
        limits.decay(["coherence.along.lateral", "coherence.along.vertical"], along, default.coherence.along);
        limits.decay(["coherence.across.lateral", "coherence.across.vertical"], across, default.coherence.across);
        limits.decay(["coherence.up.lateral", "coherence.up.vertical"], up, default.coherence.up);
        limits.errors
    }
}

/// Brings values into their ranges and collects what was wrong.
#[derive(Default)]
struct Limits {
    errors: Vec<SettingError>,
}

impl Limits {
    fn number(&mut self, field: &'static str, value: &mut f32, allowed: RangeInclusive<f32>, default: f32) {
        if let Err(error) = require(field, *value, allowed.clone()) {
            self.errors.push(error);
            *value = if value.is_nan() { default } else { value.clamp(*allowed.start(), *allowed.end()) };
        }
    }

    fn count(&mut self, field: &'static str, value: &mut u32, allowed: RangeInclusive<u32>) {
        if let Err(error) = require(field, *value, allowed.clone()) {
            self.errors.push(error);
            *value = (*value).clamp(*allowed.start(), *allowed.end());
        }
    }

    fn direction(&mut self, field: &'static str, direction: &mut Dir2, default: Dir2) {
        // Bevy's own tolerance for a direction that is no longer quite normalised.
        if (direction.length_squared() - 1.0).abs() <= 2e-2 {
            return;
        }
        self.errors.push(SettingError::new(field, direction.as_vec2(), "a vector of length 1"));
        *direction = Dir2::new(direction.as_vec2()).unwrap_or(default);
    }

    fn decay(&mut self, fields: [&'static str; 2], decay: &mut DecayCoefficients, default: DecayCoefficients) {
        self.number(fields[0], &mut decay.lateral, DECAY, default.lateral);
        self.number(fields[1], &mut decay.vertical, DECAY, default.vertical);
    }

    fn resolution(&mut self, resolution: &mut FieldResolution, default: &FieldResolution) {
        self.count("resolution.time_samples", &mut resolution.time_samples, TIME_SAMPLES);
        self.power_of_two("resolution.time_samples", &mut resolution.time_samples);
        self.count("resolution.columns", &mut resolution.columns, COLUMNS);
        self.count("resolution.levels", &mut resolution.levels, LEVELS);
        self.number("resolution.time_step_s", &mut resolution.time_step_s, TIME_STEP_S, default.time_step_s);
        self.number(
            "resolution.column_spacing_m",
            &mut resolution.column_spacing_m,
            COLUMN_SPACING_M,
            default.column_spacing_m,
        );
        self.number(
            "resolution.level_spacing_m",
            &mut resolution.level_spacing_m,
            LEVEL_SPACING_M,
            default.level_spacing_m,
        );
        self.product(resolution);
    }

    fn power_of_two(&mut self, field: &'static str, value: &mut u32) {
        if !value.is_power_of_two() {
            self.errors.push(SettingError::new(field, *value, "a power of two"));
            *value = value.next_power_of_two();
        }
    }

    /// Shortens the period until the field fits. Columns x levels alone always fit.
    fn product(&mut self, resolution: &mut FieldResolution) {
        if resolution.samples() <= MOST_SAMPLES {
            return;
        }
        let allowed = format!("at most {MOST_SAMPLES} as time_samples x columns x levels");
        self.errors.push(SettingError::new("resolution", resolution.samples(), allowed));
        while resolution.samples() > MOST_SAMPLES {
            resolution.time_samples /= 2;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn first_error(change: impl Fn(&mut FieldSettings)) -> String {
        let mut settings = FieldSettings::default();
        change(&mut settings);
        settings.validate().unwrap_err().to_string()
    }

    #[test]
    fn default_settings_are_valid_and_stay_as_they_are() {
        assert_eq!(FieldSettings::default().clamped(), (FieldSettings::default(), vec![]));
    }

    #[test]
    fn an_error_names_the_field_the_value_and_what_is_allowed() {
        let message = first_error(|settings| settings.speed = -3.0);
        assert_eq!(message, "`speed` is -3, but must be 0 to 75");
        let message = first_error(|settings| settings.resolution.time_samples = 1000);
        assert_eq!(message, "`resolution.time_samples` is 1000, but must be a power of two");
        assert!(first_error(|settings| settings.coherence.up.vertical = f32::NAN).contains("coherence.up.vertical"));
    }

    #[test]
    fn clamping_takes_the_nearest_allowed_value_and_the_default_for_nan() {
        let wrong = FieldSettings {
            speed: f32::INFINITY,
            roughness_m: f32::NAN,
            displacement_m: -1.0,
            gustiness: 9.0,
            ..Default::default()
        };
        let (settings, errors) = wrong.clamped();
        assert_eq!(errors.len(), 4);
        assert_eq!(settings.speed, 75.0);
        assert_eq!(settings.roughness_m, FieldSettings::default().roughness_m);
        assert_eq!(settings.displacement_m, 0.0);
        assert_eq!(settings.gustiness, 3.0);
        assert_eq!(settings.validate(), Ok(()));
    }

    #[test]
    fn no_resolution_asks_for_more_memory_than_the_limit() {
        let resolution =
            FieldResolution { time_samples: u32::MAX, columns: u32::MAX, levels: u32::MAX, ..Default::default() };
        let (settings, errors) = FieldSettings { resolution, ..Default::default() }.clamped();
        assert_eq!(errors.len(), 4);
        assert_eq!(settings.resolution.samples(), MOST_SAMPLES);
        assert_eq!(settings.validate(), Ok(()));
    }
}
