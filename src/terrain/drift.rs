//! The drift of a map: what is not random about it, and is taken away before its covariance is estimated.

use super::elevation_grid::ElevationGrid;
use bevy::{math::DVec2, reflect::Reflect};
use serde::{Deserialize, Serialize};

/// What is taken away from a map.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Reflect, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Drift {
    /// The mean elevation.
    #[default]
    Mean,
    /// The plane that fits best (least squares): for a map on the flank of something larger than itself.
    Plane,
}

/// The drift found in a map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FoundDrift {
    /// Mean elevation, m.
    pub mean_m: f64,
    /// Rise along x and z, m per m; 0 for [`Drift::Mean`].
    pub gradient: DVec2,
}

/// The drift of `grid`, and the elevations without it, m.
pub(super) fn remove_drift(grid: &ElevationGrid, drift: Drift) -> (FoundDrift, Vec<f64>) {
    let mean_m = grid.heights_m().iter().map(|&height| f64::from(height)).sum::<f64>() / grid.heights_m().len() as f64;
    let gradient = match drift {
        Drift::Mean => DVec2::ZERO,
        Drift::Plane => plane_gradient(grid, mean_m),
    };
    let residual = |(place, height_m)| height_m - mean_m - gradient.dot(place);
    (FoundDrift { mean_m, gradient }, places(grid).map(residual).collect())
}

/// The least-squares gradient. On a regular grid x and z are orthogonal about its centre, so that each has its own
/// regression.
fn plane_gradient(grid: &ElevationGrid, mean_m: f64) -> DVec2 {
    let (products, squares) = places(grid)
        .fold((DVec2::ZERO, DVec2::ZERO), |(products, squares), (place, height_m)| {
            (products + place * (height_m - mean_m), squares + place * place)
        });
    products / squares
}

/// The places of all samples about the centre, m, with their elevations.
fn places(grid: &ElevationGrid) -> impl Iterator<Item = (DVec2, f64)> {
    let centre = DVec2::new(grid.columns() as f64 - 1.0, grid.rows() as f64 - 1.0) / 2.0;
    grid.heights_m().iter().enumerate().map(move |(index, &height_m)| {
        let sample = DVec2::new((index % grid.columns()) as f64, (index / grid.columns()) as f64);
        ((sample - centre) * grid.cell_m(), f64::from(height_m))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn a_plane_is_removed_whole() {
        let height = |index: u32| 7.0 + 0.5 * f64::from(index % 6) - 0.25 * f64::from(index / 6);
        let heights_m = (0..30).map(|index| height(index) as f32).collect();
        let grid = ElevationGrid::new(6, 5, DVec2::new(2.0, 4.0), heights_m).unwrap();
        let (found, rest) = remove_drift(&grid, Drift::Plane);
        assert_relative_eq!(found.gradient.x, 0.25, epsilon = 1e-12);
        assert_relative_eq!(found.gradient.y, -0.0625, epsilon = 1e-12);
        assert!(rest.iter().all(|value| value.abs() < 1e-12));

        let (found, rest) = remove_drift(&grid, Drift::Mean);
        assert_eq!(found.gradient, DVec2::ZERO);
        assert_relative_eq!(rest.iter().sum::<f64>(), 0.0, epsilon = 1e-9);
        assert_relative_eq!(rest[0], height(0) - found.mean_m, epsilon = 1e-12);
    }
}
