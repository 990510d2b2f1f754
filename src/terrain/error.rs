//! What can be wrong with terrain: its settings, its maps, its files.

use crate::{ron_text::SyntaxError, setting::SettingError};
use thiserror::Error;

/// Why a terrain, a map or an estimate was refused.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum TerrainError {
    /// The text is not the RON of the settings.
    #[error(transparent)]
    Syntax(#[from] SyntaxError),
    /// A setting, named by its path such as `patches[0].columns`, is outside its domain.
    #[error(transparent)]
    Setting(#[from] SettingError),
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
    /// A map has no cell with data.
    #[error("no cell has an elevation")]
    NoData,
    /// The ground is level, so that it has no covariance.
    #[error("all elevations lie in one plane, so that there is no covariance to estimate")]
    Level,
}

impl TerrainError {
    /// The same error seen from the struct around it: `parent` comes before the field's path.
    #[must_use]
    pub(super) fn inside(self, parent: &str) -> Self {
        match self {
            Self::Setting(error) => Self::Setting(error.inside(parent)),
            Self::Count { field, found, columns, rows, expected } => {
                Self::Count { field: format!("{parent}.{field}"), found, columns, rows, expected }
            }
            other => other,
        }
    }
}
