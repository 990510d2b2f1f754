//! Maps of elevations as hill-shaded pictures.

use bevy::math::{DVec2, Vec3};
use bevy_windwood::terrain::{ElevationGrid, TerrainError};
use image::{Rgb, RgbImage, imageops};

/// Greatest number of samples along a side of a picture.
const MOST_SAMPLES: usize = 1024;
/// Least number of pixels along the longer side. Smaller maps are enlarged.
const LEAST_PIXELS: f64 = 640.0;
/// Root mean square slope that shows relief well.
const SHADED_SLOPE: f64 = 0.45;
/// Share of the samples beyond either end of the colours.
const SHARE_BEYOND: f64 = 0.01;
/// Direction to the light: north-west, 45 degrees up.
const LIGHT: Vec3 = Vec3::new(-0.5, std::f32::consts::FRAC_1_SQRT_2, -0.5);
/// From valleys to peaks.
const COLOURS: [[f32; 3]; 6] = [
    [116.0, 150.0, 118.0],
    [166.0, 183.0, 138.0],
    [214.0, 205.0, 160.0],
    [202.0, 174.0, 130.0],
    [178.0, 152.0, 130.0],
    [244.0, 242.0, 240.0],
];

/// The map with the means of neighbouring samples, so that no side has more than [`MOST_SAMPLES`].
///
/// # Errors
/// As [`ElevationGrid::new`].
pub fn reduced(map: &ElevationGrid) -> Result<ElevationGrid, TerrainError> {
    let block = map.columns().max(map.rows()).div_ceil(MOST_SAMPLES);
    // At least two samples of each side remain.
    let [across, down] = [map.columns(), map.rows()].map(|side| block.min(side / 2).max(1));
    let (columns, rows) = (map.columns() / across, map.rows() / down);
    let mut heights_m = vec![0.0_f64; columns * rows];
    for (row, heights) in map.heights_m().chunks_exact(map.columns()).take(rows * down).enumerate() {
        let sums = &mut heights_m[row / down * columns..][..columns];
        for (sum, block) in sums.iter_mut().zip(heights.chunks_exact(across)) {
            *sum += block.iter().map(|&height_m| f64::from(height_m)).sum::<f64>();
        }
    }
    let mean = |sum: f64| (sum / (across * down) as f64) as f32;
    let cell_m = map.cell_m() * DVec2::new(across as f64, down as f64);
    ElevationGrid::new(columns as u32, rows as u32, cell_m, heights_m.into_iter().map(mean).collect())
}

/// How elevations become colours and shades. Maps that are compared share one.
pub struct Shading {
    lowest_m: f32,
    highest_m: f32,
    exaggeration: f32,
}

impl Shading {
    /// The shading that suits a map.
    pub fn of(map: &ElevationGrid) -> Self {
        let mut heights_m = map.heights_m().to_vec();
        heights_m.sort_by(f32::total_cmp);
        let quantile = |share: f64| heights_m[(share * (heights_m.len() - 1) as f64) as usize];
        let samples = (map.columns() * map.rows()) as f64;
        let squares: f64 = places(map).map(|(column, row)| gradient(map, column, row).length_squared()).sum();
        let slope = (squares / samples).sqrt().max(1e-9);
        Self {
            lowest_m: quantile(SHARE_BEYOND),
            highest_m: quantile(1.0 - SHARE_BEYOND),
            exaggeration: (SHADED_SLOPE / slope) as f32,
        }
    }

    /// Draws a map from above, in its true proportions, north up.
    pub fn draw(&self, map: &ElevationGrid) -> RgbImage {
        let pixels = places(map).flat_map(|(column, row)| self.pixel(map, column, row).0).collect();
        let (columns, rows) = (map.columns() as u32, map.rows() as u32);
        let picture = RgbImage::from_raw(columns, rows, pixels).unwrap_or_default();
        let (width, height) = pixels_of(map);
        if (width, height) == (columns, rows) {
            return picture;
        }
        imageops::resize(&picture, width, height, imageops::FilterType::CatmullRom)
    }

    fn pixel(&self, map: &ElevationGrid, column: usize, row: usize) -> Rgb<u8> {
        let rise = gradient(map, column, row).as_vec2() * self.exaggeration;
        let normal = Vec3::new(-rise.x, 1.0, -rise.y).normalize();
        // Level ground keeps its colour.
        let light = normal.dot(LIGHT).max(0.0) / LIGHT.y;
        let shade = 0.3 + 0.7 * light;
        let height_m = map.heights_m()[row * map.columns() + column];
        let colour = self.colour(height_m);
        Rgb(colour.map(|channel| (channel * shade).round().clamp(0.0, 255.0) as u8))
    }

    fn colour(&self, height_m: f32) -> [f32; 3] {
        let share = (height_m - self.lowest_m) / (self.highest_m - self.lowest_m).max(f32::MIN_POSITIVE);
        let place = share.clamp(0.0, 1.0) * (COLOURS.len() - 1) as f32;
        let below = (place as usize).min(COLOURS.len() - 2);
        let part = place - below as f32;
        std::array::from_fn(|channel| {
            let (low, high) = (COLOURS[below][channel], COLOURS[below + 1][channel]);
            low + part * (high - low)
        })
    }
}

/// Columns and rows of all samples, row by row.
fn places(map: &ElevationGrid) -> impl Iterator<Item = (usize, usize)> {
    let columns = map.columns();
    (0..columns * map.rows()).map(move |index| (index % columns, index / columns))
}

/// Rise along x and z, m per m, between the neighbours.
fn gradient(map: &ElevationGrid, column: usize, row: usize) -> DVec2 {
    let height_m = |column: usize, row: usize| f64::from(map.heights_m()[row * map.columns() + column]);
    let (west, east) = (column.saturating_sub(1), (column + 1).min(map.columns() - 1));
    let (north, south) = (row.saturating_sub(1), (row + 1).min(map.rows() - 1));
    let rise_m =
        DVec2::new(height_m(east, row) - height_m(west, row), height_m(column, south) - height_m(column, north));
    rise_m / (map.cell_m() * DVec2::new((east - west) as f64, (south - north) as f64))
}

/// Width and height of a map's picture.
fn pixels_of(map: &ElevationGrid) -> (u32, u32) {
    let size_m = map.cell_m() * DVec2::new(map.columns() as f64, map.rows() as f64);
    let longest = (map.columns().max(map.rows()) as f64).clamp(LEAST_PIXELS, MOST_SAMPLES as f64);
    let pixels = (size_m * (longest / size_m.max_element())).round().max(DVec2::ONE);
    (pixels.x as u32, pixels.y as u32)
}
