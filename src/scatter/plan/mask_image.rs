//! Masks as pictures, for programs that paint.
//!
//! A pixel is a point. The picture's upper row is the first of the rows, that of the least z: north is up, and west is to the left. White is
//! full density, the digit 9, and black is nothing.

use std::io::Cursor;

use image::{
    DynamicImage, ExtendedColorType, ImageDecoder, ImageEncoder, ImageError, Limits, Rgba,
    codecs::png::{PngDecoder, PngEncoder},
};
use thiserror::Error;

use super::mask::{self, FULL, MOST_POINTS_ALONG};
use crate::setting::SettingError;

/// What the decoder may allocate: the largest mask with four samples of 16 bits, and as much again for its own work.
const MOST_DECODER_BYTES: u64 = 1 << 28;
/// What red, green and blue have of the luminance (ITU-R BT.709).
const LUMINANCE: [f32; 3] = [0.2126, 0.7152, 0.0722];

/// Why a mask was not made a picture, or a picture not a mask.
#[derive(Debug, Error)]
pub(crate) enum MaskImageError {
    /// It is not a PNG, or a damaged one.
    #[error("the picture cannot be read: {0}")]
    Unreadable(ImageError),
    /// It has more pixels than a mask has points.
    #[error("the picture has {columns} x {rows} pixels, but a mask has at most {most} x {most} points")]
    TooLarge { columns: u32, rows: u32, most: usize },
    /// The rows are not those of a mask.
    #[error(transparent)]
    Rows(#[from] SettingError),
    /// The picture cannot be encoded.
    #[error("the picture cannot be written: {0}")]
    Encoding(ImageError),
}

/// The rows of a mask as a PNG with 8 bits of grey.
pub(crate) fn png_of_mask(rows: &[String]) -> Result<Vec<u8>, MaskImageError> {
    mask::validate(rows)?;
    let pixels: Vec<u8> = rows.iter().flat_map(|row| row.bytes().map(grey)).collect();
    let (width, height) = (rows[0].len() as u32, rows.len() as u32);
    let mut bytes = Vec::new();
    PngEncoder::new(&mut bytes)
        .write_image(&pixels, width, height, ExtendedColorType::L8)
        .map_err(MaskImageError::Encoding)?;
    Ok(bytes)
}

/// The rows of a mask from any PNG: the luminance of each pixel as the nearest digit. What is transparent is as much nearer to nothing.
pub(crate) fn mask_of_png(bytes: &[u8]) -> Result<Vec<String>, MaskImageError> {
    let mut limits = Limits::default();
    limits.max_alloc = Some(MOST_DECODER_BYTES);
    let decoder = PngDecoder::with_limits(Cursor::new(bytes), limits).map_err(MaskImageError::Unreadable)?;
    let (columns, rows) = decoder.dimensions();
    if columns.max(rows) as usize > MOST_POINTS_ALONG {
        return Err(MaskImageError::TooLarge { columns, rows, most: MOST_POINTS_ALONG });
    }
    let picture = DynamicImage::from_decoder(decoder).map_err(MaskImageError::Unreadable)?.into_rgba16();
    let rows: Vec<String> = picture.rows().map(|row| row.map(sign).collect()).collect();
    mask::validate(&rows)?;
    Ok(rows)
}

/// The grey of a character of a mask.
fn grey(sign: u8) -> u8 {
    let level = if sign.is_ascii_digit() { sign - b'0' } else { 0 };
    (f32::from(u8::MAX) * f32::from(level) / FULL).round() as u8
}

/// The character of a pixel; nothing is a dot, as the brush writes it.
fn sign(pixel: &Rgba<u16>) -> char {
    let [red, green, blue, alpha] = pixel.0.map(|sample| f32::from(sample) / f32::from(u16::MAX));
    let luminance = LUMINANCE[0] * red + LUMINANCE[1] * green + LUMINANCE[2] * blue;
    match (FULL * luminance * alpha).round() as u32 {
        0 => '.',
        level => char::from_digit(level, 10).unwrap_or('9'),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::{ImageBuffer, ImageFormat, Luma};

    fn rows(rows: &[&str]) -> Vec<String> {
        rows.iter().map(|row| (*row).to_owned()).collect()
    }

    fn png(picture: &DynamicImage) -> Vec<u8> {
        let mut bytes = Cursor::new(Vec::new());
        picture.write_to(&mut bytes, ImageFormat::Png).unwrap();
        bytes.into_inner()
    }

    #[test]
    fn every_digit_comes_back_from_its_grey() {
        let mask = rows(&[".123456789", "987654321.", "..........", "9999999999"]);
        let bytes = png_of_mask(&mask).unwrap();
        assert_eq!(mask_of_png(&bytes).unwrap(), mask);
        let DynamicImage::ImageLuma8(picture) = image::load_from_memory(&bytes).unwrap() else { panic!("grey") };
        let upper: Vec<u8> = picture.as_raw()[..10].to_vec();
        assert_eq!(upper, [0, 28, 57, 85, 113, 142, 170, 198, 227, 255], "the first row is the upper one");
        let zeros = png_of_mask(&rows(&["09"])).unwrap();
        assert_eq!(mask_of_png(&zeros).unwrap(), [".9"], "nothing is a dot");
    }

    #[test]
    fn pictures_of_16_bits_and_of_colour_have_the_nearest_digits() {
        let deep = ImageBuffer::<Luma<u16>, _>::from_raw(4, 1, vec![0_u16, 7282, 40_000, 65_535]).unwrap();
        assert_eq!(mask_of_png(&png(&DynamicImage::ImageLuma16(deep))).unwrap(), [".159"]);
        let pixels: [[u8; 4]; 5] =
            [[255; 4], [255, 255, 255, 128], [0, 255, 0, 255], [255, 0, 0, 255], [255, 255, 255, 0]];
        let colour = ImageBuffer::<Rgba<u8>, _>::from_raw(5, 1, pixels.concat()).unwrap();
        assert_eq!(mask_of_png(&png(&DynamicImage::ImageRgba8(colour))).unwrap(), ["9562."]);
    }

    #[test]
    fn damaged_and_too_large_pictures_are_refused() {
        let whole = png_of_mask(&rows(&[".123456789", "987654321."])).unwrap();
        let cut = mask_of_png(&whole[..whole.len() / 2]).unwrap_err();
        assert!(matches!(cut, MaskImageError::Unreadable(_)), "{cut}");
        assert!(matches!(mask_of_png(b"no picture"), Err(MaskImageError::Unreadable(_))));
        let wide = png(&DynamicImage::new_luma8(4097, 2));
        let error = mask_of_png(&wide).unwrap_err().to_string();
        assert_eq!(error, "the picture has 4097 x 2 pixels, but a mask has at most 4096 x 4096 points");
        assert!(matches!(png_of_mask(&rows(&["12", "1"])), Err(MaskImageError::Rows(_))));
    }
}
