//! From the coherence of any two points to factors from which coherent amplitudes are drawn.
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
//! and sum_k |row z of L_k|^2 = gamma(z, z, 0) = 1. Wrapping the kernel makes some C_k slightly indefinite at the
//! slowest frequencies; these lose their negative part, and the rows are rescaled to that sum.

use super::{
    DecayCoefficients, FieldResolution, LogProfile,
    factorisation::{add_scaled, factorise, packed_columns, packed_len},
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

/// The root coherence at one frequency after the other: exp(-f t) for each decay time t.
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

/// Factors L_k of the coherence matrices of one frequency, for the wavenumbers 0..=columns/2.
pub(super) struct CoherenceFactors {
    columns: usize,
    levels: usize,
    /// \[wavenumber\]\[lag\]: the weight of a lag in the real Fourier transform of an even periodic function.
    weights: Vec<f64>,
    /// C_k: \[wavenumber\]\[packed\]
    matrices: Vec<f64>,
    /// L_k, likewise.
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

    /// The packed factor L_k of one wavenumber, of either sign, 0..columns.
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
