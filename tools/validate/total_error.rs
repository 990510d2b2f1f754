//! The motion of beams by the table against direct integration, with all that the table leaves out at once: the rank of the load
//! basis, the step in time, the rounding of frequencies, the mix of damping ratios, and what is above the band.
//!
//! Slow beams, up to 3.6 Hz, are compared with direct integration in the very wind of the table, time by time. Fast ones answer gusts
//! above some 2 Hz that are another realisation than any wind's: only the size of their motion can be compared. That is done in
//! a wind of another seed, with gusts of up to 24 Hz, integrated in steps of 1/256 s.
//!
//! All beams feel the wind of one point, so that the size of what they carry plays no part: see the topic `sway` for that.

use crate::{
    basis::{OVERSAMPLING, SAMPLES, drag, integrate, quantile, random_direction, relative_error},
    report::Report,
    test_wind::{HEIGHT_M, MEAN_SPEED_M_S, TIME_STEP_S, fine_wind, slow_rms, test_wind},
};
use bevy::math::{DVec3, Vec3};
use bevy_windwood::{
    dynamics::{FrequencyClasses, LoadBasis, LoadBasisKind, OscillatorGrid, ResponseTable, TablePlace},
    sway::SwaySettings,
    wind::{FieldResolution, FieldSettings, GustBands, WindField},
};
use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};
use rustfft::{FftPlanner, num_complex::Complex};

const SEED: u64 = 31;
/// Turbulence intensities.
const INTENSITIES: [f64; 4] = [0.1, 0.2, 0.35, 0.6];
/// Beams of random direction, frequency and damping, for each of them.
const BEAMS: usize = 80;
/// Natural frequencies, Hz.
const SLOWEST_HZ: f32 = 0.1;
const FASTEST_HZ: f32 = 12.0;
/// Twigs, of which the sizes are told apart.
const TWIGS_FROM_HZ: f32 = 4.0;
/// What drag adds to the damping ratio, at most.
const MOST_DRAG_DAMPING: f32 = 0.15;
/// Steps of the direct integration of fast beams per step of the table.
const FINE_OVERSAMPLING: usize = 16;
/// Roughness length of the field that the fast gusts are of, m.
const ROUGHNESS_M: f64 = 0.1;

/// The errors of one beam.
struct Errors {
    frequency_hz: f32,
    /// Of the motion, where it can be compared time by time.
    motion: Option<f64>,
    /// Of the rms of the motion.
    size: f64,
    /// Rms of the motion above the crossover, over what it should be.
    ringing: f64,
}

pub fn run(report: &mut Report) {
    let errors: Vec<Errors> = INTENSITIES.into_iter().flat_map(errors).collect();
    let motion: Vec<f64> = errors.iter().filter_map(|error| error.motion).collect();
    report.record("total_error_median", quantile(motion.clone(), 0.5), "all errors at once, 0.1 to 3.6 Hz; aim 0.10");
    report.record("total_error_p95", quantile(motion, 0.95), "the same");
    let size: Vec<f64> = errors.iter().map(|error| error.size).collect();
    report.record("total_size_error_median", quantile(size.clone(), 0.5), "of the rms of the motion, 0.1 to 12 Hz");
    report.record("total_size_error_p95", quantile(size, 0.95), "the same");
    let twigs = || errors.iter().filter(|error| error.frequency_hz >= TWIGS_FROM_HZ);
    let size: Vec<f64> = twigs().map(|error| error.size).collect();
    report.record("fast_size_error_median", quantile(size.clone(), 0.5), "the same, 4 to 12 Hz");
    report.record("fast_size_error_p95", quantile(size, 0.95), "the same");
    let ringing: Vec<f64> = twigs().map(|error| (error.ringing - 1.0).abs()).collect();
    report.record("fast_ringing_error_median", quantile(ringing.clone(), 0.5), "motion above 2 Hz alone, 4 to 12 Hz");
    report.record("fast_ringing_error_p95", quantile(ringing, 0.95), "the same");
    let ratios: Vec<f64> = twigs().map(|error| error.ringing).collect();
    report.record("fast_ringing_ratio_median", quantile(ratios, 0.5), "table over direct integration, the same");
}

fn errors(intensity: f64) -> Vec<Errors> {
    let bands = GustBands::of_period(SAMPLES as f64 * TIME_STEP_S);
    let fine = test_wind(SEED, SAMPLES, OVERSAMPLING, intensity);
    let other = fine_wind(SEED + 1, SAMPLES, FINE_OVERSAMPLING, intensity);
    let fast = fast_gusts(intensity);
    let wind: Vec<Vec3> = fine.iter().step_by(OVERSAMPLING).copied().collect();
    let structure = SwaySettings::default().damping_ratio;
    let grid = OscillatorGrid::new(FrequencyClasses::default(), structure, MEAN_SPEED_M_S as f32, 0.0);
    let basis = LoadBasis::new(LoadBasisKind::Principal, &wind, drag);
    let table = ResponseTable::new(&[wind], TIME_STEP_S as f32, &fast, &basis, grid);
    let mut random = Xoshiro256PlusPlus::seed_from_u64(SEED);
    let mut beam = || {
        let direction = random_direction(&mut random);
        let frequency_hz = SLOWEST_HZ * (FASTEST_HZ / SLOWEST_HZ).powf(random.random::<f32>());
        let damping = structure + MOST_DRAG_DAMPING * random.random::<f32>();
        let class = grid.classes.coordinate(frequency_hz);
        let read = grid.weights(class, 0.0, damping);
        let coefficients = basis.coefficients(direction);
        let at = |step: usize| {
            let tau_s = step as f64 * TIME_STEP_S / OVERSAMPLING as f64;
            let rows = read.rows.iter().zip(read.weights);
            coefficients.load(
                rows.map(|(&row, weight)| table.response(row as usize, &TablePlace::on_column(0, tau_s)) * weight)
                    .sum(),
            )
        };
        let looked_up: Vec<Vec3> = (0..fine.len()).map(at).collect();
        let is_fast = grid.classes.nearest(class) >= grid.classes.first_fast();
        let (wind, oversampling) = if is_fast { (&other, FINE_OVERSAMPLING) } else { (&fine, OVERSAMPLING) };
        let direct = integrate(wind, oversampling, direction, f64::from(frequency_hz), f64::from(damping));
        let cycles = (bands.crossover_hz * SAMPLES as f64 * TIME_STEP_S) as usize;
        Errors {
            frequency_hz,
            motion: (!is_fast).then(|| relative_error(&looked_up, &direct)),
            size: (rms_above(0, &looked_up) / rms_above(0, &direct) - 1.0).abs(),
            ringing: rms_above(cycles, &looked_up) / rms_above(cycles, &direct),
        }
    };
    (0..BEAMS).map(|_| beam()).collect()
}

/// The fast gusts of a field with the spectra and the period of the test wind.
fn fast_gusts(intensity: f64) -> Vec<Vec3> {
    let friction_m_s = 0.4 * MEAN_SPEED_M_S / (HEIGHT_M / ROUGHNESS_M).ln();
    let settings = FieldSettings {
        speed: MEAN_SPEED_M_S as f32,
        roughness_m: ROUGHNESS_M as f32,
        gustiness: (intensity * MEAN_SPEED_M_S / (slow_rms() * friction_m_s)) as f32,
        resolution: FieldResolution { time_samples: SAMPLES as u32, columns: 1, levels: 1, ..Default::default() },
        ..Default::default()
    };
    WindField::synthesise(&settings).expect("settings in range").fast_gusts(HEIGHT_M as f32)
}

/// Rms of the part of a motion that is faster than so many cycles in its period.
fn rms_above(cycles: usize, motion: &[Vec3]) -> f64 {
    let to_frequency = FftPlanner::new().plan_fft_forward(motion.len());
    let power = |axis: usize| {
        let mut spectrum: Vec<Complex<f64>> = motion.iter().map(|v| f64::from(v[axis]).into()).collect();
        to_frequency.process(&mut spectrum);
        2.0 * spectrum[cycles + 1..motion.len() / 2].iter().map(Complex::norm_sqr).sum::<f64>()
    };
    let power = DVec3::new(power(0), power(1), power(2)).element_sum();
    power.sqrt() / motion.len() as f64
}
