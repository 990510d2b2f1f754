//! Every format: real files in all containers, voids, what is told, and files that are damaged.

mod damaged;
mod files;

use super::{Elevation, ElevationNotice, ElevationSettings, RawLayout, RawSample};
use crate::terrain::error::TerrainError;
use image::{DynamicImage, ImageFormat};
use std::io::Cursor;
use tiff::encoder::{TiffEncoder, colortype::ColorType};

const ROCKIES: &[u8] = include_bytes!("../../../assets/terrain/rmnp-dem-16bit.png");
const INTEGERS: &[u8] = include_bytes!("../../../tests/data/cases/elevation/metres-with-nodata.tif");
const FLOATS: &[u8] = include_bytes!("../../../tests/data/cases/elevation/float-metres.tif");
const ASCII: &[u8] = include_bytes!("../../../tests/data/cases/elevation/ascii-grid.asc");
const VOIDS: &[u8] = include_bytes!("../../../tests/data/cases/elevation/voids-65535.png");
const SIGNED_VOIDS: &[u8] = include_bytes!("../../../tests/data/cases/elevation/signed-voids-read-as-unsigned.png");
const EIGHT_BIT: &[u8] = include_bytes!("../../../tests/data/cases/elevation/eight-bit.png");

/// Cells of 30 m, for files that do not have theirs.
fn told() -> ElevationSettings {
    ElevationSettings { cell_x_m: Some(30.0), ..Default::default() }
}

fn read(name: &str, bytes: &[u8], settings: &ElevationSettings) -> Elevation {
    Elevation::read(name, bytes, settings).unwrap_or_else(|error| panic!("{name}: {error}"))
}

fn error(name: &str, bytes: &[u8], settings: &ElevationSettings) -> String {
    Elevation::read(name, bytes, settings).expect_err("it should have been refused").to_string()
}

fn rockies() -> Vec<f32> {
    read("rockies.png", ROCKIES, &told()).grid.heights_m().to_vec()
}

/// What stands apart: its value, and in how many cells.
fn apart(elevation: &Elevation) -> Vec<(f32, usize)> {
    let of = |notice: &ElevationNotice| match notice {
        ElevationNotice::StandsApart { value, cells, .. } => Some((*value, *cells)),
        _ => None,
    };
    elevation.notices.iter().filter_map(of).collect()
}

fn png(image: impl Into<DynamicImage>) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    image.into().write_to(&mut bytes, ImageFormat::Png).unwrap();
    bytes.into_inner()
}

/// A TIFF of 3 x 2 samples with tags of doubles, of shorts and of text.
fn geotiff<C: ColorType>(
    samples: &[C::Inner],
    doubles: &[(u16, &[f64])],
    keys: &[u16],
    texts: &[(u16, &str)],
) -> Vec<u8>
where
    [C::Inner]: tiff::encoder::TiffValue,
{
    use tiff::tags::Tag;
    let mut bytes = Cursor::new(Vec::new());
    let mut encoder = TiffEncoder::new(&mut bytes).unwrap();
    let mut image = encoder.new_image::<C>(3, 2).unwrap();
    for (tag, value) in doubles {
        image.encoder().write_tag(Tag::from_u16_exhaustive(*tag), *value).unwrap();
    }
    if !keys.is_empty() {
        image.encoder().write_tag(Tag::GeoKeyDirectoryTag, keys).unwrap();
    }
    for (tag, text) in texts {
        image.encoder().write_tag(Tag::from_u16_exhaustive(*tag), *text).unwrap();
    }
    image.write_data(samples).unwrap();
    bytes.into_inner()
}

/// An SRTM tile of 1201 x 1201 samples.
fn tile(height_m: impl Fn(usize, usize) -> i16) -> Vec<u8> {
    (0..1201 * 1201).flat_map(|index| height_m(index % 1201, index / 1201).to_be_bytes()).collect()
}
