//! Spectra, cross-spectra and variances of many realisations.

use super::target::{Target, band, bins_of_band};
use bevy_windwood::wind::{FieldSettings, WindField};
use rustfft::{FftPlanner, num_complex::Complex};
use std::thread;

/// Number of realisations. The scatter of the estimates falls with its square root.
pub const SEEDS: u64 = 800;

/// The paper's u, v, w as axes of wind coordinates (along, up, across).
const AXES: [usize; 3] = [0, 2, 1];

/// Pairs of points whose coherence is measured: (lower level, upper level, columns apart).
pub const PAIRS: [(usize, usize, usize); 18] = [
    (0, 0, 1),
    (0, 0, 2),
    (0, 0, 8),
    (7, 7, 1),
    (7, 7, 4),
    (15, 15, 1),
    (15, 15, 3),
    (15, 15, 8),
    (0, 1, 0),
    (3, 4, 0),
    (0, 7, 0),
    (7, 15, 0),
    (14, 15, 0),
    (0, 15, 0),
    (0, 2, 1),
    (5, 9, 2),
    (8, 15, 4),
    (0, 15, 8),
];

/// Sums over realisations and columns.
pub struct Ensemble {
    pub levels: usize,
    pub bands: usize,
    /// Periodogram over target: \[component\]\[level\]\[band\].
    power: Vec<f64>,
    /// Cross-periodogram over target, real part: \[component\]\[pair\]\[band\].
    cross: Vec<f64>,
    /// Mean squares: \[component\]\[level\].
    pub variance: Vec<f64>,
    /// Number of series in the sums.
    pub series: f64,
}

impl Ensemble {
    fn new(target: &Target) -> Self {
        let (levels, bands) = (target.heights_m.len(), band(target.bins() - 1) + 1);
        Self {
            levels,
            bands,
            power: vec![0.0; 3 * levels * bands],
            cross: vec![0.0; 3 * PAIRS.len() * bands],
            variance: vec![0.0; 3 * levels],
            series: 0.0,
        }
    }

    /// Synthesises and measures all realisations.
    pub fn measure(settings: &FieldSettings, target: &Target) -> Self {
        let threads = thread::available_parallelism().map_or(1, |threads| threads.get() as u64);
        let mut whole = Self::new(target);
        thread::scope(|scope| {
            let work = |first: u64| {
                let mut part = Self::new(target);
                for seed in (first..SEEDS).step_by(threads as usize) {
                    let settings = FieldSettings { seed, ..settings.clone() };
                    part.add(&WindField::synthesise(&settings).expect("valid settings"), target);
                }
                part
            };
            let parts: Vec<_> = (0..threads).map(|first| scope.spawn(move || work(first))).collect();
            for part in parts {
                whole.merge(&part.join().expect("a measuring thread failed"));
            }
        });
        whole
    }

    fn merge(&mut self, part: &Self) {
        let sums =
            [(&mut self.power, &part.power), (&mut self.cross, &part.cross), (&mut self.variance, &part.variance)];
        for (whole, part) in sums {
            whole.iter_mut().zip(part).for_each(|(whole, part)| *whole += part);
        }
        self.series += part.series;
    }

    fn add(&mut self, field: &WindField, target: &Target) {
        self.series += target.columns as f64;
        for component in 0..3 {
            let spectra = self.whitened_spectra(field, target, component);
            let spectrum = |column: usize, level: usize| &spectra[(column % target.columns) * self.levels + level];
            for column in 0..target.columns {
                for level in 0..self.levels {
                    let sums = &mut self.power[(component * self.levels + level) * self.bands..];
                    add_products(sums, spectrum(column, level), spectrum(column, level));
                }
                for (pair, (low, high, lag)) in PAIRS.into_iter().enumerate() {
                    let sums = &mut self.cross[(component * PAIRS.len() + pair) * self.bands..];
                    add_products(sums, spectrum(column, low), spectrum(column + lag, high));
                }
            }
        }
    }

    /// Fourier transforms of all series (column, level) over the square root of the expected periodogram.
    fn whitened_spectra(&mut self, field: &WindField, target: &Target, component: usize) -> Vec<Vec<Complex<f64>>> {
        let fft = FftPlanner::new().plan_fft_forward(target.samples);
        let whitening: Vec<Vec<f64>> = (0..self.levels).map(|level| whitening(target, component, level)).collect();
        let mut velocities = Vec::new();
        let mut spectra = Vec::with_capacity(target.columns * self.levels);
        for column in 0..target.columns {
            for (level, whitening) in whitening.iter().enumerate() {
                field.column_velocities(column, target.heights_m[level] as f32, &mut velocities);
                let mut series: Vec<_> =
                    velocities.iter().map(|velocity| Complex::from(f64::from(velocity[AXES[component]]))).collect();
                self.variance[component * self.levels + level] += variance(&series);
                fft.process(&mut series);
                series.truncate(target.bins());
                series.iter_mut().zip(whitening).for_each(|(value, factor)| *value *= factor);
                spectra.push(series);
            }
        }
        spectra
    }

    /// Measured over expected power.
    pub fn power(&self, component: usize, level: usize, band: usize) -> f64 {
        let bins = bins_of_band(band).len() as f64;
        self.power[(component * self.levels + level) * self.bands + band] / (self.series * bins)
    }

    /// Measured root coherence.
    pub fn root_coherence(&self, component: usize, pair: usize, band: usize) -> f64 {
        let bins = bins_of_band(band).len() as f64;
        let (low, high, _) = PAIRS[pair];
        let cross = self.cross[(component * PAIRS.len() + pair) * self.bands + band] / (self.series * bins);
        cross / (self.power(component, low, band) * self.power(component, high, band)).sqrt()
    }
}

/// The factor on each bin of a transform whose square makes it periodogram over target, 2 dt/N |X|^2 / S.
fn whitening(target: &Target, component: usize, level: usize) -> Vec<f64> {
    let periodogram = 2.0 * target.time_step_s / target.samples as f64;
    let of_bin = |bin| (periodogram / target.psd(component, target.frequency_hz(bin), level)).sqrt();
    (0..target.bins()).map(|bin| if bin == 0 { 0.0 } else { of_bin(bin) }).collect()
}

fn variance(series: &[Complex<f64>]) -> f64 {
    let mean = series.iter().map(|value| value.re).sum::<f64>() / series.len() as f64;
    series.iter().map(|value| (value.re - mean).powi(2)).sum::<f64>() / series.len() as f64
}

fn add_products(sums: &mut [f64], a: &[Complex<f64>], b: &[Complex<f64>]) {
    for bin in 1..a.len() {
        sums[band(bin)] += (a[bin] * b[bin].conj()).re;
    }
}
