//! The pairs of a map, lag by lag: how many there are, and the sum of the squares of their differences.
//!
//! ```text
//! sum of (z(x + h) - z(x))^2 = sum of z(x)^2 over the first of all pairs + sum of z(x + h)^2 over the second - 2 P(h)
//! ```
//!
//! P is the autocorrelation of z. Without gaps the firsts of all pairs fill a rectangle, whose sum of squares comes from a table of running
//! sums. With gaps z is 0 in them, and with m = 1 where there is data and 0 in gaps
//!
//! ```text
//! number of pairs          = autocorrelation of m
//! sum of both squares      = correlation of z^2 with m, and of m with z^2
//!                          = half of (autocorrelation of z^2 + m  -  autocorrelation of z^2 - m)
//! ```

use super::{autocorrelation::Autocorrelation, elevation_grid::ElevationGrid};

/// The pairs of a map.
pub(super) struct LagPairs {
    longest: [usize; 2],
    products: Autocorrelation,
    squares: Squares,
}

/// Where the number of pairs and the sums of their squares come from.
enum Squares {
    /// A map without gaps.
    Whole { columns: usize, rows: usize, sums: RunningSums },
    /// A map with gaps, whose squares are divided by `unit`, their mean, so that they are added to 0 and 1 without loss.
    WithGaps { pairs: Autocorrelation, sum: Autocorrelation, difference: Autocorrelation, unit: f64 },
}

impl LagPairs {
    /// The pairs of `values`, which are those of the samples of `grid` and 0 in its gaps, up to `longest` columns and rows.
    pub fn new(values: &[f64], grid: &ElevationGrid, longest: [usize; 2]) -> Self {
        let (columns, rows) = (grid.columns(), grid.rows());
        let longest = [longest[0].min(columns - 1), longest[1].min(rows - 1)];
        let correlate = |values: &[f64]| Autocorrelation::new(values, columns, longest[0], longest[1]);
        let squares = if grid.gaps() == 0 {
            Squares::Whole { columns, rows, sums: RunningSums::new(values, columns) }
        } else {
            let is_measured = |index| f64::from(u8::from(grid.is_measured(index)));
            let unit = values.iter().map(|value| value * value).sum::<f64>() / values.len() as f64;
            let mixed = |sign: f64| {
                let mixed = |(index, value): (usize, &f64)| value * value / unit + sign * is_measured(index);
                correlate(&values.iter().enumerate().map(mixed).collect::<Vec<_>>())
            };
            let pairs = correlate(&(0..values.len()).map(is_measured).collect::<Vec<_>>());
            Squares::WithGaps { pairs, sum: mixed(1.0), difference: mixed(-1.0), unit }
        };
        Self { longest, products: correlate(values), squares }
    }

    /// The longest lag, columns and rows.
    pub fn longest(&self) -> [usize; 2] {
        self.longest
    }

    /// Sum of (z(x + h) - z(x))^2 / 2 over all pairs at a lag, and their number.
    pub fn at(&self, column: isize, row: usize) -> (f64, f64) {
        let (squares, pairs) = self.squares.at(column, row);
        ((0.5 * squares - self.products.sum(column, row)).max(0.0), pairs)
    }
}

impl Squares {
    /// Sum of the squares of the firsts and of the seconds of all pairs at a lag, and the number of pairs.
    fn at(&self, column: isize, row: usize) -> (f64, f64) {
        match self {
            Self::Whole { columns, rows, sums } => {
                let across = column.unsigned_abs();
                let (width, height) = (columns - across, rows - row);
                let (left, right) = if column < 0 { (across, 0) } else { (0, across) };
                let squares = sums.of([left, 0], [width, height]) + sums.of([right, row], [width, height]);
                (squares, (width * height) as f64)
            }
            Self::WithGaps { pairs, sum, difference, unit } => {
                // A whole number, but for what the transform leaves.
                let pairs = pairs.sum(column, row).round().max(0.0);
                (0.5 * unit * (sum.sum(column, row) - difference.sum(column, row)), pairs)
            }
        }
    }
}

/// Sums of squares over any rectangle of a grid.
struct RunningSums {
    width: usize,
    sums: Vec<f64>,
}

impl RunningSums {
    fn new(values: &[f64], columns: usize) -> Self {
        let width = columns + 1;
        let mut sums = vec![0.0; width * (values.len() / columns + 1)];
        for (row, values) in values.chunks_exact(columns).enumerate() {
            let mut of_row = 0.0;
            for (column, value) in values.iter().enumerate() {
                of_row += value * value;
                sums[(row + 1) * width + column + 1] = sums[row * width + column + 1] + of_row;
            }
        }
        Self { width, sums }
    }

    /// The sum over `size` columns and rows from the sample `first`.
    fn of(&self, first: [usize; 2], size: [usize; 2]) -> f64 {
        let at = |column: usize, row: usize| self.sums[row * self.width + column];
        let ([left, top], [right, bottom]) = (first, [first[0] + size[0], first[1] + size[1]]);
        at(right, bottom) - at(left, bottom) - at(right, top) + at(left, top)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use bevy::math::DVec2;

    #[test]
    fn pairs_with_a_gap_are_left_out() {
        let (columns, rows) = (11_usize, 9_usize);
        let height = |index: usize| (index * index * 31 % 101) as f64 - 50.0;
        let is_gap = |index: usize| index % 7 == 3 || (30..40).contains(&index);
        for with_gaps in [false, true] {
            let is_gap = |index: usize| with_gaps && is_gap(index);
            let samples = |index: usize| if is_gap(index) { f32::NAN } else { height(index) as f32 };
            let heights_m = (0..columns * rows).map(samples).collect();
            let grid = ElevationGrid::with_gaps(11, 9, DVec2::ONE, heights_m).unwrap();
            let values: Vec<f64> =
                (0..columns * rows).map(|index| if is_gap(index) { 0.0 } else { height(index) }).collect();
            let found = LagPairs::new(&values, &grid, [5, 100]);
            assert_eq!(found.longest(), [5, 8]);
            for row in 0..=8_usize {
                for column in -5..=5_isize {
                    let (mut half_squares, mut pairs) = (0.0, 0.0);
                    for first in 0..columns * rows {
                        let across = (first % columns) as isize + column;
                        let is_inside = (0..columns as isize).contains(&across) && first / columns + row < rows;
                        let second = (first + row * columns).wrapping_add_signed(column);
                        if is_inside && !is_gap(first) && !is_gap(second) {
                            half_squares += 0.5 * (height(first) - height(second)).powi(2);
                            pairs += 1.0;
                        }
                    }
                    let at = found.at(column, row);
                    assert_eq!(at.1, pairs, "{column}, {row}");
                    assert_relative_eq!(at.0, half_squares, epsilon = 1e-6, max_relative = 1e-9);
                }
            }
        }
    }
}
