//! Spectra and coherence of series, for plots.
//!
//! The wind's series are periodic, so their Fourier transforms are exact and need no window. A single realisation's spectrum
//! scatters by as much as its own size: it is averaged over series and over bands of frequencies of equal ratio.

use rustfft::{FftPlanner, num_complex::Complex};

/// Bands in an octave.
const BANDS_PER_OCTAVE: f64 = 3.0;

/// The Fourier transform of one period of a series.
#[derive(Clone, Debug)]
pub struct Transform {
    lines: Vec<Complex<f64>>,
    period_s: f64,
}

/// A value in a band of frequencies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Band {
    /// The geometric middle of its lines, Hz.
    pub frequency_hz: f64,
    pub value: f64,
}

impl Transform {
    /// Of evenly spaced samples of one period, s.
    pub fn new(samples: impl Iterator<Item = f64>, period_s: f64) -> Self {
        let mut lines: Vec<Complex<f64>> = samples.map(|sample| Complex::new(sample, 0.0)).collect();
        if !lines.is_empty() {
            FftPlanner::new().plan_fft_forward(lines.len()).process(&mut lines);
        }
        Self { lines, period_s }
    }

    /// Lines of positive frequency, below half the sampling rate.
    fn count(&self) -> usize {
        self.lines.len().div_ceil(2)
    }

    /// One-sided power spectral density of a line, in squared units per Hz: `2 T |X/n|^2`.
    fn density(&self, line: usize) -> f64 {
        2.0 * self.period_s * self.lines[line].norm_sqr() / (self.lines.len() as f64).powi(2)
    }
}

/// The one-sided power spectral density, averaged over series of one length and over bands. Its integral is the variance.
pub fn spectrum(series: &[Transform]) -> Vec<Band> {
    banded(series, |line| series.iter().map(|one| one.density(line)).sum::<f64>() / series.len() as f64)
}

/// The root coherence of pairs of series, the real part of `<X Y*> / sqrt(<X X*> <Y Y*>)`, each averaged over the pairs and over
/// bands: 1 where they are alike, 0 where they share nothing.
pub fn root_coherence(pairs: &[(&Transform, &Transform)]) -> Vec<Band> {
    let Some(((first, _), rest)) = pairs.first().zip(Some(&pairs)) else { return Vec::new() };
    let sums = |line: usize| {
        rest.iter().fold([0.0; 3], |[cross, xx, yy], (x, y)| {
            let (x, y) = (x.lines[line], y.lines[line]);
            [cross + (x * y.conj()).re, xx + x.norm_sqr(), yy + y.norm_sqr()]
        })
    };
    bands(first)
        .map(|band| {
            let [cross, xx, yy] = band.clone().map(sums).fold([0.0; 3], |a, b| [a[0] + b[0], a[1] + b[1], a[2] + b[2]]);
            let value = cross / (xx * yy).sqrt();
            Band { frequency_hz: middle_hz(first, &band), value: if value.is_finite() { value } else { 0.0 } }
        })
        .collect()
}

fn banded(series: &[Transform], of_line: impl Fn(usize) -> f64) -> Vec<Band> {
    let Some(first) = series.first() else { return Vec::new() };
    bands(first)
        .map(|band| {
            let value = band.clone().map(&of_line).sum::<f64>() / band.len() as f64;
            Band { frequency_hz: middle_hz(first, &band), value }
        })
        .collect()
}

/// The lines of each band, from the first above 0 on.
fn bands(of: &Transform) -> impl Iterator<Item = std::ops::Range<usize>> + use<> {
    let (mut next, count) = (1, of.count());
    std::iter::from_fn(move || {
        let start = next;
        next = ((start as f64 * 2.0_f64.powf(1.0 / BANDS_PER_OCTAVE)).round() as usize).max(start + 1).min(count);
        (start < count).then_some(start..next)
    })
}

fn middle_hz(of: &Transform, band: &std::ops::Range<usize>) -> f64 {
    (band.start as f64 * (band.end - 1) as f64).sqrt() / of.period_s
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};
    use std::f64::consts::TAU;

    const SAMPLES: usize = 2048;
    const PERIOD_S: f64 = 128.0;

    fn of(series: impl Fn(f64) -> f64) -> Transform {
        Transform::new((0..SAMPLES).map(|sample| series(sample as f64 * PERIOD_S / SAMPLES as f64)), PERIOD_S)
    }

    /// Sum of S df over the lines, from the bands' means.
    fn variance(bands: &[Band], transform: &Transform) -> f64 {
        bands.iter().zip(super::bands(transform)).map(|(band, lines)| band.value * lines.len() as f64 / PERIOD_S).sum()
    }

    #[test]
    fn a_sine_has_half_its_squared_amplitude_at_its_frequency() {
        let sine = of(|time_s| 3.0 * (TAU * 0.5 * time_s).sin() + 7.0);
        let bands = spectrum(std::slice::from_ref(&sine));
        assert!((variance(&bands, &sine) - 4.5).abs() < 1e-9);
        let highest = bands.iter().max_by(|a, b| a.value.total_cmp(&b.value)).unwrap();
        assert!((highest.frequency_hz / 0.5 - 1.0).abs() < 0.15, "{highest:?}");
    }

    #[test]
    fn noise_is_flat_and_has_its_variance() {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(1);
        let series: Vec<Transform> =
            (0..16).map(|_| Transform::new((0..SAMPLES).map(|_| random.random_range(-1.0..1.0)), PERIOD_S)).collect();
        let bands = spectrum(&series);
        // Variance 1/3 over 8 Hz. A band of n lines and 16 series scatters by 1 / sqrt(16 n).
        let high: Vec<&Band> = bands.iter().filter(|band| band.frequency_hz > 0.5).collect();
        assert!(high.iter().all(|band| (band.value * 24.0 - 1.0).abs() < 0.15), "{high:?}");
        assert!((variance(&bands, &series[0]) - 1.0 / 3.0).abs() < 0.01);
    }

    #[test]
    fn coherence_is_one_for_the_same_series_and_nothing_for_others() {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(2);
        let mut noise = || Transform::new((0..SAMPLES).map(|_| random.random_range(-1.0..1.0)), PERIOD_S);
        let series: Vec<Transform> = (0..32).map(|_| noise()).collect();
        let same: Vec<_> = series.iter().map(|one| (one, one)).collect();
        assert!(root_coherence(&same).iter().all(|band| (band.value - 1.0).abs() < 1e-12));
        let others: Vec<_> = series.iter().zip(series.iter().skip(1)).collect();
        assert!(
            root_coherence(&others).iter().filter(|band| band.frequency_hz > 0.5).all(|band| band.value.abs() < 0.1)
        );
        assert!(root_coherence(&[]).is_empty() && spectrum(&[]).is_empty());
        assert!(spectrum(&[Transform::new(std::iter::empty(), 1.0)]).is_empty());
    }
}
