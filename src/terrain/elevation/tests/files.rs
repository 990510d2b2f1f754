//! Whole files: the given ones, and one of each kind.

use super::*;
use approx::assert_relative_eq;
use bevy::math::DVec2;
use image::{GrayImage, ImageBuffer, Luma, RgbImage};
use tiff::encoder::colortype::{Gray8, Gray16, Gray32Float, Gray64Float, GrayI16, GrayI32, RGB16};

#[test]
fn a_real_png_is_read() {
    let elevation = read("rmnp-dem-16bit.png", ROCKIES, &ElevationSettings::with_cells(233.0, 234.0));
    let grid = &elevation.grid;
    assert_eq!((grid.columns(), grid.rows(), grid.gaps()), (152, 187, 0));
    let (least, greatest) = grid.measured_m().fold((f32::MAX, f32::MIN), |(a, b), h| (a.min(h), b.max(h)));
    assert_eq!((least, greatest), (2281.0, 4261.0));
    assert_eq!(elevation.notices, []);
}

#[test]
fn the_same_map_in_a_geotiff_of_integers_has_its_cells_and_its_gaps() {
    let elevation = read("metres-with-nodata.tif", INTEGERS, &ElevationSettings::default());
    let (grid, rockies) = (&elevation.grid, rockies());
    assert_eq!((grid.columns(), grid.rows(), grid.cell_m()), (152, 187, DVec2::new(233.0, 234.0)));
    assert!(grid.gaps() > 0);
    assert_eq!(elevation.notices, [ElevationNotice::NoData { cells: grid.gaps(), of: 152 * 187 }]);
    for (index, (found, real)) in grid.heights_m().iter().zip(&rockies).enumerate() {
        assert!((2281.0..=4261.0).contains(found), "{found}");
        assert!(!grid.is_measured(index) || found == real, "{found} for {real}");
    }
}

#[test]
fn the_same_map_in_a_geotiff_of_floats_is_the_same() {
    let elevation = read("float-metres.tif", FLOATS, &ElevationSettings::default());
    assert_eq!((elevation.grid.cell_m(), elevation.grid.gaps()), (DVec2::new(233.0, 234.0), 0));
    for (found, real) in elevation.grid.heights_m().iter().zip(&rockies()) {
        assert_relative_eq!(found, real, epsilon = 0.51);
    }
}

#[test]
fn the_same_map_in_an_ascii_grid_is_every_second_sample_of_it() {
    let elevation = read("ascii-grid.asc", ASCII, &ElevationSettings::default());
    let (grid, rockies) = (&elevation.grid, rockies());
    assert_eq!((grid.columns(), grid.rows(), grid.cell_m()), (76, 93, DVec2::splat(466.0)));
    for index in (0..grid.heights_m().len()).filter(|&index| grid.is_measured(index)) {
        assert_eq!(grid.heights_m()[index], rockies[index / 76 * 2 * 152 + index % 76 * 2]);
    }
}

#[test]
fn voids_of_a_png_are_warned_about_and_taken_out_when_they_are_told() {
    for (name, bytes, value) in [("voids-65535.png", VOIDS, 65535.0), ("signed-voids.png", SIGNED_VOIDS, 32768.0)] {
        let found = apart(&read(name, bytes, &told()));
        let [(void, cells)] = found[..] else { panic!("{name}: {found:?}") };
        assert_eq!(f64::from(void), value);
        let elevation = read(name, bytes, &ElevationSettings { no_data: Some(value), ..told() });
        assert_eq!(elevation.notices, [ElevationNotice::NoData { cells, of: 152 * 187 }], "{name}");
        assert!(elevation.grid.heights_m().iter().all(|height| (2281.0..=4261.0).contains(height)), "{name}");
    }
    let warning = read("voids-65535.png", VOIDS, &told()).notices[0].to_string();
    assert!(warning.contains("stands apart") && warning.ends_with("set `no_data` to 65535"), "{warning}");
    let elevation = read("rockies.png", ROCKIES, &ElevationSettings { no_data: Some(0.0), ..told() });
    assert_eq!(elevation.notices, [ElevationNotice::NoDataUnused { value: 0.0 }]);
}

#[test]
fn eight_bits_need_a_range_of_heights() {
    let refused = error("eight-bit.png", EIGHT_BIT, &told());
    assert!(refused.contains("L8") && refused.contains("`height_range_m`"), "{refused}");
    let range = ElevationSettings { height_range_m: Some([2281.0, 4261.0]), ..told() };
    let step_m = 1980.0 / 255.0;
    for (found, real) in read("eight-bit.png", EIGHT_BIT, &range).grid.heights_m().iter().zip(&rockies()) {
        assert!((found - real).abs() <= step_m, "{found} for {real}");
    }
    let sixteen = read("", &png(ImageBuffer::from_fn(3, 2, |x, _| Luma([[0, 65535, 32768_u16][x as usize]]))), &range);
    assert_eq!(sixteen.grid.heights_m()[..2], [2281.0, 4261.0]);
    assert_relative_eq!(sixteen.grid.heights_m()[2], 3271.015, epsilon = 1e-2);
    assert!(error("float-metres.tif", FLOATS, &range).starts_with("`height_range_m` is 2281 to 4261"));
    assert!(error("", &png(RgbImage::new(4, 4)), &range).contains("Rgb8"));
    let small = geotiff::<Gray8>(&[0, 51, 102, 153, 204, 255], &[], &[], &[]);
    assert!(error("", &small, &told()).contains("`height_range_m`"));
    assert_eq!(read("", &small, &range).grid.heights_m()[1], 2281.0 + 396.0);
    assert!(error("", &png(GrayImage::new(4, 4)), &told()).contains("16 bits of grey"));
}

#[test]
fn samples_are_scaled() {
    let image = ImageBuffer::from_fn(3, 2, |x, y| Luma([(x + 10 * y) as u16]));
    let settings = ElevationSettings { metres_per_unit: 0.5, base_m: 100.0, ..told() };
    assert_eq!(read("", &png(image), &settings).grid.heights_m(), [100.0, 100.5, 101.0, 105.0, 105.5, 106.0]);
    assert!(
        error("", ROCKIES, &ElevationSettings { metres_per_unit: 0.0, ..told() }).starts_with("`metres_per_unit` is 0")
    );
}

#[test]
fn geotiffs_have_samples_of_any_kind() {
    const SCALE: (u16, &[f64]) = (33550, &[10.0, 20.0, 0.0]);
    const METRES: &[u16] = &[1, 1, 0, 1, 1024, 0, 1, 1];
    let heights = |bytes: &[u8]| {
        let elevation = read("", bytes, &ElevationSettings::default());
        assert_eq!(elevation.grid.cell_m(), DVec2::new(10.0, 20.0));
        elevation.grid.heights_m().to_vec()
    };
    let expected = [1.0, 2.0, 3.0, 4.0, 5.0, 600.0];
    assert_eq!(heights(&geotiff::<Gray16>(&[1, 2, 3, 4, 5, 600], &[SCALE], METRES, &[])), expected);
    assert_eq!(heights(&geotiff::<GrayI32>(&[1, 2, 3, 4, 5, 600], &[SCALE], METRES, &[])), expected);
    assert_eq!(heights(&geotiff::<Gray32Float>(&[1.0, 2.0, 3.0, 4.0, 5.0, 600.0], &[SCALE], METRES, &[])), expected);
    assert_eq!(heights(&geotiff::<Gray64Float>(&[1.0, 2.0, 3.0, 4.0, 5.0, 600.0], &[SCALE], METRES, &[])), expected);
    // The fill of a gap in the corner: the mean of its neighbours, which lie in one plane with it.
    let negative = geotiff::<GrayI16>(&[-9999, -2, -3, -4, -5, -6], &[SCALE], METRES, &[(42113, "-9999")]);
    assert_eq!(heights(&negative)[1..], [-2.0, -3.0, -4.0, -5.0, -6.0]);
    let not_numbers =
        geotiff::<Gray32Float>(&[1.0, f32::NAN, f32::MIN, 4.0, 5.0, 6.0], &[SCALE], METRES, &[(42113, "nan")]);
    assert_eq!(read("", &not_numbers, &told()).grid.gaps(), 2);
    let scaled =
        geotiff::<GrayI16>(&[1, 2, 3, 4, 5, 6], &[SCALE], METRES, &[(42112, "<Item role=\"scale\">0.5</Item>")]);
    assert_eq!(heights(&scaled), [0.5, 1.0, 1.5, 2.0, 2.5, 3.0]);
    let feet =
        geotiff::<GrayI16>(&[0, 0, 0, 0, 0, 1000], &[SCALE], &[1, 1, 0, 2, 1024, 0, 1, 1, 4099, 0, 1, 9002], &[]);
    assert_eq!(heights(&feet)[5], 304.8);
    assert!(error("", &geotiff::<RGB16>(&[0; 18], &[SCALE], METRES, &[]), &told()).contains("one band"));
    let unreadable = geotiff::<GrayI16>(&[0; 6], &[SCALE], METRES, &[(42113, "none")]);
    assert_eq!(error("", &unreadable, &told()), "`GDAL_NODATA` is `none`, but must be a number");
}

#[test]
fn degrees_are_turned_to_metres_at_the_latitude() {
    let doubles: [(u16, &[f64]); 2] =
        [(33550, &[1.0 / 3600.0, 1.0 / 3600.0, 0.0]), (33922, &[0.0, 0.0, 0.0, 7.0, 60.0, 0.0])];
    let bytes = geotiff::<GrayI16>(&[1, 2, 3, 4, 5, 6], &doubles, &[1, 1, 0, 1, 1024, 0, 1, 2], &[]);
    let elevation = read("", &bytes, &ElevationSettings::default());
    assert_relative_eq!(elevation.grid.cell_m().x, 55_800.0 / 3600.0, epsilon = 1e-3);
    assert_relative_eq!(elevation.grid.cell_m().y, 111_412.0 / 3600.0, epsilon = 1e-3);
    assert!(matches!(elevation.notices[..], [ElevationNotice::Degrees { is_guessed: false, .. }]));
    let grid = b"NCOLS 3\r\nNROWS 2\r\nXLLCENTER 7\r\nYLLCENTER 46\r\nCELLSIZE 0,000833333333\r\n1 2 3\r\n4 5,5 6\r\n";
    let elevation = read("alps.asc", grid, &ElevationSettings::default());
    assert_relative_eq!(elevation.grid.cell_m().y, 111_150.0 / 1200.0, epsilon = 0.05);
    assert_eq!(elevation.grid.heights_m()[4], 5.5);
    assert!(matches!(elevation.notices[..], [ElevationNotice::Degrees { is_guessed: true, .. }]));
    assert!(elevation.notices[0].is_warning());
}

#[test]
fn what_is_told_goes_before_what_the_file_says() {
    let elevation = read("ascii-grid.asc", ASCII, &told());
    assert_eq!(elevation.grid.cell_m(), DVec2::splat(30.0));
    assert!(elevation.notices.contains(&ElevationNotice::OtherCellSize { in_file_m: [466.0, 466.0] }));
    assert_eq!(
        error("rockies.png", ROCKIES, &ElevationSettings::default()),
        "`cell_x_m` is not given, but must be given, in metres: the file does not have the size of its cells"
    );
}

#[test]
fn an_srtm_tile_has_its_place_in_its_name() {
    let bytes = tile(|column, row| if (column, row) == (600, 600) { -32768 } else { (column / 2 + row) as i16 - 50 });
    let elevation = read("dem/N45W106.hgt", &bytes, &ElevationSettings::default());
    let grid = &elevation.grid;
    assert_eq!((grid.columns(), grid.rows(), grid.gaps()), (1201, 1201, 1));
    // At 45.5 degrees.
    assert_relative_eq!(grid.cell_m().x, 78_158.0 / 1200.0, epsilon = 0.01);
    assert_relative_eq!(grid.cell_m().y, 111_142.0 / 1200.0, epsilon = 0.01);
    assert_eq!((grid.heights_m()[0], grid.heights_m()[1201 * 1201 - 1]), (-50.0, 1750.0));
    let told_of = error("mountain.hgt", &bytes, &ElevationSettings::default());
    assert!(told_of.contains("N40W106.hgt") && told_of.contains("`cell_x_m`"), "{told_of}");
    assert_eq!(read("mountain.hgt", &bytes, &told()).grid.cell_m(), DVec2::splat(30.0));
    assert!(error("N45W106.hgt", &bytes[1..], &told()).contains("2884801 bytes"));
    let south = read("s46e007.hgt", &bytes, &ElevationSettings::default());
    assert_relative_eq!(south.grid.cell_m().x, grid.cell_m().x, epsilon = 1e-9);
}

#[test]
fn raw_samples_are_read_in_every_form() {
    let layout = |sample| ElevationSettings { raw: Some(RawLayout { columns: 2, rows: 2, sample }), ..told() };
    let of = |bytes: &[u8], sample| read("a.raw", bytes, &layout(sample)).grid.heights_m().to_vec();
    assert_eq!(of(&[1, 0, 2, 0, 0, 1, 255, 255], RawSample::U16LittleEndian), [1.0, 2.0, 256.0, 65535.0]);
    assert_eq!(of(&[0, 1, 0, 2, 1, 0, 255, 255], RawSample::U16BigEndian), [1.0, 2.0, 256.0, 65535.0]);
    assert_eq!(of(&[1, 0, 2, 0, 0, 1, 255, 255], RawSample::I16LittleEndian), [1.0, 2.0, 256.0, -1.0]);
    assert_eq!(of(&[0, 1, 0, 2, 1, 0, 255, 255], RawSample::I16BigEndian), [1.0, 2.0, 256.0, -1.0]);
    let floats = |bytes: fn(f32) -> [u8; 4]| [1.5, -2.0, 0.0, 8.0].into_iter().flat_map(bytes).collect::<Vec<u8>>();
    assert_eq!(of(&floats(f32::to_le_bytes), RawSample::F32LittleEndian), [1.5, -2.0, 0.0, 8.0]);
    assert_eq!(of(&floats(f32::to_be_bytes), RawSample::F32BigEndian), [1.5, -2.0, 0.0, 8.0]);
    assert_eq!(
        error("a.raw", &[0; 7], &layout(RawSample::U16LittleEndian)),
        "`bytes of the raw file` holds 7, but 2 x 2 need 8"
    );
    assert!(error("a.raw", &[0; 8], &told()).contains("`raw` layout is given"));
}
