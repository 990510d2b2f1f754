//! Sums of products of all samples of a grid a lag apart, for all lags up to a longest, by the FFT.
//!
//! ```text
//! P(l, m) = sum_ij z(i, j) z(i + l, j + m) = inverse FFT of |FFT of z, padded with zeros|^2
//! ```
//!
//! The padding is as long as the longest lag, so that nothing wraps into the lags asked for.

use rustfft::{FftPlanner, num_complex::Complex};

/// The products of a grid, for lags from -`longest_column` to `longest_column` and from 0 to `longest_row`; those of
/// the other half are the same with both signs turned.
pub(super) struct Autocorrelation {
    longest_column: usize,
    sums: Vec<f64>,
}

impl Autocorrelation {
    /// The products of `values`, row by row, with `columns` to a row.
    ///
    /// Holds one half of the padded grid's spectrum: 265 MB for 4096 x 4096 samples and lags of a third of that.
    pub fn new(values: &[f64], columns: usize, longest_column: usize, longest_row: usize) -> Self {
        let rows = values.len() / columns;
        let width = fast_length(columns + longest_column);
        let height = fast_length(rows + longest_row);
        let mut spectrum = row_spectra(values, columns, width, height);
        correlate_columns(&mut spectrum, height);
        let sums = row_sums(&spectrum, width, height, longest_column, longest_row);
        Self { longest_column, sums }
    }

    /// P at a lag of `column`, -longest to longest, and `row`, 0 to longest.
    pub fn sum(&self, column: isize, row: usize) -> f64 {
        let index = self.longest_column.wrapping_add_signed(column);
        self.sums.get(row * (2 * self.longest_column + 1) + index).copied().unwrap_or(f64::NAN)
    }
}

/// The least length from `least` up with no prime factor above 5.
fn fast_length(least: usize) -> usize {
    let without = |mut length: usize, factor: usize| {
        while length.is_multiple_of(factor) {
            length /= factor;
        }
        length
    };
    (least.max(1)..).find(|&length| without(without(without(length, 2), 3), 5) == 1).unwrap_or(least)
}

/// The transforms of all rows, \[bin\]\[row\], for bins up to half of `width`: the others are their conjugates.
fn row_spectra(values: &[f64], columns: usize, width: usize, height: usize) -> Vec<Complex<f64>> {
    let fft = FftPlanner::new().plan_fft_forward(width);
    let mut spectrum = vec![Complex::ZERO; (width / 2 + 1) * height];
    let mut line = vec![Complex::ZERO; width];
    let mut scratch = vec![Complex::ZERO; fft.get_inplace_scratch_len()];
    for (row, values) in values.chunks_exact(columns).enumerate() {
        line.fill(Complex::ZERO);
        line.iter_mut().zip(values).for_each(|(bin, &value)| bin.re = value);
        fft.process_with_scratch(&mut line, &mut scratch);
        for (bin, value) in line[..=width / 2].iter().enumerate() {
            spectrum[bin * height + row] = *value;
        }
    }
    spectrum
}

/// Replaces each column by its cyclic autocorrelation.
fn correlate_columns(spectrum: &mut [Complex<f64>], height: usize) {
    let mut planner = FftPlanner::new();
    let (forward, inverse) = (planner.plan_fft_forward(height), planner.plan_fft_inverse(height));
    for column in spectrum.chunks_exact_mut(height) {
        forward.process(column);
        column.iter_mut().for_each(|value| *value = value.norm_sqr().into());
        inverse.process(column);
    }
}

/// The rows of lags 0 to `longest_row`, transformed back.
fn row_sums(
    spectrum: &[Complex<f64>],
    width: usize,
    height: usize,
    longest_column: usize,
    longest_row: usize,
) -> Vec<f64> {
    let fft = FftPlanner::new().plan_fft_inverse(width);
    let scale = 1.0 / (width * height) as f64;
    let mut sums = Vec::with_capacity((2 * longest_column + 1) * (longest_row + 1));
    let mut line = vec![Complex::ZERO; width];
    for row in 0..=longest_row {
        for bin in 0..=width / 2 {
            let value = spectrum[bin * height + row];
            line[bin] = value;
            // The sums are real, so that their transform along the row is Hermitian.
            if bin > 0 {
                line[width - bin] = value.conj();
            }
        }
        fft.process(&mut line);
        let at = |lag: usize| line[lag % width].re * scale;
        sums.extend((width - longest_column..=width + longest_column).map(at));
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn sums_are_those_over_all_pairs() {
        let (columns, rows) = (9, 7);
        let values: Vec<f64> = (0..columns * rows).map(|index| f64::from(index * index * 31 % 101) - 50.0).collect();
        let found = Autocorrelation::new(&values, columns as usize, 5, 4);
        for row in 0..=4 {
            for column in -5..=5 {
                let mut sum = 0.0;
                for (i, j) in (0..columns * rows).map(|index| (index % columns, index / columns)) {
                    if (0..columns).contains(&(i + column)) && j + row < rows {
                        sum += values[(j * columns + i) as usize] * values[((j + row) * columns + i + column) as usize];
                    }
                }
                assert_relative_eq!(found.sum(column as isize, row as usize), sum, epsilon = 1e-8);
            }
        }
    }

    #[test]
    fn fast_lengths_have_small_factors_only() {
        assert_eq!([1, 7, 11, 13, 31, 5461].map(fast_length), [1, 8, 12, 15, 32, 5625]);
    }
}
