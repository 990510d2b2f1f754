//! PNG with 16 bits of grey; with 8, where it is told which heights they stand for.

use super::{samples::Samples, settings::ElevationSettings};
use crate::terrain::{elevation_grid::require_size, error::TerrainError};
use image::{DynamicImage, ExtendedColorType, ImageDecoder, Limits, codecs::png::PngDecoder};
use std::io::Cursor;

/// What the decoder may allocate: the largest grid with 16 bits a sample, and as much again for its own work.
const MOST_DECODER_BYTES: u64 = 1 << 28;

/// Reads the samples of a PNG.
pub(super) fn read(bytes: &[u8], settings: &ElevationSettings) -> Result<Samples, TerrainError> {
    let unreadable = |error: image::ImageError| TerrainError::Unreadable { reason: error.to_string() };
    let mut limits = Limits::default();
    limits.max_alloc = Some(MOST_DECODER_BYTES);
    let decoder = PngDecoder::with_limits(Cursor::new(bytes), limits).map_err(unreadable)?;
    let (columns, rows) = decoder.dimensions();
    require_size(columns, rows)?;
    let kind = decoder.original_color_type();
    let full_scale = match kind {
        ExtendedColorType::L16 => f64::from(u16::MAX),
        ExtendedColorType::L8 if settings.height_range_m.is_some() => f64::from(u8::MAX),
        _ => return Err(refusal(kind)),
    };
    let values = match DynamicImage::from_decoder(decoder).map_err(unreadable)? {
        DynamicImage::ImageLuma16(image) => image.iter().map(|&sample| f32::from(sample)).collect(),
        DynamicImage::ImageLuma8(image) => image.iter().map(|&sample| f32::from(sample)).collect(),
        _ => return Err(refusal(kind)),
    };
    Ok(Samples { columns, rows, values, full_scale: Some(full_scale), ..Samples::default() })
}

fn refusal(kind: ExtendedColorType) -> TerrainError {
    let found = format!("a PNG with {kind:?} samples");
    let allowed = match kind {
        ExtendedColorType::L8 => {
            "a PNG with 16 bits of grey (L16): 8 bits have 256 heights only, and do not say which; `height_range_m` does"
        }
        _ => "a PNG with 16 bits of grey (L16)",
    };
    TerrainError::Format { found, allowed }
}
