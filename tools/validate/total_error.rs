//! The motion of beams by the table against direct integration, with all that the table leaves out at once: the rank of the load
//! basis, the step in time, the rounding of frequencies, the mix of damping ratios, and what is above the band.
//!
//! All beams feel the wind of one point, so that the size of what they carry plays no part: see the topic `sway` for that.

use crate::{
    basis::{
        MEAN_SPEED_M_S, OVERSAMPLING, SAMPLES, TIME_STEP_S, drag, integrate, quantile, random_direction,
        relative_error, test_wind,
    },
    report::Report,
};
use bevy::math::{DVec3, Vec3};
use bevy_windwood::{
    dynamics::{FrequencyClasses, LoadBasis, LoadBasisKind, OscillatorGrid, ResponseTable, TablePlace},
    sway::SwaySettings,
};
use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};

const SEED: u64 = 31;
/// Turbulence intensities.
const INTENSITIES: [f64; 4] = [0.1, 0.2, 0.35, 0.6];
/// Beams of random direction, frequency and damping, for each of them.
const BEAMS: usize = 80;
/// Natural frequencies, Hz.
const SLOWEST_HZ: f32 = 0.1;
const FASTEST_HZ: f32 = 12.0;
/// What drag adds to the damping ratio, at most.
const MOST_DRAG_DAMPING: f32 = 0.15;

/// The errors of one beam: of its motion, and of the size of its motion.
struct Errors {
    motion: f64,
    size: f64,
}

pub fn run(report: &mut Report) {
    let errors: Vec<Errors> = INTENSITIES.into_iter().flat_map(errors).collect();
    let motion: Vec<f64> = errors.iter().map(|error| error.motion).collect();
    report.record("total_error_median", quantile(motion.clone(), 0.5), "all errors at once, 0.1 to 12 Hz; aim 0.10");
    report.record("total_error_p95", quantile(motion, 0.95), "the same");
    let size: Vec<f64> = errors.iter().map(|error| error.size).collect();
    report.record("total_size_error_median", quantile(size.clone(), 0.5), "of the rms of the motion alone");
    report.record("total_size_error_p95", quantile(size, 0.95), "the same");
}

fn errors(intensity: f64) -> Vec<Errors> {
    let fine = test_wind(SEED, SAMPLES, OVERSAMPLING, intensity);
    let wind: Vec<Vec3> = fine.iter().step_by(OVERSAMPLING).copied().collect();
    let structure = SwaySettings::default().damping_ratio;
    let grid = OscillatorGrid::new(FrequencyClasses::default(), structure, MEAN_SPEED_M_S as f32, 0.0);
    let basis = LoadBasis::new(LoadBasisKind::Principal, &wind, drag);
    let table = ResponseTable::new(&[wind], TIME_STEP_S as f32, &basis, grid);
    let mut random = Xoshiro256PlusPlus::seed_from_u64(SEED);
    let mut beam = || {
        let direction = random_direction(&mut random);
        let frequency_hz = SLOWEST_HZ * (FASTEST_HZ / SLOWEST_HZ).powf(random.random::<f32>());
        let damping = structure + MOST_DRAG_DAMPING * random.random::<f32>();
        let read = grid.weights(grid.classes.coordinate(frequency_hz), 0.0, damping);
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
        let direct = integrate(&fine, direction, f64::from(frequency_hz), f64::from(damping));
        Errors { motion: relative_error(&looked_up, &direct), size: (rms(&looked_up) / rms(&direct) - 1.0).abs() }
    };
    (0..BEAMS).map(|_| beam()).collect()
}

/// Of the moving part.
fn rms(motion: &[Vec3]) -> f64 {
    let count = motion.len() as f64;
    let mean = motion.iter().map(|v| v.as_dvec3()).sum::<DVec3>() / count;
    (motion.iter().map(|v| (v.as_dvec3() - mean).length_squared()).sum::<f64>() / count).sqrt()
}
