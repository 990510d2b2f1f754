//! What can be wrong with a plan of a forest, or a law of counts.

use std::{fmt::Display, ops::RangeInclusive};

use thiserror::Error;

/// Why something about the placing of plants was refused.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum ScatterError {
    /// The text is not the RON of a plan.
    #[error("line {line}, column {column}: {message}")]
    Syntax {
        /// Line, from 1.
        line: usize,
        /// Column, from 1.
        column: usize,
        /// What is wrong there.
        message: String,
    },
    /// A field is outside its domain.
    #[error("`{field}` is {value}, but must be {allowed}")]
    OutOfRange {
        /// Path of the field, such as `areas[0].density_per_ha`.
        field: String,
        /// Its value.
        value: String,
        /// What would be allowed.
        allowed: String,
    },
}

impl ScatterError {
    pub(super) fn out_of_range(field: impl Into<String>, value: impl Display, allowed: impl Into<String>) -> Self {
        Self::OutOfRange { field: field.into(), value: value.to_string(), allowed: allowed.into() }
    }

    /// The same error seen from the struct around it: `parent` comes before the field's path.
    #[must_use]
    pub(super) fn inside(self, parent: &str) -> Self {
        match self {
            Self::OutOfRange { field, value, allowed } => {
                Self::OutOfRange { field: format!("{parent}.{field}"), value, allowed }
            }
            syntax @ Self::Syntax { .. } => syntax,
        }
    }
}

/// Refuses a value outside `allowed`, NaN among them.
pub(super) fn require<T: PartialOrd + Display>(
    field: &str,
    value: T,
    allowed: RangeInclusive<T>,
) -> Result<(), ScatterError> {
    if allowed.contains(&value) {
        return Ok(());
    }
    Err(ScatterError::out_of_range(field, value, format!("{} to {}", allowed.start(), allowed.end())))
}
