//! The power of `WindField::sample` at random places, between all samples, in many winds.

use super::target::{Target, band};
use crate::report::Report;
use bevy::math::Vec3;
use bevy_windwood::wind::{FieldSettings, WindField};
use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};
use rustfft::{FftPlanner, num_complex::Complex};
use std::thread;

const SPEEDS_M_S: [f32; 4] = [2.0, 8.0, 16.0, 30.0];
const ROUGHNESS_M: [f32; 4] = [0.005, 0.1, 0.5, 2.0];
const DISPLACEMENTS_M: [f32; 4] = [0.0, 4.5, 10.0, 20.0];

/// Realisations of each wind.
const SEEDS: u64 = 60;
/// Random places and times of each.
const PLACES: usize = 3000;
/// Time series at random places of each realisation of the default wind.
const SERIES: usize = 12;
/// The paper's u, v, w as axes of wind coordinates (along, up, across).
const AXES: [usize; 3] = [0, 2, 1];
/// Random places lie within so many metres of the origin.
const REACH_M: f32 = 3000.0;
/// Where the spline in time still keeps its power, Hz: 4 samples and more in a cycle.
const KEPT_BELOW_HZ: f64 = 2.0;

pub fn add_figures(report: &mut Report) {
    let (allowed, refused): (Vec<_>, Vec<_>) = winds().into_iter().partition(|wind| wind.validate().is_ok());
    let errors = in_parallel(&allowed, variance_error);
    let worst = errors.iter().copied().fold(0.0, f64::max);
    for (wind, error) in allowed.iter().zip(&errors) {
        let FieldSettings { speed, roughness_m, displacement_m, .. } = wind;
        eprintln!("spectrum: {speed} m/s, z0 {roughness_m} m, d {displacement_m} m: variance off by {error:.4}");
    }
    report.at_most("offgrid_variance_error", worst, 0.05, "u v w at random places, worst of the sweep, relative");
    report.record("sweep_winds", allowed.len() as f64, "2 to 30 m/s, z0 0.005 to 2 m, d 0 to 4.5 m");
    report.record("sweep_refused", refused.len() as f64, "d of 10 and 20 m: the speed is given 10 m above ground");
    let (slow, fast) = octave_errors();
    report.record(
        "offgrid_octave_error",
        slow,
        "power at random places of any height, octaves to 2 Hz, u v w, relative",
    );
    report.record("offgrid_octave_error_above_2_hz", fast, "where the spline in time loses power");
}

fn winds() -> Vec<FieldSettings> {
    let mut winds = Vec::new();
    for speed in SPEEDS_M_S {
        for roughness_m in ROUGHNESS_M {
            winds.extend(DISPLACEMENTS_M.map(|displacement_m| FieldSettings {
                speed,
                roughness_m,
                displacement_m,
                ..Default::default()
            }));
        }
    }
    winds
}

/// Maps on all threads.
fn in_parallel<T: Sync, R: Send>(inputs: &[T], map: impl Fn(&T) -> R + Sync) -> Vec<R> {
    let threads = thread::available_parallelism().map_or(1, usize::from);
    let share = inputs.len().div_ceil(threads).max(1);
    thread::scope(|scope| {
        let parts: Vec<_> =
            inputs.chunks(share).map(|part| scope.spawn(|| part.iter().map(&map).collect::<Vec<R>>())).collect();
        parts.into_iter().flat_map(|part| part.join().expect("a measuring thread failed")).collect()
    })
}

/// The worst relative error of the variance of u, v and w at random places, against the spectra at the heights of these
/// places: from one level above the displacement plane to the highest level.
fn variance_error(wind: &FieldSettings) -> f64 {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(7);
    let mut sums = [0.0; 3];
    let mut expected: Option<HeightTable> = None;
    for seed in 0..SEEDS {
        let field = WindField::synthesise(&FieldSettings { seed, ..wind.clone() }).expect("valid settings");
        let expected = expected.get_or_insert_with(|| HeightTable::new(&Target::new(&field)));
        // The formulas hold above the displacement plane, and the field resolves their change with height from a level above it.
        let lowest_m = wind.displacement_m + HeightTable::LOWEST_M;
        for _ in 0..PLACES {
            let (position, time_s) = random_place(&mut random, lowest_m);
            let turbulence = field.turbulence_at(position, time_s);
            for (component, sum) in sums.iter_mut().enumerate() {
                *sum += f64::from(turbulence[AXES[component]]).powi(2) / expected.variance(component, position.y);
            }
        }
    }
    let count = (SEEDS as usize * PLACES) as f64;
    sums.iter().map(|sum| (sum / count - 1.0).abs()).fold(0.0, f64::max)
}

fn random_place(random: &mut Xoshiro256PlusPlus, lowest_m: f32) -> (Vec3, f64) {
    let place = Vec3::new(
        random.random_range(-REACH_M..REACH_M),
        random.random_range(lowest_m..HeightTable::HIGHEST_M),
        random.random_range(-REACH_M..REACH_M),
    );
    (place, random.random_range(0.0..1000.0))
}

/// Expected variances over height.
struct HeightTable(Vec<[f64; 3]>);

impl HeightTable {
    /// The levels of the default field.
    const LOWEST_M: f32 = 2.5;
    const HIGHEST_M: f32 = 40.0;
    const STEPS: usize = 150;

    fn new(target: &Target) -> Self {
        let step_m = f64::from(Self::HIGHEST_M - Self::LOWEST_M) / Self::STEPS as f64;
        let at = |step: usize| {
            let height_m = f64::from(Self::LOWEST_M) + step as f64 * step_m;
            [0, 1, 2].map(|component| target.resolved_variance_at(component, height_m))
        };
        Self((0..=Self::STEPS).map(at).collect())
    }

    fn variance(&self, component: usize, height_m: f32) -> f64 {
        let share = (height_m - Self::LOWEST_M) / (Self::HIGHEST_M - Self::LOWEST_M);
        self.0[((share * Self::STEPS as f32).round() as usize).min(Self::STEPS)][component]
    }
}

/// The worst relative errors of the power in octaves of 8 and more bins at random places in the default wind: up to
/// [`KEPT_BELOW_HZ`], and above.
fn octave_errors() -> (f64, f64) {
    let default = WindField::synthesise(&FieldSettings::default()).expect("the default settings are valid");
    let target = Target::new(&default);
    let seeds: Vec<u64> = (0..4 * SEEDS).collect();
    let of_seeds = in_parallel(&seeds, |&seed| octave_powers(seed, &target));
    let bands = band(target.bins() - 1) + 1;
    let (mut slow, mut fast) = (0.0_f64, 0.0_f64);
    for octave in 1..bands {
        let first_hz = target.frequency_hz(4 << octave);
        for component in 0..3 {
            let sum: [f64; 2] = of_seeds.iter().fold([0.0; 2], |sum, of_seed| {
                let [power, count] = of_seed[component * bands + octave];
                [sum[0] + power, sum[1] + count]
            });
            let error = (sum[0] / sum[1] - 1.0).abs();
            let worst = if first_hz < KEPT_BELOW_HZ { &mut slow } else { &mut fast };
            *worst = worst.max(error);
        }
    }
    (slow, fast)
}

/// Sums of periodogram over target and their number: \[component\]\[band\].
fn octave_powers(seed: u64, target: &Target) -> Vec<[f64; 2]> {
    let field = WindField::synthesise(&FieldSettings { seed, ..Default::default() }).expect("valid settings");
    let mut random = Xoshiro256PlusPlus::seed_from_u64(seed + 1000);
    let fft = FftPlanner::new().plan_fft_forward(target.samples);
    let bands = band(target.bins() - 1) + 1;
    let mut sums = vec![[0.0; 2]; 3 * bands];
    for _ in 0..SERIES {
        let (position, start_s) = random_place(&mut random, HeightTable::LOWEST_M);
        let at = |sample: usize| field.turbulence_at(position, start_s + sample as f64 * target.time_step_s);
        let velocities: Vec<Vec3> = (0..target.samples).map(at).collect();
        for (component, axis) in AXES.into_iter().enumerate() {
            let mut series: Vec<_> = velocities.iter().map(|v| Complex::from(f64::from(v[axis]))).collect();
            fft.process(&mut series);
            let periodogram = 2.0 * target.time_step_s / target.samples as f64;
            for (bin, value) in series.iter().enumerate().take(target.bins()).skip(1) {
                let expected = target.psd_at(component, target.frequency_hz(bin), f64::from(position.y));
                let sum = &mut sums[component * bands + band(bin)];
                *sum = [sum[0] + periodogram * value.norm_sqr() / expected, sum[1] + 1.0];
            }
        }
    }
    sums
}
