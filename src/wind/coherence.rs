//! The coherence of any two points, factorised: coherent amplitudes are drawn from the factors.
//!
//! The field is homogeneous across the wind but not in height: the coherence of two levels depends on the mean of
//! their two mean speeds (equation 12, corrected). So an FFT applies across the wind only. At each frequency:
//!
//! ```text
//! gamma(z1, z2, y)                          root coherence at lateral lag y, the shorter way round the period
//! C_k(z1, z2) = 1/N sum_y gamma e^(-i k y)  one real symmetric matrix per lateral wavenumber k
//! C_k = L_k L_k^T                           Cholesky factorisation
//! ```
//!
//! and `sum_k |row z of L_k|^2 = gamma(z, z, 0) = 1`. Wrapping the kernel makes some `C_k` slightly indefinite at the
//! slowest frequencies. Their negative part is dropped, and the rows are rescaled to that sum.

use super::{
    factorisation::{add_scaled, factorise, packed_columns, packed_len},
    profile::LogProfile,
    settings::FieldResolution,
    spectrum::DecayCoefficients,
};
use std::f64::consts::TAU;

/// How often a lag, or a wavenumber, occurs in a period of `columns`: all but the ends stand for two of opposite sign.
fn multiplicity(index: usize, columns: usize) -> f64 {
    if index == 0 || 2 * index == columns { 1.0 } else { 2.0 }
}

/// f^ / f of equation 12 for every lateral lag and every pair of levels, s: \[lag\]\[packed pair\].
pub(super) fn decay_times_s(resolution: &FieldResolution, profile: &LogProfile, decay: DecayCoefficients) -> Vec<f64> {
    let levels = resolution.levels as usize;
    let mean_speeds: Vec<f64> =
        (0..levels).map(|level| f64::from(profile.turbulence_scales(resolution.level_height_m(level)).1)).collect();
    let mut times_s = Vec::with_capacity((resolution.columns as usize / 2 + 1) * packed_len(levels));
    for lag in 0..=resolution.columns / 2 {
        let lateral_m = f64::from(lag) * f64::from(resolution.column_spacing_m);
        for low in 0..levels {
            times_s.extend((low..levels).map(|high| {
                let vertical_m = (high - low) as f64 * f64::from(resolution.level_spacing_m);
                decay.decay_time_s(lateral_m, vertical_m, 0.5 * (mean_speeds[low] + mean_speeds[high]))
            }));
        }
    }
    times_s
}

/// The root coherence, frequency by frequency: exp(-f t) for each decay time t.
pub(super) struct CoherenceKernel<'a> {
    values: Vec<f64>,
    /// exp(-df t): one product carries a value on to the next frequency.
    steps: &'a [f64],
}

impl<'a> CoherenceKernel<'a> {
    pub fn new(decay_times_s: &[f64], first_hz: f64, steps: &'a [f64]) -> Self {
        Self { values: exponentials(decay_times_s, first_hz), steps }
    }

    pub fn advance(&mut self) {
        for (value, step) in self.values.iter_mut().zip(self.steps) {
            *value *= step;
        }
    }
}

/// exp(-f t) for each decay time t.
pub(super) fn exponentials(decay_times_s: &[f64], frequency_hz: f64) -> Vec<f64> {
    decay_times_s.iter().map(|time_s| (-frequency_hz * time_s).exp()).collect()
}

/// Factors `L_k` of the coherence matrices of one frequency, for the wavenumbers 0..=columns/2.
pub(super) struct CoherenceFactors {
    columns: usize,
    levels: usize,
    /// \[wavenumber\]\[lag\]: the weight of a lag in the real Fourier transform of an even periodic function.
    weights: Vec<f64>,
    /// `C_k`: \[wavenumber\]\[packed\]
    matrices: Vec<f64>,
    /// `L_k`, likewise.
    factors: Vec<f64>,
    row_powers: Vec<f64>,
}

impl CoherenceFactors {
    pub fn new(columns: usize, levels: usize) -> Self {
        let lags = columns / 2 + 1;
        let weight = |wavenumber: usize, lag: usize| {
            let turns = (wavenumber * lag % columns) as f64 / columns as f64;
            multiplicity(lag, columns) * (TAU * turns).cos() / columns as f64
        };
        Self {
            columns,
            levels,
            weights: (0..lags).flat_map(|wavenumber| (0..lags).map(move |lag| weight(wavenumber, lag))).collect(),
            matrices: vec![0.0; lags * packed_len(levels)],
            factors: vec![0.0; lags * packed_len(levels)],
            row_powers: vec![0.0; levels],
        }
    }

    /// Factorises the coherence of one frequency.
    pub fn factorise(&mut self, kernel: &CoherenceKernel) {
        self.transform(&kernel.values);
        let packed = packed_len(self.levels);
        for (matrix, factor) in self.matrices.chunks_exact(packed).zip(self.factors.chunks_exact_mut(packed)) {
            factorise(matrix, self.levels, factor);
        }
        self.normalise_rows();
    }

    /// The packed factor `L_k` of one wavenumber, of either sign, 0..columns.
    pub fn of_wavenumber(&self, wavenumber: usize) -> &[f64] {
        let packed = packed_len(self.levels);
        let wavenumber = wavenumber.min(self.columns - wavenumber);
        &self.factors[wavenumber * packed..][..packed]
    }

    /// The Fourier transform over the lateral lags, of all pairs of levels at once.
    fn transform(&mut self, kernel: &[f64]) {
        let packed = packed_len(self.levels);
        let lags = self.columns / 2 + 1;
        for (matrix, weights) in self.matrices.chunks_exact_mut(packed).zip(self.weights.chunks_exact(lags)) {
            matrix.fill(0.0);
            for (values, weight) in kernel.chunks_exact(packed).zip(weights) {
                add_scaled(matrix, *weight, values);
            }
        }
    }

    /// Gives each level the variance 1 over all wavenumbers.
    fn normalise_rows(&mut self) {
        self.row_powers.fill(0.0);
        for (wavenumber, matrix) in self.factors.chunks_exact(packed_len(self.levels)).enumerate() {
            let multiplicity = multiplicity(wavenumber, self.columns);
            for (column, range) in packed_columns(self.levels) {
                for (power, value) in self.row_powers[column..].iter_mut().zip(&matrix[range]) {
                    *power += multiplicity * value * value;
                }
            }
        }
        for power in &mut self.row_powers {
            *power = power.sqrt().recip();
        }
        for matrix in self.factors.chunks_exact_mut(packed_len(self.levels)) {
            for (column, range) in packed_columns(self.levels) {
                for (value, scale) in matrix[range].iter_mut().zip(&self.row_powers[column..]) {
                    *value *= scale;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn default_decay_times_s() -> Vec<f64> {
        let profile = LogProfile::from_reference(8.0, 0.1, 0.0);
        decay_times_s(&FieldResolution::default(), &profile, DecayCoefficients { lateral: 7.0, vertical: 7.0 })
    }

    fn factors_at(frequency_hz: f64) -> CoherenceFactors {
        let mut factors = CoherenceFactors::new(16, 16);
        factors.factorise(&CoherenceKernel::new(&default_decay_times_s(), frequency_hz, &[]));
        factors
    }

    /// `sum_k (L_k L_k^T)(low, high) cos(k lag)`: the coherence that amplitudes drawn from the factors have.
    fn coherence(factors: &CoherenceFactors, low: usize, high: usize, lag: usize) -> f64 {
        let of_wavenumber = |wavenumber: usize| {
            let factor = factors.of_wavenumber(wavenumber);
            let shared = packed_columns(16).take(low + 1);
            let power: f64 = shared
                .map(|(column, range)| factor[range.start + low - column] * factor[range.start + high - column])
                .sum();
            power * (TAU * (wavenumber * lag) as f64 / 16.0).cos()
        };
        (0..16).map(of_wavenumber).sum()
    }

    /// Equation 12 written out.
    fn expected(frequency_hz: f64, low: usize, high: usize, lag: usize) -> f64 {
        let heights_m = [low, high].map(|level| 2.5 * (level + 1) as f64);
        let [low_m_s, high_m_s] = heights_m.map(|height_m| 8.0 * (height_m / 0.1).ln() / 100f64.ln());
        let distance_m = (heights_m[1] - heights_m[0]).hypot(8.0 * lag.min(16 - lag) as f64);
        (-frequency_hz * 7.0 * distance_m / (0.5 * (low_m_s + high_m_s))).exp()
    }

    fn worst_error(frequency_hz: f64) -> f64 {
        let factors = factors_at(frequency_hz);
        let mut worst: f64 = 0.0;
        for low in 0..16 {
            for high in low..16 {
                for lag in 0..16 {
                    let error = coherence(&factors, low, high, lag) - expected(frequency_hz, low, high, lag);
                    worst = worst.max(error.abs());
                }
            }
        }
        worst
    }

    #[test]
    fn factors_reproduce_the_coherence_of_every_pair_of_points() {
        for frequency_hz in [0.0625, 0.2, 1.0, 7.9] {
            // Exact but for speeds in f32.
            assert!(worst_error(frequency_hz) < 1e-6, "{frequency_hz} Hz: {}", worst_error(frequency_hz));
        }
    }

    #[test]
    fn clipping_changes_the_slowest_frequencies_little() {
        for bin in 1..8 {
            // Computed beforehand with the eigenvalues of NumPy: 0.0152 in the first bin, falling.
            assert!(worst_error(f64::from(bin) / 128.0) < 0.016);
        }
        assert!(worst_error(1.0 / 128.0) > 0.01, "nothing was clipped, so the fallback is not needed");
    }

    #[test]
    fn advancing_the_kernel_reaches_the_exponential() {
        let times_s = default_decay_times_s();
        let steps = exponentials(&times_s, 0.01);
        let mut kernel = CoherenceKernel::new(&times_s, 0.05, &steps);
        (0..31).for_each(|_| kernel.advance());
        for (value, exact) in kernel.values.iter().zip(exponentials(&times_s, 0.36)) {
            // 31 roundings of f64, and an exponent of up to 30 at 0.36 Hz.
            assert_relative_eq!(*value, exact, max_relative = 1e-12);
        }
    }

    #[test]
    fn odd_numbers_of_columns_have_unit_power_too() {
        let resolution = FieldResolution { columns: 5, levels: 3, ..Default::default() };
        let profile = LogProfile::from_reference(8.0, 0.1, 0.0);
        let times_s = decay_times_s(&resolution, &profile, DecayCoefficients::default());
        let mut factors = CoherenceFactors::new(5, 3);
        factors.factorise(&CoherenceKernel::new(&times_s, 0.1, &[]));
        let power: f64 = (0..5).map(|wavenumber| factors.of_wavenumber(wavenumber)[0].powi(2)).sum();
        assert_relative_eq!(power, 1.0, max_relative = 1e-12);
    }
}
