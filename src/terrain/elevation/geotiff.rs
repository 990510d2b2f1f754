//! GeoTIFF: one band of integers or floats.

use super::{
    geokeys::{GeoTags, scale_of_metadata},
    samples::Samples,
    settings::ElevationSettings,
};
use crate::{
    setting::SettingError,
    terrain::{elevation_grid::require_size, error::TerrainError},
};
use std::io::Cursor;
use tiff::{
    ColorType, TiffError, TiffUnsupportedError,
    decoder::{Decoder, DecodingResult, Limits},
    tags::Tag,
};

/// What the decoder may allocate for all samples: the largest grid with 64 bits a sample.
const MOST_SAMPLE_BYTES: usize = 1 << 29;
/// And for one strip or tile, and for one tag.
const MOST_STRIP_BYTES: usize = 1 << 28;
const MOST_TAG_BYTES: usize = 1 << 24;
/// Where 0 is white, samples are written the other way round.
const WHITE_IS_ZERO: u32 = 0;
/// GDAL's metadata, as XML.
const GDAL_METADATA: Tag = Tag::Unknown(42112);

type GeoTiff<'a> = Decoder<Cursor<&'a [u8]>>;

/// Reads the samples of the first image of a TIFF, and what its tags say about them.
pub(super) fn read(bytes: &[u8], settings: &ElevationSettings) -> Result<Samples, TerrainError> {
    let mut decoder = Decoder::new(Cursor::new(bytes)).map_err(unreadable)?.with_limits(limits());
    let (columns, rows) = decoder.dimensions().map_err(unreadable)?;
    require_size(columns, rows)?;
    require_one_band(&mut decoder, settings)?;
    let tags = geo_tags(&mut decoder)?;
    let scale = scale(&mut decoder, &tags)?;
    let no_data = no_data(&mut decoder)?;
    let (values, full_scale) = in_single_precision(decoder.read_image().map_err(unreadable)?);
    let expected = u64::from(columns) * u64::from(rows);
    if values.len() as u64 != expected {
        let field = "samples of the GeoTIFF".to_owned();
        return Err(TerrainError::Count { field, found: values.len(), columns, rows, expected });
    }
    Ok(Samples { columns, rows, values, full_scale, no_data, scale, georeference: tags.georeference()? })
}

fn limits() -> Limits {
    let mut limits = Limits::default();
    limits.decoding_buffer_size = MOST_SAMPLE_BYTES;
    limits.intermediate_buffer_size = MOST_STRIP_BYTES;
    limits.ifd_value_size = MOST_TAG_BYTES;
    limits
}

fn unreadable(error: TiffError) -> TerrainError {
    match error {
        TiffError::UnsupportedError(TiffUnsupportedError::UnsupportedCompressionMethod(method)) => {
            TerrainError::Format {
                found: format!("a TIFF compressed by {method:?}"),
                allowed: "one compressed by deflate, LZW or PackBits, or not at all (gdal_translate -co COMPRESS=DEFLATE makes one)",
            }
        }
        other => TerrainError::Unreadable { reason: other.to_string() },
    }
}

/// Refuses pictures: colours, several bands, 8 bits whose heights are not told.
fn require_one_band(decoder: &mut GeoTiff<'_>, settings: &ElevationSettings) -> Result<(), TerrainError> {
    let kind = decoder.colortype().map_err(unreadable)?;
    let photometric = decoder.find_tag_unsigned::<u32>(Tag::PhotometricInterpretation).map_err(unreadable)?;
    let found = format!("a TIFF with {kind:?} samples");
    match kind {
        ColorType::Gray(8) if settings.height_range_m.is_none() => Err(TerrainError::Format {
            found,
            allowed: "one of 16 bits or more: 8 bits have 256 heights only, and do not say which; `height_range_m` does",
        }),
        ColorType::Gray(8 | 16 | 32 | 64) if photometric != Some(WHITE_IS_ZERO) => Ok(()),
        _ => Err(TerrainError::Format { found, allowed: "a GeoTIFF of one band, of integers or floats" }),
    }
}

fn geo_tags(decoder: &mut GeoTiff<'_>) -> Result<GeoTags, TerrainError> {
    let mut numbers = |tag| match decoder.find_tag(tag).map_err(unreadable)? {
        Some(value) => value.into_f64_vec().map_err(unreadable),
        None => Ok(Vec::new()),
    };
    let [pixel_scale, tie_point, transformation] =
        [numbers(Tag::ModelPixelScaleTag)?, numbers(Tag::ModelTiepointTag)?, numbers(Tag::ModelTransformationTag)?];
    let directory = decoder.find_tag_unsigned_vec::<u16>(Tag::GeoKeyDirectoryTag).map_err(unreadable)?;
    Ok(GeoTags { directory: directory.unwrap_or_default(), pixel_scale, tie_point, transformation })
}

/// Metres of a unit of a sample, and of a sample of 0, where tags say them.
fn scale(decoder: &mut GeoTiff<'_>, tags: &GeoTags) -> Result<Option<[f64; 2]>, TerrainError> {
    let unit_m = tags.vertical_unit_m()?;
    let of_metadata = text(decoder, GDAL_METADATA)?.and_then(|xml| scale_of_metadata(&xml));
    if unit_m.is_none() && of_metadata.is_none() {
        return Ok(None);
    }
    Ok(Some(of_metadata.unwrap_or([1.0, 0.0]).map(|value| value * unit_m.unwrap_or(1.0))))
}

fn no_data(decoder: &mut GeoTiff<'_>) -> Result<Option<f64>, TerrainError> {
    let Some(text) = text(decoder, Tag::GdalNodata)? else { return Ok(None) };
    let text = text.trim_matches(|c: char| c.is_whitespace() || c == '\0');
    let number = text.parse().map_err(|_| SettingError::new("GDAL_NODATA", format!("`{text:.40}`"), "a number"));
    Ok(Some(number?))
}

fn text(decoder: &mut GeoTiff<'_>, tag: Tag) -> Result<Option<String>, TerrainError> {
    let value = decoder.find_tag(tag).map_err(unreadable)?;
    value.map(|value| value.into_string().map_err(unreadable)).transpose()
}

/// The samples, and the greatest that can be written where they are those of a picture.
fn in_single_precision(samples: DecodingResult) -> (Vec<f32>, Option<f64>) {
    fn all<T: Copy>(samples: &[T], as_f32: impl Fn(T) -> f32) -> Vec<f32> {
        samples.iter().map(|&sample| as_f32(sample)).collect()
    }
    match samples {
        DecodingResult::U8(samples) => (all(&samples, f32::from), Some(f64::from(u8::MAX))),
        DecodingResult::U16(samples) => (all(&samples, f32::from), Some(f64::from(u16::MAX))),
        DecodingResult::U32(samples) => (all(&samples, |sample| sample as f32), None),
        DecodingResult::U64(samples) => (all(&samples, |sample| sample as f32), None),
        DecodingResult::F16(samples) => (all(&samples, f32::from), None),
        DecodingResult::F32(samples) => (samples, None),
        DecodingResult::F64(samples) => (all(&samples, |sample| sample as f32), None),
        DecodingResult::I8(samples) => (all(&samples, f32::from), None),
        DecodingResult::I16(samples) => (all(&samples, f32::from), None),
        DecodingResult::I32(samples) => (all(&samples, |sample| sample as f32), None),
        DecodingResult::I64(samples) => (all(&samples, |sample| sample as f32), None),
    }
}
