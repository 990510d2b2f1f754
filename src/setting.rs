//! What is wrong with a setting, told so that it can be put right.

use std::{fmt::Display, ops::RangeInclusive};
use thiserror::Error;

/// A setting outside its domain.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("`{field}` is {value}, but must be {allowed}")]
pub struct SettingError {
    /// Path of the field, such as `sward.tuft.longest_m`.
    pub field: String,
    /// Its value.
    pub value: String,
    /// What would be allowed.
    pub allowed: String,
}

impl SettingError {
    pub(crate) fn new(field: &str, value: impl Display, allowed: impl Into<String>) -> Self {
        Self { field: field.into(), value: value.to_string(), allowed: allowed.into() }
    }

    /// The same error seen from the struct around it: `parent` comes before the field's path.
    #[must_use]
    pub(crate) fn inside(mut self, parent: &str) -> Self {
        self.field = format!("{parent}.{}", self.field);
        self
    }
}

/// Refuses a value outside `allowed`, NaN among them.
pub(crate) fn require(field: &str, value: f32, allowed: RangeInclusive<f32>) -> Result<(), SettingError> {
    if allowed.contains(&value) {
        return Ok(());
    }
    Err(SettingError::new(field, value, format!("{} to {}", allowed.start(), allowed.end())))
}

/// Refuses a colour with a channel outside 0 to 1.
pub(crate) fn require_colour(field: &str, colour: [f32; 3]) -> Result<(), SettingError> {
    colour.into_iter().try_for_each(|channel| require(field, channel, 0.0..=1.0))
}
