//! What pairs of trees read: the coherence of the wind at two stems, through the tables, and where it repeats.

use super::target::{Target, band, bins_of_band};
use crate::report::Report;
use bevy::math::Vec3;
use bevy_windwood::{
    sway::{SwaySettings, WindResponse},
    wind::{FieldSettings, WindField},
};
use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};
use rustfft::{FftPlanner, num_complex::Complex};
use std::sync::Arc;

const SEEDS: u64 = 40;
/// Pairs of stems in each range of distances and realisation.
const PAIRS: usize = 40;
/// Ranges of the distance between two stems across the wind, m; within one it is uniform.
const RANGES_M: [[f32; 2]; 6] = [[1.0, 2.0], [2.0, 4.0], [4.0, 8.0], [8.0, 16.0], [16.0, 32.0], [32.0, 60.0]];
/// The paper's u, v, w as axes of wind coordinates (along, up, across).
const AXES: [usize; 3] = [0, 2, 1];
/// Stems stand within so many metres of the origin.
const REACH_M: f32 = 5000.0;
/// Distances across the wind that are searched for a repeat, m.
const SEARCHED_M: [u32; 2] = [64, 6000];
/// A repeat is a correlation beyond this.
const ALIKE: f64 = 0.5;

pub fn add_figures(report: &mut Report, target: &Target) {
    let mut sums = Sums::new(target);
    let mut correlations = Vec::new();
    for seed in 0..SEEDS {
        let response = response(seed);
        let mut random = Xoshiro256PlusPlus::seed_from_u64(seed + 500);
        for (range, [from_m, to_m]) in RANGES_M.into_iter().enumerate() {
            for _ in 0..PAIRS {
                let place = Vec3::new(0.0, 10.0, random.random_range(-REACH_M..REACH_M));
                let distance_m = random.random_range(from_m..to_m);
                sums.add(&response, place, distance_m, range, target);
            }
        }
        if seed < 8 {
            correlations.push(correlations_by_distance(&response, target));
        }
    }
    let errors = [0, 1, 2].map(|component| sums.errors(component));
    for (component, errors) in errors.iter().enumerate() {
        for (range, errors) in RANGES_M.iter().zip(errors) {
            let row: Vec<String> = errors.iter().map(|error| format!("{error:+.3}")).collect();
            eprintln!("spectrum: component {component}, {range:?} m: {}", row.join(" "));
        }
    }
    let [u, v, w] = errors.map(|errors| errors.iter().flatten().map(|error| error.abs()).fold(0.0, f64::max));
    report.at_most(
        "lateral_coherence_of_trees_error",
        u,
        0.05,
        "root coherence of u, worst octave of frequency and of distance, 1 to 60 m",
    );
    report.record("lateral_coherence_of_trees_v", v, "the same of v, which has a slower decay and the same lags");
    report.record("lateral_coherence_of_trees_w", w, "the same of w");
    report.at_most(
        "trees_power_octave_error",
        sums.power_error(),
        0.05,
        "of what trees read at random places, octaves to 2 Hz, u v w, relative",
    );
    report.at_least("lateral_repeat_m", repeat_m(&correlations), 1000.0, "stems that far apart are alike at a moment");
}

fn response(seed: u64) -> WindResponse {
    let field = WindField::synthesise(&FieldSettings { seed, ..Default::default() }).expect("valid settings");
    WindResponse::new(Arc::new(field), &SwaySettings::default())
}

/// Transforms of what a tree reads in one period: u, v, w.
fn spectra(response: &WindResponse, place: Vec3, target: &Target) -> [Vec<Complex<f64>>; 3] {
    let fft = FftPlanner::new().plan_fft_forward(target.samples);
    let velocity = |sample: usize| response.table.velocity(&response.place(place, sample as f64 * target.time_step_s));
    let velocities: Vec<Vec3> = (0..target.samples).map(velocity).collect();
    AXES.map(|axis| {
        let mut series: Vec<_> = velocities.iter().map(|v| Complex::from(f64::from(v[axis]))).collect();
        fft.process(&mut series);
        series.truncate(target.bins());
        series
    })
}

/// Sums over pairs: cross-periodogram, mean periodogram and expected coherence, all over the expected periodogram.
struct Sums {
    bands: usize,
    /// \[component\]\[range\]\[band\]
    cells: Vec<[f64; 4]>,
}

impl Sums {
    fn new(target: &Target) -> Self {
        let bands = band(target.bins() - 1) + 1;
        Self { bands, cells: vec![[0.0; 4]; 3 * RANGES_M.len() * bands] }
    }

    fn add(&mut self, response: &WindResponse, place: Vec3, distance_m: f32, range: usize, target: &Target) {
        let here = spectra(response, place, target);
        let there = spectra(response, place + distance_m * Vec3::Z, target);
        for component in 0..3 {
            for bin in 1..target.bins() {
                let frequency_hz = target.frequency_hz(bin);
                let expected_power =
                    target.psd_at(component, frequency_hz, 10.0) * target.samples as f64 / (2.0 * target.time_step_s);
                let (a, b) = (here[component][bin], there[component][bin]);
                let expected = target.lateral_root_coherence(component, frequency_hz, f64::from(distance_m));
                let cell = &mut self.cells[(component * RANGES_M.len() + range) * self.bands + band(bin)];
                cell[0] += (a * b.conj()).re / expected_power;
                cell[1] += 0.5 * (a.norm_sqr() + b.norm_sqr()) / expected_power;
                cell[2] += expected;
                cell[3] += 1.0;
            }
        }
    }

    /// Measured less expected root coherence of a component: \[range\]\[band\].
    fn errors(&self, component: usize) -> Vec<Vec<f64>> {
        let of_component = self.cells.chunks_exact(RANGES_M.len() * self.bands).nth(component).unwrap_or(&[]);
        let error = |[cross, power, expected, count]: &[f64; 4]| cross / power - expected / count;
        of_component.chunks_exact(self.bands).map(|range| range.iter().map(error).collect()).collect()
    }

    /// The worst relative error of the power in octaves of 8 and more bins, below 2 Hz.
    fn power_error(&self) -> f64 {
        let of = |component: usize, octave: usize| {
            let cells =
                (0..RANGES_M.len()).map(|range| self.cells[(component * RANGES_M.len() + range) * self.bands + octave]);
            let [power, count] = cells.fold([0.0; 2], |sum, cell| [sum[0] + cell[1], sum[1] + cell[3]]);
            (power / count - 1.0).abs()
        };
        let slow = (1..self.bands).filter(|&octave| bins_of_band(octave).start < 256);
        slow.flat_map(|octave| [0, 1, 2].map(|component| of(component, octave))).fold(0.0, f64::max)
    }
}

/// The correlation of u at places so far apart, at the same moment, in the mean over a width: \[distance in columns\].
fn correlations_by_distance(response: &WindResponse, target: &Target) -> Vec<f64> {
    let [from, to] = SEARCHED_M.map(|distance_m| distance_m as usize / 8);
    let stride = 8;
    let series: Vec<Vec<f64>> = (0..to + target.columns)
        .map(|column| {
            let place = Vec3::new(0.0, 10.0, 8.0 * column as f32);
            let velocity = |sample: usize| {
                response.table.velocity(&response.place(place, (sample * stride) as f64 * target.time_step_s))
            };
            let speeds: Vec<f64> = (0..target.samples / stride).map(|sample| f64::from(velocity(sample).x)).collect();
            let mean = speeds.iter().sum::<f64>() / speeds.len() as f64;
            speeds.iter().map(|speed| speed - mean).collect()
        })
        .collect();
    let product = |a: usize, b: usize| series[a].iter().zip(&series[b]).map(|(a, b)| a * b).sum::<f64>();
    (from..to)
        .map(|distance| {
            let pairs = || (0..target.columns).map(|first| (first, first + distance));
            let power: f64 = pairs().map(|(a, b)| 0.5 * (product(a, a) + product(b, b))).sum();
            pairs().map(|(a, b)| product(a, b)).sum::<f64>() / power
        })
        .collect()
}

/// The least distance beyond the coherence itself at which the mean correlation over realisations says that stems are alike.
fn repeat_m(correlations: &[Vec<f64>]) -> f64 {
    let mean =
        |index: usize| correlations.iter().map(|of_seed| of_seed[index]).sum::<f64>() / correlations.len() as f64;
    let first = (0..correlations[0].len()).find(|&index| mean(index) > ALIKE);
    first.map_or(f64::from(SEARCHED_M[1]), |index| f64::from(SEARCHED_M[0]) + 8.0 * index as f64)
}
