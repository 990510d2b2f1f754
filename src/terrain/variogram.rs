//! The variogram of a map of elevations: half the mean square of the difference of two places, by their distance.
//!
//! ```text
//! gamma(h) = 1/2 mean of (z(x + h) - z(x))^2 = C(0) - C(h)
//! ```
//!
//! It is estimated without bias from any window, unlike the covariance, which needs the mean of ground that the window
//! does not show. All pairs of samples up to the longest lag are counted: the sum of products comes from one FFT (see
//! `autocorrelation`), the sums of squares from a table of running sums (`lag_pairs`). Pairs with a cell without data are left out.

use super::{
    drift::{Drift, FoundDrift, remove_drift},
    elevation_grid::ElevationGrid,
    error::TerrainError,
    lag_pairs::LagPairs,
};
use crate::setting::require;
use bevy::{math::DVec2, reflect::Reflect};
use serde::{Deserialize, Serialize};
use std::{f64::consts::PI, ops::RangeInclusive};

/// 4096 x 4096.
const MOST_SAMPLES: u64 = 1 << 24;
const LONGEST_LAG: RangeInclusive<f64> = 0.01..=0.5;
const SECTORS: RangeInclusive<u32> = 1..=36;
/// Width of a class of distances, in distances, where that is more than a cell: 12 classes to an octave.
const CLASS_WIDTH: f64 = 0.06;

/// How a variogram is estimated.
#[derive(Clone, Copy, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct VariogramSettings {
    /// What is taken away first.
    pub drift: Drift,
    /// Longest lag over the map's shorter side. Longer ones rest on few pairs. domain: \[0.01, 0.5\].
    pub longest_lag: f64,
    /// Classes of direction in the half circle; 1 for ground that is the same in all. domain: \[1, 36\].
    pub sectors: u32,
}

/// A variogram, class by class.
#[derive(Clone, Debug, PartialEq)]
pub struct Variogram {
    classes: Vec<LagClass>,
    variance_m2: f64,
    drift: FoundDrift,
}

/// The pairs of about the same lag.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LagClass {
    /// Mean distance, m.
    pub distance_m: f64,
    /// Middle of the class of directions, from +x (east) towards +z (south), radians, 0 to pi.
    pub azimuth: f64,
    /// gamma, half the mean square of the differences, m^2.
    pub semivariance_m2: f64,
    /// Pairs counted.
    pub pairs: f64,
}

impl Default for VariogramSettings {
    fn default() -> Self {
        Self { drift: Drift::Mean, longest_lag: 1.0 / 3.0, sectors: 1 }
    }
}

impl LagClass {
    /// The mean lag of the class, m.
    pub fn lag_m(&self) -> DVec2 {
        self.distance_m * DVec2::from_angle(self.azimuth)
    }
}

impl Variogram {
    /// The variogram of a map.
    ///
    /// Takes some 0.1 s for 1024 x 1024 samples; 2 s and 0.5 GB for 4096 x 4096.
    ///
    /// # Errors
    /// [`TerrainError::Setting`] for a setting outside its domain or a map of more than 2^24 samples,
    /// [`TerrainError::Level`] where nothing is left when the drift is taken away.
    pub fn estimate(grid: &ElevationGrid, settings: &VariogramSettings) -> Result<Self, TerrainError> {
        require("longest_lag", settings.longest_lag, LONGEST_LAG)?;
        require("sectors", settings.sectors, SECTORS)?;
        require("columns x rows", grid.heights_m().len() as u64, 0..=MOST_SAMPLES)?;
        let (drift, values) = remove_drift(grid, settings.drift);
        let measured = (values.len() - grid.gaps()) as f64;
        let variance_m2 = values.iter().map(|value| value * value).sum::<f64>() / measured;
        // What single precision leaves of a plane.
        let rounding_m = 1e-6 * grid.heights_m().iter().fold(0.0f32, |most, height| most.max(height.abs()));
        if variance_m2.sqrt() <= f64::from(rounding_m) {
            return Err(TerrainError::Level);
        }
        let (cell_m, longest_m) = (grid.cell_m(), longest_m(grid, settings.longest_lag));
        let longest = [(longest_m / cell_m.x) as usize, (longest_m / cell_m.y) as usize];
        let pairs = LagPairs::new(&values, grid, longest);
        Ok(Self { classes: classes(&pairs, cell_m, longest_m, settings.sectors), variance_m2, drift })
    }

    /// The classes, by direction, then by distance.
    pub fn classes(&self) -> &[LagClass] {
        &self.classes
    }

    /// Variance of the map about its drift, m^2: less than the sill where the map is not large against the range.
    pub fn variance_m2(&self) -> f64 {
        self.variance_m2
    }

    /// What was taken away.
    pub fn drift(&self) -> &FoundDrift {
        &self.drift
    }

    /// Variance minus semivariance of a class, m^2: the covariance, as the map's own mean gives it.
    pub fn covariance_m2(&self, class: &LagClass) -> f64 {
        self.variance_m2 - class.semivariance_m2
    }
}

/// The longest lag, m: a share of the shorter side, but one cell at least, however small the map.
fn longest_m(grid: &ElevationGrid, longest_lag: f64) -> f64 {
    let cell_m = grid.cell_m();
    let sides_m = cell_m * DVec2::new(grid.columns() as f64 - 1.0, grid.rows() as f64 - 1.0);
    (longest_lag * sides_m.min_element()).max(cell_m.max_element() * 1.001)
}

/// The classes of all pairs of a map.
fn classes(pairs: &LagPairs, cell_m: DVec2, longest_m: f64, sectors: u32) -> Vec<LagClass> {
    let edges_m = class_edges_m(cell_m.min_element(), longest_m);
    let sector_width = PI / f64::from(sectors);
    let mut sums = vec![LagClass::default(); sectors as usize * edges_m.len()];
    let [longest_column, longest_row] = pairs.longest();
    let longest_column = longest_column as isize;
    for row in 0..=longest_row {
        for column in if row == 0 { 1 } else { -longest_column }..=longest_column {
            let lag_m = cell_m * DVec2::new(column as f64, row as f64);
            let distance_m = lag_m.length();
            if distance_m > longest_m {
                continue;
            }
            let class = edges_m.partition_point(|&edge_m| edge_m <= distance_m);
            // Sectors lie about their middle: the first about +x.
            let sector = (lag_m.to_angle() / sector_width).round() as usize % sectors as usize;
            let (half_squares, count) = pairs.at(column, row);
            let sum = &mut sums[sector * edges_m.len() + class];
            sum.semivariance_m2 += half_squares;
            sum.distance_m += count * distance_m;
            sum.pairs += count;
            sum.azimuth = sector as f64 * sector_width;
        }
    }
    let mean = |sum: LagClass| LagClass {
        distance_m: sum.distance_m / sum.pairs,
        semivariance_m2: sum.semivariance_m2 / sum.pairs,
        ..sum
    };
    sums.into_iter().filter(|sum| sum.pairs > 0.0).map(mean).collect()
}

/// Upper ends of the classes of distance, the last beyond the longest lag.
fn class_edges_m(cell_m: f64, longest_m: f64) -> Vec<f64> {
    let next = |&edge_m: &f64| (edge_m <= longest_m).then(|| edge_m + (CLASS_WIDTH * edge_m).max(cell_m));
    std::iter::successors(Some(0.5 * cell_m), next).collect()
}

#[cfg(test)]
mod tests;
