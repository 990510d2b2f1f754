//! Ground from a map of elevations, interpolated with normals that are continuous everywhere.
//!
//! ```text
//! bicubic   Catmull-Rom along x and z: through every sample, with the slope (h[i+1] - h[i-1]) / 2 there
//! bilinear  heights by bilinear interpolation; gradients by bilinear interpolation of those same slopes
//! ```
//!
//! Beyond the edge the outermost samples go on for ever, so that the ground runs out level within one cell, without a
//! kink.

use super::{elevation_grid::ElevationGrid, place::finite};
use crate::{
    ground::Ground,
    interpolation::catmull_rom,
    setting::{SettingError, require},
};
use bevy::{
    asset::Asset,
    math::DVec2,
    reflect::{Reflect, TypePath},
};
use serde::{Deserialize, Serialize};
use std::{ops::RangeInclusive, sync::Arc};

const PLACE_M: RangeInclusive<f64> = -1e9..=1e9;

/// How a map lies in the world.
#[derive(Clone, Copy, Debug, Default, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct MapPlacement {
    /// x of the westernmost samples. units: m, domain: \[-10^9, 10^9\].
    pub west_m: f64,
    /// z of the northernmost samples. units: m, domain: \[-10^9, 10^9\].
    pub north_m: f64,
    /// What the ground is between samples.
    pub interpolation: Interpolation,
}

/// What the ground is between the samples of a map.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Reflect, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Interpolation {
    /// Smooth. May pass the samples' extremes by an eighth of their differences.
    #[default]
    Bicubic,
    /// Never beyond the samples; the surface has edges, which its normals do not show.
    Bilinear,
}

/// Ground read from a map; an asset, too ([`ElevationLoader`](super::ElevationLoader)). Clones share their samples.
#[derive(Asset, TypePath, Clone, Debug, PartialEq)]
pub struct ElevationMap {
    grid: Arc<ElevationGrid>,
    placement: MapPlacement,
}

impl ElevationMap {
    /// The ground of `grid`, which lies in the world as `placement` says.
    ///
    /// # Errors
    /// [`SettingError`] for a place outside its domain.
    pub fn new(grid: ElevationGrid, placement: MapPlacement) -> Result<Self, SettingError> {
        require("west_m", placement.west_m, PLACE_M)?;
        require("north_m", placement.north_m, PLACE_M)?;
        Ok(Self { grid: Arc::new(grid), placement })
    }

    /// The samples.
    pub fn grid(&self) -> &ElevationGrid {
        &self.grid
    }

    /// Where it lies.
    pub fn placement(&self) -> &MapPlacement {
        &self.placement
    }

    /// The axes' positions of a place.
    fn positions(&self, place: DVec2) -> (Position, Position) {
        let first = DVec2::new(self.placement.west_m, self.placement.north_m);
        let coordinates = (finite(place) - first) / self.grid.cell_m();
        (Position::new(coordinates.x), Position::new(coordinates.y))
    }

    /// The sum over the 4 x 4 samples about a place, each with the product of its weights.
    fn weighted_m(&self, (x, along_x): (&Position, [f64; 4]), (z, along_z): (&Position, [f64; 4])) -> f64 {
        let mut sum = 0.0;
        for (row, weight) in (z.cell - 1..).zip(along_z) {
            let of_column = |(column, weight)| weight * f64::from(self.grid.nearest_m(column, row));
            sum += weight * (x.cell - 1..).zip(along_x).map(of_column).sum::<f64>();
        }
        sum
    }
}

impl Ground for ElevationMap {
    fn height_m(&self, place: DVec2) -> f64 {
        let (x, z) = self.positions(place);
        match self.placement.interpolation {
            Interpolation::Bicubic => self.weighted_m((&x, x.cubic()), (&z, z.cubic())),
            Interpolation::Bilinear => self.weighted_m((&x, x.linear()), (&z, z.linear())),
        }
    }

    fn gradient(&self, place: DVec2) -> DVec2 {
        let (x, z) = self.positions(place);
        let per_cell = match self.placement.interpolation {
            Interpolation::Bicubic => DVec2::new(
                self.weighted_m((&x, x.cubic_slope()), (&z, z.cubic())),
                self.weighted_m((&x, x.cubic()), (&z, z.cubic_slope())),
            ),
            Interpolation::Bilinear => DVec2::new(
                self.weighted_m((&x, x.linear_slope()), (&z, z.linear())),
                self.weighted_m((&x, x.linear()), (&z, z.linear_slope())),
            ),
        };
        per_cell / self.grid.cell_m()
    }
}

/// A place on one axis: in the cell after sample `cell`, the share `t` of it along. Weights are those of the samples
/// `cell` - 1 to `cell` + 2.
struct Position {
    cell: i64,
    t: f64,
}

impl Position {
    fn new(coordinate: f64) -> Self {
        let floor = coordinate.floor();
        Self { cell: floor as i64, t: coordinate - floor }
    }

    fn linear(&self) -> [f64; 4] {
        [0.0, 1.0 - self.t, self.t, 0.0]
    }

    /// The central differences at the samples, linear between.
    fn linear_slope(&self) -> [f64; 4] {
        let (s, t) = (1.0 - self.t, self.t);
        [-0.5 * s, -0.5 * t, 0.5 * s, 0.5 * t]
    }

    fn cubic(&self) -> [f64; 4] {
        catmull_rom(self.t)
    }

    /// Its derivative.
    fn cubic_slope(&self) -> [f64; 4] {
        let t = self.t;
        [
            0.5 * (t * (4.0 - 3.0 * t) - 1.0),
            0.5 * t * (9.0 * t - 10.0),
            0.5 * (1.0 + t * (8.0 - 9.0 * t)),
            0.5 * t * (3.0 * t - 2.0),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    const CELL_M: DVec2 = DVec2::new(3.0, 4.0);

    fn map(interpolation: Interpolation, height: impl Fn(f64, f64) -> f64) -> ElevationMap {
        let heights_m = (0..56).map(|index| height(f64::from(index % 8), f64::from(index / 8)) as f32).collect();
        let grid = ElevationGrid::new(8, 7, CELL_M, heights_m).unwrap();
        ElevationMap::new(grid, MapPlacement { west_m: 100.0, north_m: -50.0, interpolation }).unwrap()
    }

    fn place(column: f64, row: f64) -> DVec2 {
        DVec2::new(100.0, -50.0) + CELL_M * DVec2::new(column, row)
    }

    fn rugged(column: f64, row: f64) -> f64 {
        ((column * 2.3).sin() + (row * 1.7 + column).cos()) * 10.0
    }

    #[test]
    fn the_ground_passes_through_every_sample() {
        for interpolation in [Interpolation::Bicubic, Interpolation::Bilinear] {
            let map = map(interpolation, rugged);
            for (column, row) in [(0.0, 0.0), (3.0, 2.0), (7.0, 6.0), (0.0, 5.0)] {
                assert_relative_eq!(map.height_m(place(column, row)), rugged(column, row), epsilon = 1e-5);
            }
        }
    }

    #[test]
    fn a_plane_stays_a_plane_inside() {
        for interpolation in [Interpolation::Bicubic, Interpolation::Bilinear] {
            let map = map(interpolation, |column, row| 2.0 * column - row);
            for (column, row) in [(1.3, 1.1), (5.9, 4.8), (2.0, 3.5)] {
                assert_relative_eq!(map.height_m(place(column, row)), 2.0 * column - row, epsilon = 1e-5);
                assert_relative_eq!(map.gradient(place(column, row)).x, 2.0 / 3.0, epsilon = 1e-6);
                assert_relative_eq!(map.gradient(place(column, row)).y, -1.0 / 4.0, epsilon = 1e-6);
            }
        }
    }

    #[test]
    fn bicubic_gradients_are_those_of_the_heights() {
        let map = map(Interpolation::Bicubic, rugged);
        let step = 1e-4;
        for index in 0..300 {
            let place = place(f64::from(index) * 0.037 - 2.0, f64::from(index) * 0.029 - 1.0);
            let rise = |step: DVec2| (map.height_m(place + step) - map.height_m(place - step)) / 2e-4;
            // The curvature jumps at samples by some m^-1, so that a difference across one errs by about its step.
            assert_relative_eq!(map.gradient(place).x, rise(step * DVec2::X), epsilon = 1e-4);
            assert_relative_eq!(map.gradient(place).y, rise(step * DVec2::Y), epsilon = 1e-4);
        }
    }

    #[test]
    fn heights_and_normals_have_no_jump_at_samples_or_edges() {
        for interpolation in [Interpolation::Bicubic, Interpolation::Bilinear] {
            let map = map(interpolation, rugged);
            for line in -2..=9 {
                let (before, after) = (f64::from(line) - 1e-9, f64::from(line) + 1e-9);
                for across in [0.4, 2.7, 6.2, 8.0] {
                    for (a, b) in
                        [(place(before, across), place(after, across)), (place(across, before), place(across, after))]
                    {
                        assert_relative_eq!(map.height_m(a), map.height_m(b), epsilon = 1e-6);
                        assert!((map.gradient(a) - map.gradient(b)).length() < 1e-6, "{interpolation:?} at {a}");
                    }
                }
            }
        }
    }

    #[test]
    fn beyond_the_edge_the_ground_runs_out_level() {
        let map = map(Interpolation::Bicubic, rugged);
        for place in [place(-1.0, 2.0), place(40.0, 2.0), DVec2::splat(1e300), DVec2::splat(-1e300)] {
            assert!(map.height_m(place).is_finite());
            assert_relative_eq!(map.gradient(place).x, 0.0, epsilon = 1e-9);
        }
        assert_eq!(map.height_m(DVec2::NAN), map.height_m(DVec2::ZERO));
    }

    #[test]
    fn a_place_that_is_no_number_is_refused() {
        let grid = map(Interpolation::Bicubic, rugged).grid().clone();
        let placement = MapPlacement { west_m: f64::NAN, ..Default::default() };
        assert!(ElevationMap::new(grid, placement).unwrap_err().to_string().starts_with("`west_m` is NaN"));
    }
}
