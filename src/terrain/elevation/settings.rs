//! What is told about a file of elevations.

use crate::setting::{SettingError, require};
use bevy::reflect::Reflect;
use serde::{Deserialize, Serialize};
use std::ops::RangeInclusive;

const METRES_PER_UNIT: RangeInclusive<f64> = 1e-9..=1e6;
const HEIGHT_M: RangeInclusive<f64> = -1e5..=1e5;

/// What is told about a file of elevations: what the file does not say, and what is to go before what it says.
///
/// elevation = `base_m` + `metres_per_unit` x sample
#[derive(Clone, Copy, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ElevationSettings {
    /// Distance of neighbours along x (east). A PNG and raw samples need it; others have it in the file.
    /// units: m, domain: \[0.001, 120000\].
    pub cell_x_m: Option<f64>,
    /// Distance of neighbours along z (south), where it is not the same as `cell_x_m`. units: m, domain: \[0.001, 120000\].
    pub cell_z_m: Option<f64>,
    /// Rise for each unit of a sample. units: m, domain: \[10^-9, 10^6\].
    pub metres_per_unit: f64,
    /// Elevation of a sample of 0. units: m, domain: \[-10^5, 10^5\].
    pub base_m: f64,
    /// Elevations of the least and of the greatest unsigned sample that can be written (0 and 255, or 0 and 65535), in place of the two
    /// above. A picture with 8 bits of grey needs it. units: m, domain: \[-10^5, 10^5\], the second above the first.
    pub height_range_m: Option<[f64; 2]>,
    /// The sample, as it is written, that says that there is no data. What the file says of it is then left aside.
    pub no_data: Option<f64>,
    /// How raw samples lie in the file. With it, the file is raw.
    pub raw: Option<RawLayout>,
}

/// How raw samples lie in a file: row by row from the north-west, without a header.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Reflect, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RawLayout {
    /// Samples from west to east. domain: \[2, 16384\].
    pub columns: u32,
    /// Samples from north to south. domain: \[2, 16384\].
    pub rows: u32,
    /// How one is written.
    #[serde(default)]
    pub sample: RawSample,
}

/// How a raw sample is written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Reflect, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum RawSample {
    /// Unsigned, 16 bits, lower byte first.
    #[default]
    U16LittleEndian,
    /// Unsigned, 16 bits, higher byte first.
    U16BigEndian,
    /// Signed, 16 bits, lower byte first.
    I16LittleEndian,
    /// Signed, 16 bits, higher byte first.
    I16BigEndian,
    /// Floating point, 32 bits, lower byte first.
    F32LittleEndian,
    /// Floating point, 32 bits, higher byte first.
    F32BigEndian,
}

impl Default for ElevationSettings {
    /// Whole metres, in cells as the file says.
    fn default() -> Self {
        Self {
            cell_x_m: None,
            cell_z_m: None,
            metres_per_unit: 1.0,
            base_m: 0.0,
            height_range_m: None,
            no_data: None,
            raw: None,
        }
    }
}

impl ElevationSettings {
    /// Samples in whole metres, `cell_x_m` apart from west to east and `cell_z_m` from north to south.
    #[must_use]
    pub fn with_cells(cell_x_m: f64, cell_z_m: f64) -> Self {
        Self { cell_x_m: Some(cell_x_m), cell_z_m: Some(cell_z_m), ..Self::default() }
    }

    /// Checks every setting that does not depend on the file.
    ///
    /// # Errors
    /// [`SettingError`] for the first that is wrong.
    pub fn validate(&self) -> Result<(), SettingError> {
        require("metres_per_unit", self.metres_per_unit, METRES_PER_UNIT)?;
        require("base_m", self.base_m, HEIGHT_M)?;
        if self.cell_z_m.is_some() && self.cell_x_m.is_none() {
            return Err(SettingError::new("cell_x_m", "not given", "given where `cell_z_m` is"));
        }
        let Some([low_m, high_m]) = self.height_range_m else { return Ok(()) };
        require("height_range_m[0]", low_m, HEIGHT_M)?;
        require("height_range_m[1]", high_m, HEIGHT_M)?;
        if low_m >= high_m {
            return Err(SettingError::new("height_range_m[1]", high_m, format!("above height_range_m[0], {low_m}")));
        }
        if self.metres_per_unit != 1.0 || self.base_m != 0.0 {
            let allowed = "left out where `metres_per_unit` or `base_m` is given";
            return Err(SettingError::new("height_range_m", format!("{low_m} to {high_m}"), allowed));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn defaults_are_valid_and_errors_name_the_field() {
        ElevationSettings::default().validate().unwrap();
        let error = |settings: ElevationSettings| settings.validate().unwrap_err().to_string();
        let of = |height_range_m| ElevationSettings { height_range_m, ..Default::default() };
        assert!(error(ElevationSettings { metres_per_unit: 0.0, ..of(None) }).starts_with("`metres_per_unit` is 0"));
        assert!(error(ElevationSettings { base_m: f64::NAN, ..of(None) }).starts_with("`base_m` is NaN"));
        assert_eq!(
            error(ElevationSettings { cell_z_m: Some(30.0), ..of(None) }),
            "`cell_x_m` is not given, but must be given where `cell_z_m` is"
        );
        assert_eq!(error(of(Some([5.0, 5.0]))), "`height_range_m[1]` is 5, but must be above height_range_m[0], 5");
        assert!(error(of(Some([f64::NAN, 5.0]))).starts_with("`height_range_m[0]` is NaN"));
        assert!(
            error(ElevationSettings { base_m: 3.0, ..of(Some([0.0, 1.0])) }).starts_with("`height_range_m` is 0 to 1")
        );
    }

    #[test]
    fn settings_survive_writing_and_reading() {
        let raw = Some(RawLayout { columns: 3, rows: 2, sample: RawSample::F32BigEndian });
        let settings = ElevationSettings { no_data: Some(-1.0), raw, ..ElevationSettings::with_cells(30.0, 31.0) };
        assert_eq!(ron::from_str::<ElevationSettings>(&ron::to_string(&settings).unwrap()).unwrap(), settings);
        assert!(ron::from_str::<ElevationSettings>("(cell_m: 3.0)").is_err());
    }
}
