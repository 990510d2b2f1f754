//! Ground formed by hand: surface patches of second-degree B-splines with the user's control points (Zaharia, section
//! 2.4).
//!
//! ```text
//! h(x, z) = sum_ij c_ij B((x - x_i) / cell_x) B((z - z_j) / cell_z)
//! B(u) = 3/4 - u^2 for |u| <= 1/2,   (3/2 - |u|)^2 / 2 for 1/2 <= |u| <= 3/2,   0 beyond
//! ```
//!
//! All patches take their control points from one lattice, and what no patch covers has the base's elevation. So the
//! surface is one spline, whatever the patches: it and its gradient are continuous everywhere, also where patches meet
//! and where they end; the second derivatives are constant between the lines halfway between control points, and jump
//! there. A control point draws the surface towards itself, which reaches it only where its neighbours agree with it.
//!
//! Zaharia enters 50 points for 5 adjacent patches; here they are as many as wanted.
//! `assets/terrain/five_patches.ground.ron` has as many as he.

use super::{error::TerrainError, place::finite};
use crate::{ground::Ground, ron_text::from_ron, setting::require};
use bevy::{math::DVec2, reflect::Reflect};
use serde::{Deserialize, Serialize};
use std::ops::RangeInclusive;

const CELL_M: RangeInclusive<f64> = 1e-2..=1e6;
const PLACE_M: RangeInclusive<f64> = -1e9..=1e9;
const HEIGHT_M: RangeInclusive<f32> = -1e5..=1e5;
const FIRST: RangeInclusive<i32> = -1_000_000..=1_000_000;
const SIDE: RangeInclusive<u32> = 1..=4096;
/// 4 bytes each: 16 MiB.
const MOST_POINTS: u64 = 1 << 22;

/// A surface of patches.
#[derive(Clone, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SplineGroundSettings {
    /// Distance of control points along x. units: m, domain: \[0.01, 10^6\].
    pub cell_x_m: f64,
    /// Distance of control points along z. units: m, domain: \[0.01, 10^6\].
    pub cell_z_m: f64,
    /// x of the lattice's column 0. units: m, domain: \[-10^9, 10^9\].
    pub west_m: f64,
    /// z of the lattice's row 0. units: m, domain: \[-10^9, 10^9\].
    pub north_m: f64,
    /// Elevation of the control points outside all patches. units: m, domain: \[-10^5, 10^5\].
    pub base_m: f32,
    /// The patches. Where they overlap, the later one's points hold. The rectangle around all of them holds at most
    /// 2^22 points.
    pub patches: Vec<SplinePatch>,
}

/// A rectangle of control points.
#[derive(Clone, Debug, Default, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SplinePatch {
    /// Column of its first point in the lattice. domain: \[-10^6, 10^6\].
    pub first_column: i32,
    /// Row of its first point in the lattice. domain: \[-10^6, 10^6\].
    pub first_row: i32,
    /// Points along x. domain: \[1, 4096\].
    pub columns: u32,
    /// Points along z. domain: \[1, 4096\].
    pub rows: u32,
    /// Elevations of the points, row by row. units: m, domain: \[-10^5, 10^5\].
    pub heights_m: Vec<f32>,
}

/// Ground formed by control points.
#[derive(Clone, Debug, PartialEq)]
pub struct SplineGround {
    settings: SplineGroundSettings,
    first_column: i64,
    first_row: i64,
    columns: usize,
    rows: usize,
    /// The control points of the rectangle around all patches, row by row, over the base, m.
    points_m: Vec<f32>,
}

impl Default for SplineGroundSettings {
    fn default() -> Self {
        Self { cell_x_m: 50.0, cell_z_m: 50.0, west_m: 0.0, north_m: 0.0, base_m: 0.0, patches: Vec::new() }
    }
}

impl SplineGroundSettings {
    /// Reads and checks settings that are written in RON.
    ///
    /// # Errors
    /// [`TerrainError::Syntax`] with line and column where `text` is no RON of a surface, and those of
    /// [`validate`](Self::validate).
    pub fn from_ron(text: &str) -> Result<Self, TerrainError> {
        let settings: Self = from_ron(text)?;
        settings.validate()?;
        Ok(settings)
    }

    /// Checks every setting.
    ///
    /// # Errors
    /// [`TerrainError::Setting`] or [`TerrainError::Count`] for the first that is wrong.
    pub fn validate(&self) -> Result<(), TerrainError> {
        require("cell_x_m", self.cell_x_m, CELL_M)?;
        require("cell_z_m", self.cell_z_m, CELL_M)?;
        require("west_m", self.west_m, PLACE_M)?;
        require("north_m", self.north_m, PLACE_M)?;
        require("base_m", self.base_m, HEIGHT_M)?;
        for (index, patch) in self.patches.iter().enumerate() {
            patch.validate().map_err(|error| error.inside(&format!("patches[{index}]")))?;
        }
        let [columns, rows] = self.bounds().map(|bounds| (bounds.end - bounds.start) as u64);
        Ok(require("patches: points of the rectangle around all", columns * rows, 0..=MOST_POINTS)?)
    }

    /// The columns and rows of the rectangle around all patches.
    fn bounds(&self) -> [std::ops::Range<i64>; 2] {
        let around = |range: fn(&SplinePatch) -> (i32, u32)| {
            let ranges = || self.patches.iter().map(range);
            let start = ranges().map(|(first, _)| i64::from(first)).min().unwrap_or(0);
            let end = ranges().map(|(first, count)| i64::from(first) + i64::from(count)).max().unwrap_or(0);
            start..end
        };
        [around(|patch| (patch.first_column, patch.columns)), around(|patch| (patch.first_row, patch.rows))]
    }
}

impl SplinePatch {
    fn validate(&self) -> Result<(), TerrainError> {
        require("first_column", self.first_column, FIRST)?;
        require("first_row", self.first_row, FIRST)?;
        require("columns", self.columns, SIDE)?;
        require("rows", self.rows, SIDE)?;
        let expected = u64::from(self.columns) * u64::from(self.rows);
        if self.heights_m.len() as u64 != expected {
            let (field, found) = ("heights_m".to_owned(), self.heights_m.len());
            return Err(TerrainError::Count { field, found, columns: self.columns, rows: self.rows, expected });
        }
        let height = |(index, &height_m)| require(&format!("heights_m[{index}]"), height_m, HEIGHT_M);
        Ok(self.heights_m.iter().enumerate().try_for_each(height)?)
    }
}

impl SplineGround {
    /// The surface that `settings` describe.
    ///
    /// # Errors
    /// As [`SplineGroundSettings::validate`].
    pub fn new(settings: &SplineGroundSettings) -> Result<Self, TerrainError> {
        settings.validate()?;
        let bounds = settings.bounds();
        let [columns, rows] = [0, 1].map(|axis| (bounds[axis].end - bounds[axis].start) as usize);
        let [first_column, first_row] = [bounds[0].start, bounds[1].start];
        let mut points_m = vec![0.0; columns * rows];
        for patch in &settings.patches {
            let column = (i64::from(patch.first_column) - first_column) as usize;
            let row = (i64::from(patch.first_row) - first_row) as usize;
            for (index, heights_m) in patch.heights_m.chunks_exact(patch.columns as usize).enumerate() {
                let first = (row + index) * columns + column;
                for (point_m, height_m) in points_m[first..].iter_mut().zip(heights_m) {
                    *point_m = height_m - settings.base_m;
                }
            }
        }
        Ok(Self { settings: settings.clone(), first_column, first_row, columns, rows, points_m })
    }

    /// What the surface was made from.
    pub fn settings(&self) -> &SplineGroundSettings {
        &self.settings
    }

    /// The positions of a place on both axes, counted from the rectangle's first point.
    fn positions(&self, place: DVec2) -> (Position, Position) {
        let place = finite(place);
        let x = (place.x - self.settings.west_m) / self.settings.cell_x_m - self.first_column as f64;
        let z = (place.y - self.settings.north_m) / self.settings.cell_z_m - self.first_row as f64;
        (Position::new(x), Position::new(z))
    }

    /// The sum over the 3 x 3 control points about a place, each with the product of its weights.
    fn weighted_m(&self, (x, along_x): (&Position, [f64; 3]), (z, along_z): (&Position, [f64; 3])) -> f64 {
        let mut sum = 0.0;
        for (row, weight_z) in (z.nearest - 1..).zip(along_z) {
            for (column, weight_x) in (x.nearest - 1..).zip(along_x) {
                sum += weight_x * weight_z * self.point_m(column, row);
            }
        }
        sum
    }

    /// A control point over the base, m.
    fn point_m(&self, column: i64, row: i64) -> f64 {
        let inside = (0..self.columns as i64).contains(&column) && (0..self.rows as i64).contains(&row);
        if inside { f64::from(self.points_m[row as usize * self.columns + column as usize]) } else { 0.0 }
    }
}

impl Ground for SplineGround {
    fn height_m(&self, place: DVec2) -> f64 {
        let (x, z) = self.positions(place);
        f64::from(self.settings.base_m) + self.weighted_m((&x, x.weights()), (&z, z.weights()))
    }

    fn gradient(&self, place: DVec2) -> DVec2 {
        let (x, z) = self.positions(place);
        let along_x = self.weighted_m((&x, x.slopes()), (&z, z.weights()));
        let along_z = self.weighted_m((&x, x.weights()), (&z, z.slopes()));
        DVec2::new(along_x / self.settings.cell_x_m, along_z / self.settings.cell_z_m)
    }
}

/// A place on one axis: nearest to control point `nearest`, `offset` cells from it, -1/2 to 1/2.
struct Position {
    nearest: i64,
    offset: f64,
}

impl Position {
    fn new(coordinate: f64) -> Self {
        let nearest = coordinate.round();
        Self { nearest: nearest as i64, offset: coordinate - nearest }
    }

    /// B at the point before, the nearest, and the one after.
    fn weights(&self) -> [f64; 3] {
        let u = self.offset;
        [0.5 * (0.5 - u).powi(2), 0.75 - u * u, 0.5 * (0.5 + u).powi(2)]
    }

    /// Their derivatives.
    fn slopes(&self) -> [f64; 3] {
        let u = self.offset;
        [u - 0.5, -2.0 * u, u + 0.5]
    }
}

#[cfg(test)]
mod tests;
