//! What a user can choose about a random field of ground, and the limits that keep every choice finite.

use super::covariance::CovarianceModel;
use crate::setting::{SettingError, require};
use bevy::{
    math::{DMat2, DVec2},
    reflect::Reflect,
};
use serde::{Deserialize, Serialize};
use std::ops::RangeInclusive;

/// A millimetre to the size of a continent.
const LENGTH_M: RangeInclusive<f64> = 1e-3..=1e7;
const DEVIATION_M: RangeInclusive<f64> = 0.0..=1e5;
const MEAN_M: RangeInclusive<f64> = -1e5..=1e5;
const RATIO: RangeInclusive<f64> = 1.0..=100.0;
const AZIMUTH_DEG: RangeInclusive<f64> = -360.0..=360.0;
/// With fewer than 4 lines the ground is corrugated.
const LINES: RangeInclusive<u32> = 4..=256;
const HARMONICS: RangeInclusive<u32> = 8..=16_384;
/// 4 bytes each: 64 MiB.
const MOST_TABLE_SAMPLES: f64 = (1_u32 << 24) as f64;

/// Samples of a table in the finest wavelength. The spline through them then errs by 1.2% of the finest wave itself,
/// and by far less of all longer ones (see [`TurningBands::lookup_error_m`](super::TurningBands::lookup_error_m)).
pub(super) const SAMPLES_PER_WAVELENGTH: f64 = 4.0;
/// Scales after which a line process repeats, at least. A frequency, rounded to a whole number of waves in a period, is
/// then off by at most pi / 128 radians per scale, which no covariance at lags of a few scales can tell.
pub(super) const PERIOD_SCALES: f64 = 128.0;

/// Everything that determines a [`TurningBands`](super::TurningBands) field.
#[derive(Clone, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct TurningBandsSettings {
    /// How the covariance falls with distance.
    pub model: CovarianceModel,
    /// The length 1 / b in the covariance model: the distance x = 1, the range of the spherical model, 1 / `w_min` of
    /// the fractal. Along the longer axis where the field is anisotropic. units: m, domain: \[0.001, 10^7\].
    pub scale_m: f64,
    /// Standard deviation of the elevation; its square is the sill. units: m, domain: \[0, 10^5\].
    pub deviation_m: f64,
    /// Mean elevation. units: m, domain: \[-10^5, 10^5\].
    pub mean_m: f64,
    /// Waves shorter than this are left out, and their variance with them (see
    /// [`TurningBands::resolved_fraction`](super::TurningBands::resolved_fraction)). About two cells of the finest mesh
    /// that will be drawn; along the longer axis where the field is anisotropic. units: m, domain: \[0.001,
    /// `scale_m`\], and such that the tables, lines x 2^ceil(log2(512 `scale_m` / `finest_wavelength_m`)), hold at most
    /// 2^24 samples.
    pub finest_wavelength_m: f64,
    /// Whether the ground is drawn out in one direction.
    pub anisotropy: Anisotropy,
    /// L, the lines that the field turns about (equation 1). Hill shading shows 16 as faint straight streaks, and
    /// hardly shows 64; the time to read a place grows with them. domain: \[4, 256\].
    pub lines: u32,
    /// M, the harmonics of each line (equation 3). They cost nothing when the field is read. domain: \[8, 16384\].
    pub harmonics: u32,
    /// Selects the realisation. The same settings with the same seed give the same field, bit by bit.
    pub seed: u64,
}

/// Ridges: the scale across an axis is shorter than along it.
#[derive(Clone, Copy, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Anisotropy {
    /// Scale along the axis over scale across it; 1 = isotropic. domain: \[1, 100\].
    pub ratio: f64,
    /// Direction of the axis, from +x (east) towards +z (south). units: degrees, domain: \[-360, 360\].
    pub azimuth_deg: f64,
}

impl Default for TurningBandsSettings {
    /// Hills of some 40 m, a few hundred metres apart, for a mesh with cells of 2 m.
    fn default() -> Self {
        Self {
            model: CovarianceModel::Bessel,
            scale_m: 150.0,
            deviation_m: 20.0,
            mean_m: 0.0,
            finest_wavelength_m: 4.0,
            anisotropy: Anisotropy::default(),
            lines: 16,
            harmonics: 100,
            seed: 0,
        }
    }
}

impl Default for Anisotropy {
    fn default() -> Self {
        Self { ratio: 1.0, azimuth_deg: 0.0 }
    }
}

impl Anisotropy {
    /// The matrix A into coordinates in which the ground is isotropic: its axis keeps its length, what lies across
    /// grows.
    pub(super) fn stretch(&self) -> DMat2 {
        let axis = DVec2::from_angle(self.azimuth_deg.to_radians());
        let to_axes = DMat2::from_cols(axis, axis.perp()).transpose();
        DMat2::from_diagonal(DVec2::new(1.0, self.ratio)) * to_axes
    }
}

impl TurningBandsSettings {
    /// Checks every setting.
    ///
    /// # Errors
    /// [`SettingError`] for the first that is outside its domain.
    pub fn validate(&self) -> Result<(), SettingError> {
        self.model.validate().map_err(|error| error.inside("model"))?;
        require("scale_m", self.scale_m, LENGTH_M)?;
        require("deviation_m", self.deviation_m, DEVIATION_M)?;
        require("mean_m", self.mean_m, MEAN_M)?;
        require("finest_wavelength_m", self.finest_wavelength_m, LENGTH_M)?;
        require("anisotropy.ratio", self.anisotropy.ratio, RATIO)?;
        require("anisotropy.azimuth_deg", self.anisotropy.azimuth_deg, AZIMUTH_DEG)?;
        require("lines", self.lines, LINES)?;
        require("harmonics", self.harmonics, HARMONICS)?;
        self.validate_resolution()
    }

    fn validate_resolution(&self) -> Result<(), SettingError> {
        let most_samples = 2f64.powf((MOST_TABLE_SAMPLES / f64::from(self.lines)).log2().floor());
        let finest_m = PERIOD_SCALES * SAMPLES_PER_WAVELENGTH * self.scale_m / most_samples;
        if (finest_m..=self.scale_m).contains(&self.finest_wavelength_m) {
            return Ok(());
        }
        let allowed = format!("{finest_m} to {} with this `scale_m` and `lines`", self.scale_m);
        Err(SettingError::new("finest_wavelength_m", self.finest_wavelength_m, allowed))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn error(change: impl Fn(&mut TurningBandsSettings)) -> String {
        let mut settings = TurningBandsSettings::default();
        change(&mut settings);
        settings.validate().unwrap_err().to_string()
    }

    #[test]
    fn default_settings_are_valid() {
        TurningBandsSettings::default().validate().unwrap();
    }

    #[test]
    fn an_error_names_the_setting_the_value_and_what_is_allowed() {
        assert_eq!(error(|s| s.lines = 1), "`lines` is 1, but must be 4 to 256");
        assert!(error(|s| s.scale_m = f64::NAN).starts_with("`scale_m` is NaN"));
        assert!(error(|s| s.deviation_m = -1.0).starts_with("`deviation_m` is -1"));
        assert!(error(|s| s.anisotropy.ratio = 0.5).starts_with("`anisotropy.ratio` is 0.5"));
        let flat = CovarianceModel::Fractal { dimension: 2.0 };
        assert_eq!(error(|s| s.model = flat), "`model.dimension` is 2, but must be 2.02 to 2.98");
    }

    #[test]
    fn no_resolution_asks_for_more_memory_than_the_limit() {
        let message = error(|s| s.finest_wavelength_m = 0.01);
        assert_eq!(
            message,
            "`finest_wavelength_m` is 0.01, but must be 0.0732421875 to 150 with this `scale_m` and `lines`"
        );
        assert!(error(|s| s.finest_wavelength_m = 151.0).contains("must be 0.0732421875 to 150"));
    }

    #[test]
    fn settings_survive_writing_and_reading() {
        let settings =
            TurningBandsSettings { model: CovarianceModel::Fractal { dimension: 2.2 }, ..Default::default() };
        let written = ron::to_string(&settings).unwrap();
        assert_eq!(ron::from_str::<TurningBandsSettings>(&written).unwrap(), settings);
        assert!(ron::from_str::<TurningBandsSettings>("(scale: 3.0)").is_err());
    }
}
