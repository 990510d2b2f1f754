//! Files that are cut off, damaged or made to do harm: an error each, no panic, and no memory for what a header promises.

use super::*;
use image::{ImageBuffer, Luma};
use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};
use tiff::encoder::colortype::GrayI16;

/// Ways to damage each file.
const DAMAGES: u32 = 400;

fn small_grid() -> Vec<u8> {
    b"ncols 4\nnrows 3\nxllcorner 423000\nyllcorner 4446000\ncellsize 30\nNODATA_value -9999\n\
      1 2 3 4\n5 -9999 7 8\n9 10 11 12.5\n"
        .to_vec()
}

fn small_tiff() -> Vec<u8> {
    let doubles: [(u16, &[f64]); 2] = [(33550, &[30.0, 30.0, 0.0]), (33922, &[0.0, 0.0, 0.0, 7.0, 60.0, 0.0])];
    geotiff::<GrayI16>(&[1, 2, 3, -1, 5, 6], &doubles, &[1, 1, 0, 1, 1024, 0, 1, 1], &[(42113, "-1")])
}

fn small_png() -> Vec<u8> {
    png(ImageBuffer::from_fn(9, 7, |x, y| Luma([(x * y) as u16])))
}

#[test]
fn a_damaged_file_never_panics_and_never_gives_a_height_that_is_no_number() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(20);
    let raw =
        ElevationSettings { raw: Some(RawLayout { columns: 3, rows: 2, sample: RawSample::F32BigEndian }), ..told() };
    let files = [
        ("a.asc", small_grid(), told()),
        ("a.tif", small_tiff(), told()),
        ("a.tif", INTEGERS.to_vec(), told()),
        ("a.tif", FLOATS.to_vec(), told()),
        ("a.png", small_png(), told()),
        ("a.raw", vec![7; 24], raw),
    ];
    for (name, bytes, settings) in &files {
        for _ in 0..DAMAGES {
            let mut bytes = bytes.clone();
            // Most of what matters is at the ends.
            let reach = if random.random() { bytes.len() } else { bytes.len().min(400) };
            for _ in 0..random.random_range(1..6) {
                let at = random.random_range(0..reach);
                bytes[at] = *[random.random(), 0, 255, b'9', b' '].get(random.random_range(0..5)).unwrap_or(&0);
            }
            if random.random_range(0..4) == 0 {
                bytes.truncate(random.random_range(0..bytes.len()));
            }
            if let Ok(elevation) = Elevation::read(name, &bytes, settings) {
                assert!(elevation.grid.heights_m().iter().all(|height| height.is_finite()), "{name}");
            }
        }
    }
}

#[test]
fn a_file_cut_off_anywhere_is_an_error() {
    for length in (0..ROCKIES.len() - 12).step_by(997) {
        let error = Elevation::read("a.png", &ROCKIES[..length], &told()).unwrap_err();
        assert!(matches!(error, TerrainError::Unreadable { .. } | TerrainError::Format { .. }), "{length}: {error}");
    }
    let header = ASCII.iter().position(|&byte| byte == b'e').unwrap();
    for length in (header..ASCII.len() - 6).step_by(797) {
        assert!(Elevation::read("a.asc", &ASCII[..length], &told()).is_err(), "{length} bytes of a grid");
    }
    for length in (0..INTEGERS.len() - 1).step_by(997) {
        assert!(Elevation::read("a.tif", &INTEGERS[..length], &told()).is_err(), "{length} bytes of a GeoTIFF");
    }
}

#[test]
fn headers_that_promise_gigabytes_are_refused_before_they_are_asked_for() {
    let mut bytes = small_png();
    // Width and height follow the signature and the name of the header; then comes its checksum.
    bytes[16..20].copy_from_slice(&0x7fff_ffff_u32.to_be_bytes());
    bytes[20..24].copy_from_slice(&0x7fff_ffff_u32.to_be_bytes());
    assert!(Elevation::read("a.png", &bytes, &told()).is_err());
    let refused = |text: &str| error("a.asc", text.as_bytes(), &told());
    assert!(refused("ncols 4000000000\nnrows 4000000000\ncellsize 1\n1").starts_with("`header.columns` is 4000000000"));
    assert!(refused("ncols 16384\nnrows 4096\ncellsize 1\n1 2 3").starts_with("`samples of the grid` holds 3"));
    assert!(refused("ncols -3\nnrows 4\n1").starts_with("`ncols` is -3, but must be a whole number"));
    assert!(refused("ncols 1e99\nnrows 4\n1").starts_with("`ncols` is 1000000"));
    assert!(refused("nrows 4\n1").starts_with("`ncols` is not in the header"));
}

#[test]
fn what_is_wrong_with_a_grid_is_told_by_its_place() {
    let refused = |text: &str| error("a.asc", text.as_bytes(), &ElevationSettings::default());
    let header = "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 30\n";
    assert_eq!(refused(&format!("{header}1 2\nx 4")), "`sample at column 0, row 1` is `x`, but must be a number");
    assert_eq!(refused(&format!("{header}1 2 3 4 5")), "`samples of the grid` holds 5, but 2 x 2 need 4");
    assert_eq!(refused(&format!("{header}1 2 3")), "`samples of the grid` holds 3, but 2 x 2 need 4");
    assert_eq!(refused(&format!("{header}-9999 -9999\n-9999 nan")), "no cell has an elevation");
    assert!(refused("ncols 2\nnrows 2\ncolour 3\n1 2 3 4").contains("`colour`"));
    assert_eq!(refused("ncols 2\nnrows"), "`nrows` is ``, but must be a number");
    assert!(refused("ncols 2\nnrows 2\ncellsize 0\nxllcorner 4000\n1 2 3 4").contains("`cell_x_m` is 0"));
    assert!(refused("ncols 2\nnrows 2\n1 2 3 4").starts_with("`cell_x_m` is not given"));
}

#[test]
fn files_of_other_kinds_are_refused_with_what_to_do() {
    assert!(error("a.png", b"no picture at all", &told()).contains("of no kind that is known"));
    assert!(error("a.hgt", b"PK\x03\x04....", &told()).contains("unpack it first"));
    assert!(error("a.tif", b"", &told()).contains("empty"));
    let mut zstd = small_tiff();
    // The entry of the compression, 259, of one short: 1 for none.
    let entry = zstd.windows(8).position(|bytes| bytes == [3, 1, 3, 0, 1, 0, 0, 0]).unwrap();
    zstd[entry + 8..entry + 10].copy_from_slice(&50_000_u16.to_le_bytes());
    assert!(error("a.tif", &zstd, &told()).contains("gdal_translate -co COMPRESS=DEFLATE"));
    assert!(error("a.tif", b"II*\0", &told()).starts_with("the elevation file cannot be read"));
}
