//! Elevations on a regular grid: what maps are read from, and what variograms are estimated from.

use super::{error::TerrainError, gaps::fill};
use crate::{
    ground::Ground,
    setting::{SettingError, require},
};
use bevy::math::DVec2;
use std::ops::RangeInclusive;

/// Two are the least between which anything can be interpolated.
const SIDE: RangeInclusive<u32> = 2..=16_384;
/// 4 bytes each: 256 MiB.
const MOST_SAMPLES: u64 = 1 << 26;
/// A millimetre to a degree of longitude.
const CELL_M: RangeInclusive<f64> = 1e-3..=1.2e5;

/// Elevations at the corners of equal cells, row by row; the first row is the northernmost, its first sample the
/// westernmost.
#[derive(Clone, Debug, PartialEq)]
pub struct ElevationGrid {
    columns: usize,
    rows: usize,
    cell_m: DVec2,
    heights_m: Vec<f32>,
    /// Whether each height was measured; empty where all were.
    is_measured: Vec<bool>,
}

impl ElevationGrid {
    /// The grid of `columns` x `rows` elevations, with neighbours `cell_m` apart along x (east) and z (south).
    ///
    /// # Errors
    /// [`TerrainError::Setting`] for a side outside 2 to 16384, more than 2^26 samples, or a cell outside 0.001 m to
    /// 120 km; [`TerrainError::Count`] where there is not one height for each place;
    /// [`TerrainError::NotFinite`] for the first height that is no finite number.
    pub fn new(columns: u32, rows: u32, cell_m: DVec2, heights_m: Vec<f32>) -> Result<Self, TerrainError> {
        require_size(columns, rows)?;
        require("cell_x_m", cell_m.x, CELL_M)?;
        require("cell_z_m", cell_m.y, CELL_M)?;
        let expected = u64::from(columns) * u64::from(rows);
        if heights_m.len() as u64 != expected {
            let (field, found) = ("heights_m".to_owned(), heights_m.len());
            return Err(TerrainError::Count { field, found, columns, rows, expected });
        }
        let (columns, rows) = (columns as usize, rows as usize);
        if let Some((index, &value)) = heights_m.iter().enumerate().find(|(_, height)| !height.is_finite()) {
            return Err(TerrainError::NotFinite { column: index % columns, row: index / columns, value });
        }
        Ok(Self { columns, rows, cell_m, heights_m, is_measured: Vec::new() })
    }

    /// As [`new`](Self::new), with gaps where heights are NaN: cells without data. They are filled smoothly from their edges, for drawing
    /// (the solution of Laplace's equation, as a membrane hangs), and left out of drifts and variograms.
    ///
    /// # Errors
    /// As [`new`](Self::new); infinite heights are refused, and [`TerrainError::NoData`] where all heights are NaN.
    pub fn with_gaps(columns: u32, rows: u32, cell_m: DVec2, mut heights_m: Vec<f32>) -> Result<Self, TerrainError> {
        let mut is_measured: Vec<bool> = heights_m.iter().map(|height| !height.is_nan()).collect();
        if !is_measured.is_empty() && !is_measured.contains(&true) {
            return Err(TerrainError::NoData);
        }
        if is_measured.contains(&false) {
            require_size(columns, rows)?;
            fill(columns as usize, &mut heights_m);
        } else {
            is_measured.clear();
        }
        Ok(Self { is_measured, ..Self::new(columns, rows, cell_m, heights_m)? })
    }

    /// The elevations of `ground` at the corners of `columns` x `rows` places, of which `first` is the north-western.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn sample(
        ground: &dyn Ground,
        first: DVec2,
        columns: u32,
        rows: u32,
        cell_m: DVec2,
    ) -> Result<Self, TerrainError> {
        require_size(columns, rows)?;
        let place = |index: u64| {
            let (column, row) = (index % u64::from(columns), index / u64::from(columns));
            first + cell_m * DVec2::new(column as f64, row as f64)
        };
        let samples = u64::from(columns) * u64::from(rows);
        let heights_m = (0..samples).map(|index| ground.height_m(place(index)) as f32).collect();
        Self::new(columns, rows, cell_m, heights_m)
    }

    /// Samples from west to east.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// Samples from north to south.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Distance of neighbours along x and z, m.
    pub fn cell_m(&self) -> DVec2 {
        self.cell_m
    }

    /// The elevations, row by row, m.
    pub fn heights_m(&self) -> &[f32] {
        &self.heights_m
    }

    /// Number of cells without data, whose elevations are filled.
    pub fn gaps(&self) -> usize {
        self.is_measured.iter().filter(|is_measured| !**is_measured).count()
    }

    /// The elevations that were measured, row by row, m: without those of gaps.
    pub fn measured_m(&self) -> impl Iterator<Item = f32> {
        self.heights_m.iter().enumerate().filter(|(index, _)| self.is_measured(*index)).map(|(_, &height_m)| height_m)
    }

    /// Whether a height, by its place in [`heights_m`](Self::heights_m), was measured.
    pub(super) fn is_measured(&self, index: usize) -> bool {
        self.is_measured.get(index).copied().unwrap_or(true)
    }

    /// The elevation at a sample, m; beyond the edge, that of the nearest.
    pub(super) fn nearest_m(&self, column: i64, row: i64) -> f32 {
        let column = column.clamp(0, self.columns as i64 - 1) as usize;
        let row = row.clamp(0, self.rows as i64 - 1) as usize;
        self.heights_m[row * self.columns + column]
    }
}

/// Refuses a grid that is empty or too large to hold.
pub(super) fn require_size(columns: u32, rows: u32) -> Result<(), SettingError> {
    require("columns", columns, SIDE)?;
    require("rows", rows, SIDE)?;
    require("columns x rows", u64::from(columns) * u64::from(rows), 0..=MOST_SAMPLES)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn invalid_grids_are_refused_by_name() {
        let error = |columns, rows, cell_m, heights: &[f32]| {
            ElevationGrid::new(columns, rows, cell_m, heights.to_vec()).unwrap_err().to_string()
        };
        assert_eq!(error(0, 5, DVec2::ONE, &[]), "`columns` is 0, but must be 2 to 16384");
        assert_eq!(error(2, 2, DVec2::ONE, &[1.0]), "`heights_m` holds 1, but 2 x 2 need 4");
        assert_eq!(error(2, 2, DVec2::new(1.0, 0.0), &[1.0; 4]), "`cell_z_m` is 0, but must be 0.001 to 120000");
        assert_eq!(
            error(2, 2, DVec2::ONE, &[0.0, 0.0, f32::NAN, 0.0]),
            "the elevation at column 0, row 1 is NaN, but must be a finite number"
        );
        assert!(error(16_384, 16_384, DVec2::ONE, &[]).starts_with("`columns x rows` is 268435456"));
    }

    #[test]
    fn gaps_are_filled_and_known() {
        let heights_m = vec![1.0, 2.0, 3.0, 4.0, f32::NAN, 6.0, 7.0, 8.0, 9.0];
        let grid = ElevationGrid::with_gaps(3, 3, DVec2::ONE, heights_m).unwrap();
        assert_eq!((grid.gaps(), grid.heights_m()[4]), (1, 5.0));
        assert_eq!(grid.measured_m().collect::<Vec<_>>(), [1.0, 2.0, 3.0, 4.0, 6.0, 7.0, 8.0, 9.0]);
        let whole = ElevationGrid::with_gaps(2, 2, DVec2::ONE, vec![0.0; 4]).unwrap();
        assert_eq!(whole, ElevationGrid::new(2, 2, DVec2::ONE, vec![0.0; 4]).unwrap());
        let error =
            |heights: &[f32]| ElevationGrid::with_gaps(2, 2, DVec2::ONE, heights.to_vec()).unwrap_err().to_string();
        assert_eq!(error(&[f32::NAN; 4]), "no cell has an elevation");
        assert!(error(&[f32::NAN, 0.0, f32::INFINITY, 0.0]).contains("is inf"));
        assert_eq!(error(&[f32::NAN, 0.0, 1.0]), "`heights_m` holds 3, but 2 x 2 need 4");
        assert!(error(&[]).contains("holds 0"));
    }
}
