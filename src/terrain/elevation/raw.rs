//! Raw samples, without a header.

use super::{
    samples::Samples,
    settings::{RawLayout, RawSample},
};
use crate::terrain::{elevation_grid::require_size, error::TerrainError};

impl RawSample {
    fn bytes(self) -> usize {
        match self {
            Self::F32LittleEndian | Self::F32BigEndian => 4,
            _ => 2,
        }
    }

    fn is_unsigned(self) -> bool {
        matches!(self, Self::U16LittleEndian | Self::U16BigEndian)
    }

    /// The sample in a chunk of [`bytes`](Self::bytes) bytes.
    fn read(self, chunk: &[u8]) -> f32 {
        match (self, chunk) {
            (Self::U16LittleEndian, &[a, b]) => f32::from(u16::from_le_bytes([a, b])),
            (Self::U16BigEndian, &[a, b]) => f32::from(u16::from_be_bytes([a, b])),
            (Self::I16LittleEndian, &[a, b]) => f32::from(i16::from_le_bytes([a, b])),
            (Self::I16BigEndian, &[a, b]) => f32::from(i16::from_be_bytes([a, b])),
            (Self::F32LittleEndian, &[a, b, c, d]) => f32::from_le_bytes([a, b, c, d]),
            (Self::F32BigEndian, &[a, b, c, d]) => f32::from_be_bytes([a, b, c, d]),
            _ => f32::NAN,
        }
    }
}

/// Reads the samples of a file that has nothing else.
pub(super) fn read(bytes: &[u8], layout: &RawLayout) -> Result<Samples, TerrainError> {
    let RawLayout { columns, rows, sample } = *layout;
    require_size(columns, rows).map_err(|error| error.inside("raw"))?;
    let expected = u64::from(columns) * u64::from(rows) * sample.bytes() as u64;
    if bytes.len() as u64 != expected {
        let (field, found) = ("bytes of the raw file".to_owned(), bytes.len());
        return Err(TerrainError::Count { field, found, columns, rows, expected });
    }
    let values = bytes.chunks_exact(sample.bytes()).map(|chunk| sample.read(chunk)).collect();
    let full_scale = sample.is_unsigned().then_some(f64::from(u16::MAX));
    Ok(Samples { columns, rows, values, full_scale, ..Samples::default() })
}
