//! What can be wrong with terrain: its settings, its maps, its files.

use std::{fmt::Display, ops::RangeInclusive};
use thiserror::Error;

/// Why a terrain, a map or an estimate was refused.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum TerrainError {
    /// A setting is outside its domain, or not a number.
    #[error("`{field}` is {value}, but must be {allowed}")]
    OutOfRange {
        /// Path of the setting, such as `anisotropy.ratio`.
        field: String,
        /// What was given.
        value: String,
        /// What would be allowed.
        allowed: String,
    },
    /// A file of elevations has the wrong form, such as 8 bits a sample.
    #[error("the elevation file is {found}, but must be {allowed}")]
    Format {
        /// What the file is.
        found: String,
        /// What can be read.
        allowed: &'static str,
    },
    /// A file of elevations is damaged or cut off.
    #[error("the elevation file cannot be read: {reason}")]
    Unreadable {
        /// What the decoder says.
        reason: String,
    },
    /// A list does not hold one value for each place of its grid.
    #[error("`{field}` holds {found}, but {columns} x {rows} need {expected}")]
    Count {
        /// Path of the list, with what is counted.
        field: String,
        /// How many there are.
        found: usize,
        /// Columns of the grid.
        columns: u32,
        /// Rows of the grid.
        rows: u32,
        /// How many there must be.
        expected: u64,
    },
    /// An elevation is NaN or infinite.
    #[error("the elevation at column {column}, row {row} is {value}, but must be a finite number")]
    NotFinite {
        /// Column, from 0.
        column: usize,
        /// Row, from 0.
        row: usize,
        /// What was found.
        value: f32,
    },
    /// The ground is level, so that it has no covariance.
    #[error("all elevations lie in one plane, so that there is no covariance to estimate")]
    Level,
}

impl TerrainError {
    pub(super) fn out_of_range(field: &str, value: impl Display, allowed: impl Into<String>) -> Self {
        Self::OutOfRange { field: field.into(), value: value.to_string(), allowed: allowed.into() }
    }

    /// The same error seen from the struct around it: `parent` comes before the field's path.
    #[must_use]
    pub(super) fn inside(self, parent: &str) -> Self {
        match self {
            Self::OutOfRange { field, value, allowed } => {
                Self::OutOfRange { field: format!("{parent}.{field}"), value, allowed }
            }
            Self::Count { field, found, columns, rows, expected } => {
                Self::Count { field: format!("{parent}.{field}"), found, columns, rows, expected }
            }
            other => other,
        }
    }
}

/// Refuses a number outside `allowed`, NaN among them.
pub(super) fn require<T: PartialOrd + Display>(
    field: &str,
    value: T,
    allowed: RangeInclusive<T>,
) -> Result<(), TerrainError> {
    if allowed.contains(&value) {
        return Ok(());
    }
    Err(TerrainError::out_of_range(field, value, format!("{} to {}", allowed.start(), allowed.end())))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_names_the_path_the_value_and_what_is_allowed() {
        let error = require("ratio", f64::NAN, 1.0..=10.0).unwrap_err().inside("anisotropy");
        assert_eq!(error.to_string(), "`anisotropy.ratio` is NaN, but must be 1 to 10");
        assert_eq!(require("lines", 16_u32, 1..=256), Ok(()));
    }
}
