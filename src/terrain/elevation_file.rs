//! Reads elevations from files: 16-bit greyscale PNG, and raw samples.
//!
//! elevation = `base_m` + `metres_per_unit` x sample

use super::{
    elevation_grid::{ElevationGrid, require_size},
    error::TerrainError,
};
use crate::setting::{SettingError, require};
use bevy::{math::DVec2, reflect::Reflect};
use image::{DynamicImage, ExtendedColorType, ImageDecoder, Limits, codecs::png::PngDecoder};
use serde::{Deserialize, Serialize};
use std::{io::Cursor, ops::RangeInclusive};

const METRES_PER_UNIT: RangeInclusive<f64> = 1e-9..=1e6;
const BASE_M: RangeInclusive<f64> = -1e5..=1e5;
/// What the decoder may allocate: the largest grid with 16 bits a sample, and as much again for its own work.
const MOST_DECODER_BYTES: u64 = 1 << 28;

/// How the samples of a file become elevations.
#[derive(Clone, Copy, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ElevationScale {
    /// Distance of neighbours along x (east). units: m, domain: \[0.001, 120000\].
    pub cell_x_m: f64,
    /// Distance of neighbours along z (south). units: m, domain: \[0.001, 120000\].
    pub cell_z_m: f64,
    /// Rise for each unit of a sample. units: m, domain: \[10^-9, 10^6\].
    pub metres_per_unit: f64,
    /// Elevation of a sample of 0. units: m, domain: \[-10^5, 10^5\].
    pub base_m: f64,
}

/// How raw samples are written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Reflect, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum RawSample {
    /// Unsigned, 16 bits, lower byte first.
    #[default]
    U16LittleEndian,
    /// Unsigned, 16 bits, higher byte first.
    U16BigEndian,
    /// Signed, 16 bits, lower byte first.
    I16LittleEndian,
    /// Signed, 16 bits, higher byte first.
    I16BigEndian,
    /// Floating point, 32 bits, lower byte first.
    F32LittleEndian,
}

impl Default for ElevationScale {
    /// Whole metres, in cells of one arc second.
    fn default() -> Self {
        Self { cell_x_m: 30.0, cell_z_m: 30.0, metres_per_unit: 1.0, base_m: 0.0 }
    }
}

impl ElevationScale {
    fn height_m(&self, sample: f64) -> f32 {
        (self.base_m + self.metres_per_unit * sample) as f32
    }

    fn cell_m(&self) -> DVec2 {
        DVec2::new(self.cell_x_m, self.cell_z_m)
    }

    fn validate(&self) -> Result<(), SettingError> {
        require("metres_per_unit", self.metres_per_unit, METRES_PER_UNIT)?;
        require("base_m", self.base_m, BASE_M)
    }
}

impl RawSample {
    fn bytes(self) -> usize {
        match self {
            Self::F32LittleEndian => 4,
            _ => 2,
        }
    }

    /// The sample in a chunk of [`bytes`](Self::bytes) bytes.
    fn read(self, chunk: &[u8]) -> f64 {
        match (self, chunk) {
            (Self::U16LittleEndian, &[a, b]) => f64::from(u16::from_le_bytes([a, b])),
            (Self::U16BigEndian, &[a, b]) => f64::from(u16::from_be_bytes([a, b])),
            (Self::I16LittleEndian, &[a, b]) => f64::from(i16::from_le_bytes([a, b])),
            (Self::I16BigEndian, &[a, b]) => f64::from(i16::from_be_bytes([a, b])),
            (Self::F32LittleEndian, &[a, b, c, d]) => f64::from(f32::from_le_bytes([a, b, c, d])),
            _ => f64::NAN,
        }
    }
}

impl ElevationGrid {
    /// Reads a PNG with 16 bits of grey.
    ///
    /// # Errors
    /// [`TerrainError::Format`] for a PNG of another kind, [`TerrainError::Unreadable`] for one that is damaged, cut
    /// off or no PNG, and those of [`ElevationGrid::new`] and of a scale outside its domain.
    pub fn from_png(bytes: &[u8], scale: &ElevationScale) -> Result<Self, TerrainError> {
        scale.validate()?;
        let unreadable = |error: image::ImageError| TerrainError::Unreadable { reason: error.to_string() };
        let mut limits = Limits::default();
        limits.max_alloc = Some(MOST_DECODER_BYTES);
        let decoder = PngDecoder::with_limits(Cursor::new(bytes), limits).map_err(unreadable)?;
        let (columns, rows) = decoder.dimensions();
        require_size(columns, rows)?;
        if decoder.original_color_type() != ExtendedColorType::L16 {
            let found = format!("a PNG with {:?} samples", decoder.original_color_type());
            return Err(TerrainError::Format { found, allowed: "a PNG with 16 bits of grey (L16)" });
        }
        let image = DynamicImage::from_decoder(decoder).map_err(unreadable)?.into_luma16();
        let heights_m = image.as_raw().iter().map(|&sample| scale.height_m(f64::from(sample))).collect();
        Self::new(columns, rows, scale.cell_m(), heights_m)
    }

    /// Reads `columns` x `rows` raw samples without a header, row by row.
    ///
    /// # Errors
    /// [`TerrainError::Count`] for a file of another length, and those of [`ElevationGrid::new`] and of a scale outside
    /// its domain.
    pub fn from_raw(
        bytes: &[u8],
        columns: u32,
        rows: u32,
        sample: RawSample,
        scale: &ElevationScale,
    ) -> Result<Self, TerrainError> {
        scale.validate()?;
        require_size(columns, rows)?;
        let expected = u64::from(columns) * u64::from(rows) * sample.bytes() as u64;
        if bytes.len() as u64 != expected {
            let (field, found) = ("bytes of the raw file".to_owned(), bytes.len());
            return Err(TerrainError::Count { field, found, columns, rows, expected });
        }
        let heights_m = bytes.chunks_exact(sample.bytes()).map(|chunk| scale.height_m(sample.read(chunk))).collect();
        Self::new(columns, rows, scale.cell_m(), heights_m)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::{GrayImage, ImageBuffer, ImageFormat, Luma};

    const ROCKIES: &[u8] = include_bytes!("../../assets/terrain/rmnp-dem-16bit.png");

    fn png(image: impl Into<DynamicImage>) -> Vec<u8> {
        let mut bytes = Cursor::new(Vec::new());
        image.into().write_to(&mut bytes, ImageFormat::Png).unwrap();
        bytes.into_inner()
    }

    #[test]
    fn a_real_map_is_read() {
        let scale = ElevationScale { cell_x_m: 233.0, cell_z_m: 234.0, ..Default::default() };
        let grid = ElevationGrid::from_png(ROCKIES, &scale).unwrap();
        assert_eq!((grid.columns(), grid.rows()), (152, 187));
        let (least, greatest) = grid.heights_m().iter().fold((f32::MAX, f32::MIN), |(a, b), &h| (a.min(h), b.max(h)));
        assert_eq!((least, greatest), (2281.0, 4261.0));
    }

    #[test]
    fn samples_are_scaled() {
        let image = ImageBuffer::from_fn(3, 2, |x, y| Luma([(x + 10 * y) as u16]));
        let scale = ElevationScale { metres_per_unit: 0.5, base_m: 100.0, ..Default::default() };
        let grid = ElevationGrid::from_png(&png(image), &scale).unwrap();
        assert_eq!(grid.heights_m(), [100.0, 100.5, 101.0, 105.0, 105.5, 106.0]);
    }

    #[test]
    fn an_eight_bit_png_is_refused_by_its_kind() {
        let error = ElevationGrid::from_png(&png(GrayImage::new(4, 4)), &ElevationScale::default()).unwrap_err();
        assert_eq!(
            error.to_string(),
            "the elevation file is a PNG with L8 samples, but must be a PNG with 16 bits of grey (L16)"
        );
    }

    #[test]
    fn a_png_cut_off_anywhere_is_an_error() {
        for length in (0..ROCKIES.len() - 12).step_by(997) {
            let error = ElevationGrid::from_png(&ROCKIES[..length], &ElevationScale::default()).unwrap_err();
            assert!(matches!(error, TerrainError::Unreadable { .. }), "{length} bytes: {error}");
        }
    }

    #[test]
    fn a_header_that_promises_gigabytes_is_refused_before_they_are_asked_for() {
        let mut bytes = png(ImageBuffer::from_fn(3, 2, |_, _| Luma([7_u16])));
        // Width and height follow the signature and the name of the header; then comes its checksum.
        bytes[16..20].copy_from_slice(&0x7fff_ffff_u32.to_be_bytes());
        bytes[20..24].copy_from_slice(&0x7fff_ffff_u32.to_be_bytes());
        assert!(ElevationGrid::from_png(&bytes, &ElevationScale::default()).is_err());
    }

    #[test]
    fn raw_samples_are_read_in_every_form() {
        let read = |bytes: &[u8], sample| {
            let grid = ElevationGrid::from_raw(bytes, 2, 2, sample, &ElevationScale::default());
            grid.unwrap().heights_m().to_vec()
        };
        assert_eq!(read(&[1, 0, 2, 0, 0, 1, 255, 255], RawSample::U16LittleEndian), [1.0, 2.0, 256.0, 65535.0]);
        assert_eq!(read(&[0, 1, 0, 2, 1, 0, 255, 255], RawSample::U16BigEndian), [1.0, 2.0, 256.0, 65535.0]);
        assert_eq!(read(&[1, 0, 2, 0, 0, 1, 255, 255], RawSample::I16LittleEndian), [1.0, 2.0, 256.0, -1.0]);
        assert_eq!(read(&[0, 1, 0, 2, 1, 0, 255, 255], RawSample::I16BigEndian), [1.0, 2.0, 256.0, -1.0]);
        let floats: Vec<u8> = [1.5f32, -2.0, 0.0, 8.0].into_iter().flat_map(f32::to_le_bytes).collect();
        assert_eq!(read(&floats, RawSample::F32LittleEndian), [1.5, -2.0, 0.0, 8.0]);
    }

    #[test]
    fn a_raw_file_of_another_length_or_with_nan_is_refused() {
        let error = |bytes: &[u8], sample| {
            let scale = ElevationScale::default();
            ElevationGrid::from_raw(bytes, 2, 2, sample, &scale).unwrap_err().to_string()
        };
        assert_eq!(error(&[0; 7], RawSample::U16LittleEndian), "`bytes of the raw file` holds 7, but 2 x 2 need 8");
        let floats: Vec<u8> = [1.5f32, f32::NAN, 0.0, 8.0].into_iter().flat_map(f32::to_le_bytes).collect();
        assert!(error(&floats, RawSample::F32LittleEndian).contains("column 1, row 0 is NaN"));
    }

    #[test]
    fn a_bad_scale_is_refused_by_name() {
        let scale = ElevationScale { metres_per_unit: 0.0, ..Default::default() };
        let error = ElevationGrid::from_png(ROCKIES, &scale).unwrap_err().to_string();
        assert!(error.starts_with("`metres_per_unit` is 0"), "{error}");
    }
}
