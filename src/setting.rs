//! The one error for a setting outside its domain: it names the field, the value and what is allowed.

use bevy::log::warn;
use std::{
    fmt::{Debug, Display},
    ops::RangeInclusive,
};
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
    pub(crate) fn new(field: impl Into<String>, value: impl Display, allowed: impl Into<String>) -> Self {
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
pub(crate) fn require<T: PartialOrd + Display>(
    field: &str,
    value: T,
    allowed: RangeInclusive<T>,
) -> Result<(), SettingError> {
    if allowed.contains(&value) {
        return Ok(());
    }
    Err(SettingError::new(field, value, format!("{} to {}", allowed.start(), allowed.end())))
}

/// Refuses a colour with a channel outside 0 to 1.
pub(crate) fn require_colour(field: &str, colour: [f32; 3]) -> Result<(), SettingError> {
    colour.into_iter().try_for_each(|channel| require(field, channel, 0.0..=1.0))
}

/// The settings to use: those that are wanted, if they are valid. Otherwise, with a warning, the last that were, or the default
/// ones. `subject` says whose they are.
pub(crate) fn valid_or_last<S: Clone + Debug + Default>(
    subject: &str,
    wanted: &S,
    validate: impl Fn(&S) -> Result<(), SettingError>,
    last: Option<&S>,
) -> S {
    let Err(error) = validate(wanted) else { return wanted.clone() };
    let used = last.cloned().unwrap_or_default();
    warn!("{subject}: {error}; {used:?} are used");
    used
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_names_the_path_the_value_and_what_is_allowed() {
        let error = require("ratio", f64::NAN, 1.0..=10.0).unwrap_err().inside("anisotropy");
        assert_eq!(error.to_string(), "`anisotropy.ratio` is NaN, but must be 1 to 10");
        assert_eq!(require("lines", 16_u32, 1..=256), Ok(()));
        let error = require_colour("colour", [0.0, 1.0, 2.0]).unwrap_err();
        assert_eq!(error.to_string(), "`colour` is 2, but must be 0 to 1");
    }

    #[test]
    fn invalid_settings_give_way_to_the_last_valid_ones() {
        let validate = |share: &f32| require("share", *share, 0.0..=1.0);
        assert_eq!(valid_or_last("test", &0.7, validate, Some(&0.3)), 0.7);
        assert_eq!(valid_or_last("test", &1.7, validate, Some(&0.3)), 0.3);
        assert_eq!(valid_or_last("test", &f32::NAN, validate, None), 0.0);
    }
}
