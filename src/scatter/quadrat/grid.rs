//! A rectangle of ground divided into equal quadrats.

use bevy::math::DVec2;

use crate::{
    scatter::counts::frequencies::Frequencies,
    setting::{SettingError, require},
};

/// 64 MiB of counts.
const MOST_QUADRATS: f64 = (1 << 24) as f64;
/// The circumference of the Earth.
const FARTHEST_M: f64 = 4.1e7;

/// A rectangle of ground divided into equal quadrats, row after row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QuadratGrid {
    min_m: DVec2,
    quadrat_m: DVec2,
    columns: u32,
    rows: u32,
}

impl QuadratGrid {
    /// Divides the ground from `min_m` to `max_m` into `columns` x `rows` quadrats.
    ///
    /// # Errors
    /// [`SettingError`] where the ground has no area or is no number, or the quadrats are none or more than
    /// 2^24.
    pub fn new(min_m: DVec2, max_m: DVec2, columns: u32, rows: u32) -> Result<Self, SettingError> {
        for (name, value) in [("min.x", min_m.x), ("min.y", min_m.y), ("max.x", max_m.x), ("max.y", max_m.y)] {
            require(name, value, -FARTHEST_M..=FARTHEST_M)?;
        }
        let size = max_m - min_m;
        require("max.x - min.x", size.x, 1e-3..=2.0 * FARTHEST_M)?;
        require("max.y - min.y", size.y, 1e-3..=2.0 * FARTHEST_M)?;
        require("quadrats", f64::from(columns) * f64::from(rows), 1.0..=MOST_QUADRATS)?;
        Ok(Self { min_m, quadrat_m: size / DVec2::new(f64::from(columns), f64::from(rows)), columns, rows })
    }

    /// Divides the ground so that there are about as many quadrats as `points`, nearly square: what the paper advises.
    ///
    /// # Errors
    /// As [`QuadratGrid::new`].
    pub fn with_quadrat_for_each(points: usize, min_m: DVec2, max_m: DVec2) -> Result<Self, SettingError> {
        let whole = Self::new(min_m, max_m, 1, 1)?.quadrat_m;
        let columns = (points as f64 * whole.x / whole.y).sqrt().round().clamp(1.0, MOST_QUADRATS);
        let rows = (points as f64 / columns).round().max(1.0);
        Self::new(min_m, max_m, columns as u32, rows as u32)
    }

    /// Quadrats along x.
    pub fn columns(&self) -> u32 {
        self.columns
    }

    /// Quadrats along y.
    pub fn rows(&self) -> u32 {
        self.rows
    }

    /// Number of quadrats.
    pub fn quadrats(&self) -> usize {
        self.columns as usize * self.rows as usize
    }

    /// Size of one quadrat, m.
    pub fn quadrat_m(&self) -> DVec2 {
        self.quadrat_m
    }

    /// The least corner of a quadrat, m.
    pub fn corner_m(&self, quadrat: usize) -> DVec2 {
        let columns = self.columns as usize;
        self.min_m + self.quadrat_m * DVec2::new((quadrat % columns) as f64, (quadrat / columns) as f64)
    }

    /// The number of points in each quadrat. Points on the far edges belong to the last quadrats.
    ///
    /// # Errors
    /// [`SettingError`] for the first point that is outside the ground or no number.
    pub fn counts(&self, points: &[DVec2]) -> Result<Vec<u32>, SettingError> {
        let mut counts = vec![0_u32; self.quadrats()];
        let cells = DVec2::new(f64::from(self.columns), f64::from(self.rows));
        let max_m = self.min_m + self.quadrat_m * cells;
        for (index, point) in points.iter().enumerate() {
            let place = (point - self.min_m) / self.quadrat_m;
            // The last decimals of the far edge may be lost in the division.
            let slack = 1e-9 * cells;
            // NaN is not inside either.
            if !(place.cmpge(-slack).all() && place.cmple(cells + slack).all()) {
                let allowed = format!("from {} to {max_m}", self.min_m);
                return Err(SettingError::new(format!("points[{index}]"), point, allowed));
            }
            let column = (place.x.max(0.0) as usize).min(self.columns as usize - 1);
            let row = (place.y.max(0.0) as usize).min(self.rows as usize - 1);
            counts[row * self.columns as usize + column] += 1;
        }
        Ok(counts)
    }

    /// How many quadrats hold 0, 1, 2, ... of the points.
    ///
    /// # Errors
    /// [`SettingError`] for the first point that is outside the ground or no number, and for counts that [`Frequencies::new`] refuses.
    pub fn frequencies(&self, points: &[DVec2]) -> Result<Frequencies, SettingError> {
        Frequencies::of_counts(&self.counts(points)?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_are_counted_in_their_quadrat_also_on_edges() {
        let grid = QuadratGrid::new(DVec2::new(-10.0, 0.0), DVec2::new(10.0, 30.0), 2, 3).unwrap();
        let points = [(-10.0, 0.0), (-0.1, 9.9), (0.0, 10.0), (10.0, 30.0), (5.0, 25.0)].map(DVec2::from);
        assert_eq!(grid.counts(&points).unwrap(), [2, 0, 0, 1, 0, 2]);
        assert_eq!(grid.frequencies(&points).unwrap().quadrats_with(), [3, 1, 2]);
        assert_eq!(grid.corner_m(3), DVec2::new(0.0, 10.0));
    }

    #[test]
    fn points_outside_the_window_are_named() {
        let grid = QuadratGrid::new(DVec2::ZERO, DVec2::ONE, 4, 4).unwrap();
        for bad in [DVec2::new(1.5, 0.5), DVec2::new(f64::NAN, 0.5), DVec2::new(0.5, f64::NEG_INFINITY)] {
            let message = grid.counts(&[DVec2::splat(0.5), bad]).unwrap_err().to_string();
            assert!(message.starts_with("`points[1]` is ["), "{message}");
            assert!(message.ends_with("but must be from [0, 0] to [1, 1]"), "{message}");
        }
    }

    #[test]
    fn ground_without_area_and_a_bad_number_of_quadrats_are_refused() {
        let error =
            |max_m: DVec2, columns, rows| QuadratGrid::new(DVec2::ZERO, max_m, columns, rows).unwrap_err().to_string();
        assert!(error(DVec2::new(0.0, 1.0), 1, 1).starts_with("`max.x - min.x` is 0"));
        assert!(error(DVec2::new(1.0, f64::NAN), 1, 1).starts_with("`max.y` is NaN"));
        assert!(error(DVec2::ONE, 0, 3).starts_with("`quadrats` is 0"));
        assert!(error(DVec2::ONE, u32::MAX, u32::MAX).starts_with("`quadrats` is"));
        assert!(QuadratGrid::with_quadrat_for_each(usize::MAX, DVec2::ZERO, DVec2::ONE).is_err());
    }

    #[test]
    fn a_quadrat_for_each_point_is_nearly_square() {
        let grid = QuadratGrid::with_quadrat_for_each(1000, DVec2::ZERO, DVec2::new(300.0, 100.0)).unwrap();
        let quadrat = grid.quadrat_m();
        assert!((grid.quadrats() as f64 - 1000.0).abs() < 30.0);
        assert!((quadrat.x / quadrat.y - 1.0).abs() < 0.05, "{quadrat}");
    }
}
