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

/// The drift of `grid`, and the elevations without it, m: 0 in its gaps.
pub(super) fn remove_drift(grid: &ElevationGrid, drift: Drift) -> (FoundDrift, Vec<f64>) {
    let measured = grid.measured_m().map(f64::from);
    let mean_m = measured.sum::<f64>() / (grid.heights_m().len() - grid.gaps()) as f64;
    let (centre, gradient) = match drift {
        Drift::Mean => (DVec2::ZERO, DVec2::ZERO),
        Drift::Plane => plane(grid, mean_m),
    };
    let residual = |(index, (place, height_m)): (usize, (DVec2, f64))| {
        if grid.is_measured(index) { height_m - mean_m - gradient.dot(place - centre) } else { 0.0 }
    };
    (FoundDrift { mean_m, gradient }, places(grid).enumerate().map(residual).collect())
}

/// The mean place of what was measured, and the least-squares gradient there: the solution of the two normal equations.
fn plane(grid: &ElevationGrid, mean_m: f64) -> (DVec2, DVec2) {
    let measured = || places(grid).enumerate().filter(|(index, _)| grid.is_measured(*index)).map(|(_, sample)| sample);
    let centre = measured().map(|(place, _)| place).sum::<DVec2>() / (grid.heights_m().len() - grid.gaps()) as f64;
    let (mut products, mut squares, mut mixed) = (DVec2::ZERO, DVec2::ZERO, 0.0);
    for (place, height_m) in measured() {
        let place = place - centre;
        products += place * (height_m - mean_m);
        squares += place * place;
        mixed += place.x * place.y;
    }
    let determinant = squares.x * squares.y - mixed * mixed;
    // All that was measured lies on one line: a plane through it is not determined.
    if determinant <= 1e-12 * squares.x * squares.y {
        return (centre, DVec2::ZERO);
    }
    let gradient = DVec2::new(squares.y * products.x - mixed * products.y, squares.x * products.y - mixed * products.x)
        / determinant;
    (centre, gradient)
}

/// The places of all samples about the middle of the map, m, with their elevations.
fn places(grid: &ElevationGrid) -> impl Iterator<Item = (DVec2, f64)> {
    let middle = DVec2::new(grid.columns() as f64 - 1.0, grid.rows() as f64 - 1.0) / 2.0;
    grid.heights_m().iter().enumerate().map(move |(index, &height_m)| {
        let sample = DVec2::new((index % grid.columns()) as f64, (index / grid.columns()) as f64);
        ((sample - middle) * grid.cell_m(), f64::from(height_m))
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

    #[test]
    fn a_plane_with_a_gap_is_removed_whole() {
        let is_gap = |index: u32| index % 6 > 3 && index / 6 < 3;
        let height = |index: u32| 7.0 + 0.5 * f64::from(index % 6) - 0.25 * f64::from(index / 6);
        let heights_m = (0..30).map(|index| if is_gap(index) { f32::NAN } else { height(index) as f32 }).collect();
        let grid = ElevationGrid::with_gaps(6, 5, DVec2::new(2.0, 4.0), heights_m).unwrap();
        let (found, rest) = remove_drift(&grid, Drift::Plane);
        assert_relative_eq!(found.gradient.x, 0.25, epsilon = 1e-12);
        assert_relative_eq!(found.gradient.y, -0.0625, epsilon = 1e-12);
        assert!(rest.iter().all(|value| value.abs() < 1e-12));
        let measured: Vec<f64> = (0..30).filter(|&index| !is_gap(index)).map(height).collect();
        assert_relative_eq!(found.mean_m, measured.iter().sum::<f64>() / measured.len() as f64, epsilon = 1e-12);
    }
}
