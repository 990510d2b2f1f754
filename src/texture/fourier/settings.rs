//! What can be chosen about a Fourier texture.

use bevy::reflect::Reflect;
use serde::{Deserialize, Serialize};

use crate::setting::{SettingError, require};

/// Most terms of a series: the last has 2048 times the first frequency.
pub const TERMS_LIMIT: u32 = 12;

/// Settings of a Fourier texture.
///
/// ```ron
/// (terms: 6, first_frequency_rad: 12.0, first_amplitude: 1.76, offset: 1.0, coupling: 1.0, tiles: true, seed: 7)
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct FourierTexture {
    /// Terms of each series, 1 to 12. Gardner found 4 to 7 enough.
    pub terms: u32,
    /// Angular frequency of the first term, radians per unit of place: 0.01 to 1000.
    pub first_frequency_rad: f32,
    /// Amplitude of the first term, 0.001 to 1000.
    pub first_amplitude: f32,
    /// Offset of each term as a share of its amplitude, 0 to 100: contrast, where the series are multiplied.
    pub offset: f32,
    /// How much the phases of one direction follow the waves of the others: 0 not at all, 1 as Gardner has it; to 4.
    pub coupling: f32,
    /// How the two series become one.
    pub combination: Combination,
    /// Whether the texture repeats itself over the unit square: frequencies are then rounded to whole periods in it.
    pub tiles: bool,
    /// Another seed is another texture of the same kind.
    pub seed: u64,
}

/// How the series along x and along y become one value.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Reflect, Serialize, Deserialize)]
pub enum Combination {
    /// Their product (Gardner).
    #[default]
    Product,
    /// Their sum (Zaharia).
    Sum,
}

impl Default for FourierTexture {
    /// Zaharia's numbers, Gardner's product.
    fn default() -> Self {
        Self {
            terms: 6,
            first_frequency_rad: 12.0,
            first_amplitude: 1.76,
            offset: 1.0,
            coupling: 1.0,
            combination: Combination::Product,
            tiles: false,
            seed: 0,
        }
    }
}

impl FourierTexture {
    /// Checks every field.
    ///
    /// # Errors
    /// [`SettingError`] for the first field outside its domain, NaN included.
    pub fn validate(&self) -> Result<(), SettingError> {
        require("terms", self.terms, 1..=TERMS_LIMIT)?;
        require("first_frequency_rad", self.first_frequency_rad, 0.01..=1000.0)?;
        require("first_amplitude", self.first_amplitude, 0.001..=1000.0)?;
        require("offset", self.offset, 0.0..=100.0)?;
        require("coupling", self.coupling, 0.0..=4.0)
    }
}
