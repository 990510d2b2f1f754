//! What all readers give: samples as they are written.

use super::georeference::Georeference;

/// No elevation has more metres, feet or millimetres than this; some programs mark cells without data with the greatest or least
/// number of single precision, and not all write it to the last digit.
const GREATEST_SAMPLE: f32 = 1e30;

/// The samples of a file, row by row from the north-west, and what the file says about them.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Samples {
    pub columns: u32,
    pub rows: u32,
    /// Integers of up to 24 bits are exact.
    pub values: Vec<f32>,
    /// The greatest that can be written, where samples are unsigned: what a range of heights is spread over.
    pub full_scale: Option<f64>,
    /// The sample that says that there is no data.
    pub no_data: Option<f64>,
    /// Metres for each unit of a sample, and of a sample of 0, where the file says them.
    pub scale: Option<[f64; 2]>,
    /// Where the samples lie.
    pub georeference: Option<Georeference>,
}

/// Whether a sample can be an elevation at all.
pub(super) fn is_number(sample: f32) -> bool {
    sample.abs() <= GREATEST_SAMPLE
}
