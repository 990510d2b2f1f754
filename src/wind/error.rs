//! What can be wrong with wind settings.

use thiserror::Error;

/// A setting of the wind that cannot be used, with what would be allowed.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum WindError {
    /// A number is outside its range, or not a number.
    #[error("wind setting `{field}` is {value}, but must be a number from {lowest} to {highest}")]
    OutOfRange {
        /// The setting's path in [`FieldSettings`](super::FieldSettings).
        field: &'static str,
        /// What was given.
        value: f64,
        /// The least value allowed.
        lowest: f64,
        /// The greatest value allowed.
        highest: f64,
    },
    /// A count that must be a power of two is not.
    #[error("wind setting `{field}` is {value}, but must be a power of two")]
    NotAPowerOfTwo {
        /// The setting's path in [`FieldSettings`](super::FieldSettings).
        field: &'static str,
        /// What was given.
        value: u32,
    },
    /// A direction is not a unit vector.
    #[error("wind setting `{field}` is ({x}, {y}), but must be a vector of length 1")]
    NotAUnitVector {
        /// The setting's path in [`FieldSettings`](super::FieldSettings).
        field: &'static str,
        /// What was given, first component.
        x: f32,
        /// What was given, second component.
        y: f32,
    },
    /// The three counts of the resolution are each in range, but make too large a field together.
    #[error(
        "wind setting `resolution` asks for {samples} samples, but time_samples x columns x levels must be at most {most}"
    )]
    TooManySamples {
        /// What was asked for.
        samples: u64,
        /// The greatest product allowed.
        most: u64,
    },
}
