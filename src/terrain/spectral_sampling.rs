//! Stratified sampling of the spectrum: where the harmonics of a line process take their frequencies from.
//!
//! The paper spaces the frequencies of equation 3 evenly, which loses the tail of the spectrum. Here the spectrum is
//! cut into M intervals, and each harmonic draws one frequency from its interval by the inverse of the distribution F,
//! with amplitude sqrt(2 p), p the interval's share of the variance. The variance is then right in every line, and the
//! covariance is unbiased.
//!
//! Intervals of equal share, p = 1/M, would give a heavy tail to one or two harmonics: single ripples, seen from close by.
//! Intervals of equal width in log w would waste most harmonics where there is no variance. So intervals are equal in the
//! mean of both measures.

use super::covariance::{CovarianceModel, bisect};

/// Variance that may be lost at either end of the spectrum.
const NEGLIGIBLE: f64 = 1e-5;

/// An interval of angular wavenumbers, in radians per scale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SpectralInterval {
    low: f64,
    high: f64,
    below: f64,
    /// p, its share of the model's variance.
    pub share: f64,
}

impl SpectralInterval {
    /// A wavenumber from the interval: that with the share `position`, 0 to 1, of the interval's variance below it.
    pub fn wavenumber(&self, model: &CovarianceModel, position: f64) -> f64 {
        let share = self.below + position * self.share;
        bisect(|w| model.variance_below(w) < share, self.low, self.high)
    }
}

/// `count` intervals of the model's spectrum up to the wavenumber `limit`, in radians per scale.
pub(super) fn spectral_intervals(model: &CovarianceModel, limit: f64, count: usize) -> Vec<SpectralInterval> {
    let resolved = model.variance_below(limit);
    let highest = model.wavenumber_of(resolved * (1.0 - NEGLIGIBLE), limit);
    let lowest = model.wavenumber_of(resolved * NEGLIGIBLE, limit);
    let middle = model.wavenumber_of(resolved * 0.5, limit);
    let octaves = |w: f64| ((w + middle) / (lowest + middle)).ln();
    let rank = |w: f64| 0.5 * (model.variance_below(w) / resolved + octaves(w) / octaves(highest));

    let edge = |index: usize| match index {
        0 => 0.0,
        index if index == count => limit,
        index => bisect(|w| rank(w) < index as f64 / count as f64, lowest, highest),
    };
    let edges: Vec<f64> = (0..=count).map(edge).collect();
    let interval = |pair: &[f64]| {
        let below = model.variance_below(pair[0]);
        SpectralInterval { low: pair[0], high: pair[1], below, share: (model.variance_below(pair[1]) - below).max(0.0) }
    };
    edges.windows(2).map(interval).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn intervals_hold_the_whole_resolved_variance() {
        for model in CovarianceModel::ALL {
            let intervals = spectral_intervals(&model, 80.0, 100);
            let held: f64 = intervals.iter().map(|interval| interval.share).sum();
            assert_relative_eq!(held, model.variance_below(80.0), epsilon = 1e-7);
        }
    }

    #[test]
    fn intervals_are_adjacent_and_none_holds_more_than_two_equal_shares() {
        for model in CovarianceModel::ALL {
            let intervals = spectral_intervals(&model, 80.0, 100);
            assert!(intervals.windows(2).all(|pair| pair[0].high == pair[1].low && pair[0].low < pair[0].high));
            assert!(intervals.iter().all(|interval| interval.share < 2.0 / 100.0 + 1e-4), "{model:?}");
        }
    }

    #[test]
    fn wavenumbers_lie_in_their_interval_in_proportion_to_the_variance() {
        let model = CovarianceModel::Exponential;
        for interval in spectral_intervals(&model, 80.0, 50) {
            let w = interval.wavenumber(&model, 0.25);
            assert!((interval.low..=interval.high).contains(&w));
            let share = (model.variance_below(w) - interval.below) / interval.share;
            assert_relative_eq!(share, 0.25, epsilon = 1e-9);
        }
    }
}
