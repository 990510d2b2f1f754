//! The synthesised wind, measured from its samples as an anemometer would, against the formulas of the literature.
//!
//! The formulas are written out here once more and the spectra are estimated from the velocities alone, so that
//! nothing but the samples is shared with the synthesis.

use crate::report::Report;
use bevy::math::Vec3;
use bevy_windwood::wind::{FieldSettings, WindField};
use rustfft::{FftPlanner, num_complex::Complex};
use std::{thread, time::Instant};

/// Realisations in the ensemble. The estimates' own scatter falls with the root of their number.
const SEEDS: u64 = 800;

/// The paper's u, v, w as axes of wind coordinates (along, up, across).
const AXES: [usize; 3] = [0, 2, 1];

/// Pairs of points whose coherence is measured: (lower level, upper level, columns apart).
const PAIRS: [(usize, usize, usize); 18] = [
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

pub fn run() -> Report {
    let settings = FieldSettings::default();
    let mut report = Report::default();
    let start = Instant::now();
    let field = WindField::synthesise(&settings).expect("the default settings are valid");
    report.tell("synthesis_s", start.elapsed().as_secs_f64(), "one field of 2048 x 16 x 16 on one thread");
    let target = Target::new(&field);
    let ensemble = Ensemble::measure(&settings, &target);

    let (psd, psd_slowest) = psd_errors(&ensemble, &target);
    report.at_most("psd_worst_octave_error", psd, 0.05, "relative, octaves of 8 and more bins, all levels, u v w");
    report.tell("psd_slowest_bins_error", psd_slowest, "relative, the 7 slowest bins");
    let coherence = root_coherence_error(&ensemble, &target);
    report.at_most("root_coherence_worst_error", coherence, 0.02, "absolute, octaves, lateral, vertical and oblique");
    report.at_most("variance_worst_error", variance_error(&ensemble, &target), 0.02, "relative to the resolved band");
    let [u, v, w] = field.resolved_fraction();
    report.tell("resolved_fraction_u", f64::from(u), "of the whole variance, mean over levels");
    report.tell("resolved_fraction_v", f64::from(v), "");
    report.tell("resolved_fraction_w", f64::from(w), "");
    report.at_most("log_law_worst_error", log_law_error(&field, &target), 1e-3, "relative, means of sample()");
    let seam = Seam::measure(&field);
    report.at_most("period_seam", seam.jump, 1e-5, "sample() a period later in time and across, relative to U(10)");
    report.at_most("period_seam_step", seam.step_ratio, 1.1, "rms step over the seam to rms step elsewhere");
    report.tell("deviation_midway", deviation_midway(&field), "of sample() between columns and levels to that on them");
    report.tell("seeds", SEEDS as f64, "realisations");
    report
}

/// What the literature says about the field (Setas et al., equations 9 to 12, as corrected).
struct Target {
    samples: usize,
    time_step_s: f64,
    columns: usize,
    column_spacing_m: f64,
    heights_m: Vec<f64>,
    friction_velocity_m_s: f64,
    roughness_length_m: f64,
    /// Cy = Cz of u, v, w.
    decay: [f64; 3],
}

impl Target {
    fn new(field: &WindField) -> Self {
        let settings = field.settings();
        let resolution = &settings.resolution;
        let roughness_length_m = f64::from(settings.roughness_length_m);
        let spacing_m = f64::from(resolution.level_spacing_m);
        Self {
            samples: resolution.time_samples as usize,
            time_step_s: f64::from(resolution.time_step_s),
            columns: resolution.columns as usize,
            column_spacing_m: f64::from(resolution.column_spacing_m),
            heights_m: (1..=resolution.levels).map(|level| f64::from(level) * spacing_m).collect(),
            friction_velocity_m_s: 0.4 * f64::from(settings.mean_speed_m_s) / (10.0 / roughness_length_m).ln(),
            roughness_length_m,
            decay: [10.0, 7.0, 8.0],
        }
    }

    fn bins(&self) -> usize {
        self.samples / 2
    }

    fn frequency_hz(&self, bin: usize) -> f64 {
        bin as f64 / (self.samples as f64 * self.time_step_s)
    }

    /// Equation 10.
    fn mean_speed_m_s(&self, height_m: f64) -> f64 {
        self.friction_velocity_m_s / 0.4 * (height_m / self.roughness_length_m).ln()
    }

    /// Equations 9.
    fn psd(&self, component: usize, frequency_hz: f64, level: usize) -> f64 {
        let height_m = self.heights_m[level];
        let nu = frequency_hz * height_m / self.mean_speed_m_s(height_m);
        let reduced = match component {
            0 => 200.0 * nu / (1.0 + 50.0 * nu).powf(5.0 / 3.0),
            1 => 15.0 * nu / (1.0 + 9.5 * nu).powf(5.0 / 3.0),
            _ => 3.36 * nu / (1.0 + 10.0 * nu.powf(5.0 / 3.0)),
        };
        self.friction_velocity_m_s.powi(2) * reduced / frequency_hz
    }

    /// Equations 11 and 12.
    fn root_coherence(&self, component: usize, frequency_hz: f64, (low, high, lag): (usize, usize, usize)) -> f64 {
        let (low_m, high_m) = (self.heights_m[low], self.heights_m[high]);
        let mean_speed_m_s = 0.5 * (self.mean_speed_m_s(low_m) + self.mean_speed_m_s(high_m));
        let distance_m = (high_m - low_m).hypot(lag as f64 * self.column_spacing_m);
        (-frequency_hz * self.decay[component] * distance_m / mean_speed_m_s).exp()
    }

    /// The integral of the spectrum over the resolved band, one strip for each bin.
    fn resolved_variance(&self, component: usize, level: usize) -> f64 {
        let strip_hz = self.frequency_hz(1);
        (1..self.bins()).map(|bin| self.psd(component, self.frequency_hz(bin), level) * strip_hz).sum()
    }
}

/// Octaves of frequency bins: 1 to 7, 8 to 15, 16 to 31 and so on.
fn band(bin: usize) -> usize {
    bin.ilog2().saturating_sub(2) as usize
}

fn bins_of_band(band: usize) -> std::ops::Range<usize> {
    if band == 0 { 1..8 } else { 4 << band..8 << band }
}

/// Sums over realisations and columns.
struct Ensemble {
    levels: usize,
    bands: usize,
    /// Periodogram over target: \[component\]\[level\]\[band\].
    power: Vec<f64>,
    /// Cross-periodogram over target, real part: \[component\]\[pair\]\[band\].
    cross: Vec<f64>,
    /// Mean squares: \[component\]\[level\].
    variance: Vec<f64>,
    /// Series in the sums.
    series: f64,
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

    fn measure(settings: &FieldSettings, target: &Target) -> Self {
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

    /// The Fourier transform of every series (column, level) over the square root of what its periodogram should be.
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

    fn power(&self, component: usize, level: usize, band: usize) -> f64 {
        let bins = bins_of_band(band).len() as f64;
        self.power[(component * self.levels + level) * self.bands + band] / (self.series * bins)
    }

    fn root_coherence(&self, component: usize, pair: usize, band: usize) -> f64 {
        let bins = bins_of_band(band).len() as f64;
        let (low, high, _) = PAIRS[pair];
        let cross = self.cross[(component * PAIRS.len() + pair) * self.bands + band] / (self.series * bins);
        cross / (self.power(component, low, band) * self.power(component, high, band)).sqrt()
    }
}

/// The factor on each bin of a transform that turns its square into periodogram over target, 2 dt/N |X|^2 / S.
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

/// The worst relative error of the power in octaves of 8 and more bins, and in the slowest bins.
fn psd_errors(ensemble: &Ensemble, target: &Target) -> (f64, f64) {
    let worst_of = |bands: std::ops::Range<usize>| {
        let error = |component, level| {
            let of_band = |band| (ensemble.power(component, level, band) - 1.0).abs();
            bands.clone().map(of_band).fold(0.0, f64::max)
        };
        worst(3, target.heights_m.len(), error)
    };
    (worst_of(1..ensemble.bands), worst_of(0..1))
}

fn root_coherence_error(ensemble: &Ensemble, target: &Target) -> f64 {
    worst(3, PAIRS.len(), |component, pair| {
        let error = |band: usize| {
            let bins = bins_of_band(band);
            let count = bins.len() as f64;
            let expected: f64 =
                bins.map(|bin| target.root_coherence(component, target.frequency_hz(bin), PAIRS[pair])).sum();
            (ensemble.root_coherence(component, pair, band) - expected / count).abs()
        };
        (0..ensemble.bands).map(error).fold(0.0, f64::max)
    })
}

fn variance_error(ensemble: &Ensemble, target: &Target) -> f64 {
    worst(3, ensemble.levels, |component, level| {
        let measured = ensemble.variance[component * ensemble.levels + level] / ensemble.series;
        (measured / target.resolved_variance(component, level) - 1.0).abs()
    })
}

fn worst(rows: usize, columns: usize, error: impl Fn(usize, usize) -> f64) -> f64 {
    let of_row = |row| (0..columns).map(|column| error(row, column)).fold(0.0, f64::max);
    (0..rows).map(of_row).fold(0.0, f64::max)
}

/// Mean velocities over a period of time at many places, on and between the samples, against equation 10.
fn log_law_error(field: &WindField, target: &Target) -> f64 {
    let heights_m = [0.2, 1.0, 2.5, 4.0, 10.0, 18.3, 33.0, 40.0, 100.0];
    let error = |_, index: usize| {
        let height_m: f64 = heights_m[index];
        let expected = target.mean_speed_m_s(height_m);
        let mut sum = 0.0;
        for place in 0..8 {
            let position = Vec3::new(place as f32 * 13.7, height_m as f32, place as f32 * 17.3);
            let at_time = |sample| field.sample(position, (f64::from(sample) + 0.3) * target.time_step_s).x;
            sum += (0..target.samples as u32).map(|sample| f64::from(at_time(sample))).sum::<f64>();
        }
        (sum / (8 * target.samples) as f64 / expected - 1.0).abs()
    };
    worst(1, heights_m.len(), error)
}

/// How the field joins itself.
struct Seam {
    jump: f64,
    step_ratio: f64,
}

impl Seam {
    fn measure(field: &WindField) -> Self {
        let (period_s, width_m) = (field.period_s(), field.width_m() as f32);
        let speed_m_s = f64::from(field.settings().mean_speed_m_s);
        let (mut jump, mut at_seam, mut elsewhere) = (0.0, 0.0, 0.0);
        for place in 0..4096_u32 {
            // Multiples of 1/16, so that adding a period does not round.
            let [a, b, c] = [7, 11, 13].map(|stride| f64::from(place * stride % 2048) / 16.0);
            let position = Vec3::new(a as f32, 2.0 + (c / 4.0) as f32, b as f32);
            let here = field.sample(position, c);
            let later = field.sample(position, c + period_s);
            let aside = field.sample(position - width_m * Vec3::Z, c - 3.0 * period_s);
            jump = f64::max(jump, f64::from((later - here).length().max((aside - here).length())) / speed_m_s);

            let on_time_seam = Vec3::new(0.0, position.y, position.z);
            let on_side_seam = Vec3::new(position.x, position.y, width_m);
            let on_column = Vec3::new(position.x, position.y, (place % 16) as f32 * width_m / 16.0);
            at_seam += time_step(field, on_time_seam, period_s) + side_step(field, on_side_seam, c);
            elsewhere += time_step(field, on_time_seam, c) + side_step(field, on_column, c);
        }
        Self { jump, step_ratio: (at_seam / elsewhere).sqrt() }
    }
}

/// Squared change of the velocity over half a sample of time.
fn time_step(field: &WindField, position: Vec3, time_s: f64) -> f64 {
    let quarter_s = 0.25 * f64::from(field.settings().resolution.time_step_s);
    let change = field.sample(position, time_s + quarter_s) - field.sample(position, time_s - quarter_s);
    f64::from(change.length_squared())
}

/// Squared change of the velocity over half a sample across the wind.
fn side_step(field: &WindField, position: Vec3, time_s: f64) -> f64 {
    let quarter = 0.25 * field.settings().resolution.column_spacing_m * Vec3::Z;
    f64::from((field.sample(position + quarter, time_s) - field.sample(position - quarter, time_s)).length_squared())
}

/// The standard deviation of the turbulence in the middle between columns and levels over that on them.
fn deviation_midway(field: &WindField) -> f64 {
    let resolution = field.settings().resolution;
    let power = |offset: f32| {
        let mut sum = 0.0;
        for place in 0..16 {
            let across = (place as f32 + offset) * resolution.column_spacing_m;
            let height = (4.0 + offset) * resolution.level_spacing_m;
            for sample in 0..resolution.time_samples {
                let time_s = f64::from(sample) * f64::from(resolution.time_step_s);
                sum += f64::from(field.turbulence_at(Vec3::new(0.0, height, across), time_s).length_squared());
            }
        }
        sum
    };
    (power(0.5) / power(0.0)).sqrt()
}
