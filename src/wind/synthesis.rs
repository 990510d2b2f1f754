//! One realisation of the turbulence with given spectra and cross-spectra (Setas et al., algorithm 3, corrected).
//!
//! ```text
//! a(f, y, z) = sqrt(2 S(f, z) df) sum_k e^(i k y) sum_j L_k(z, j) e^(i phi)     phi independent, uniform
//! u(t, y, z) = Re sum_f a(f, y, z) e^(2 pi i f t)
//! ```
//!
//! `L_k` are the factors of the coherence (see `coherence`): `|L_k|` is the square root of the transformed
//! cross-spectrum, which the paper's step 2 leaves out. Taking the real part of a sum over positive frequencies is the
//! same as the conjugate symmetry of equation 13 over *all* bins. The bin of frequency 0 is empty, because the mean is
//! the profile's; so is the one at half the sampling rate, where a sampled sine cannot be told from its phase.

use super::{
    coherence::{CoherenceFactors, CoherenceKernel, decay_times_s, exponentials},
    factorisation::packed_columns,
    level_spectrum::LevelSpectrum,
    profile::LogProfile,
    settings::FieldSettings,
    spectrum::TurbulenceComponent,
};
use bevy::{
    math::Vec3A,
    tasks::{ParallelSliceMut, TaskPool},
};
use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};
use rustfft::{Fft, FftPlanner, num_complex::Complex};
use std::{f32::consts::TAU, sync::Arc};

/// Bins that one task computes: enough to pay for its exponentials, few enough to share the work. The result does not
/// depend on it but for the last bits of the coherence, and not on the number of threads at all.
const BINS_PER_TASK: usize = 32;

/// A realisation of the turbulence.
pub(super) struct Turbulence {
    /// Velocities (along, up, across), m/s: \[column\]\[level\]\[time\].
    pub velocities: Vec<Vec3A>,
    /// How much of the variance of u, v and w the field's band holds, mean over the levels.
    pub resolved_fraction: [f32; 3],
}

/// Draws the turbulence that `settings`, which must be valid, and `profile` describe; on all threads of `pool`, if any.
pub(super) fn synthesise(settings: &FieldSettings, profile: &LogProfile, pool: Option<&TaskPool>) -> Turbulence {
    let grid = Grid::new(settings);
    let mut velocities = vec![Vec3A::ZERO; grid.columns * grid.levels * grid.time_samples];
    if profile.friction_velocity_m_s == 0.0 {
        return Turbulence { velocities, resolved_fraction: [0.0; 3] };
    }
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(settings.seed);
    let resolved_fraction = TurbulenceComponent::ALL.map(|component| {
        let bin_seeds: Vec<u64> = (0..grid.bins()).map(|_| rng.random()).collect();
        let spectrum = BandSpectrum::new(component, settings, profile, &grid);
        let mut amplitudes = coherent_amplitudes(component, settings, profile, &grid, &bin_seeds, pool);
        scale_to_spectrum(&mut amplitudes, &spectrum, &grid);
        transform_to_time(&amplitudes, component.axis(), &grid, &mut velocities, pool);
        spectrum.resolved_fraction
    });
    Turbulence { velocities, resolved_fraction }
}

/// The counts of a field.
struct Grid {
    time_samples: usize,
    columns: usize,
    levels: usize,
    frequency_step_hz: f64,
}

impl Grid {
    fn new(settings: &FieldSettings) -> Self {
        let resolution = &settings.resolution;
        Self {
            time_samples: resolution.time_samples as usize,
            columns: resolution.columns as usize,
            levels: resolution.levels as usize,
            frequency_step_hz: resolution.period_s().recip(),
        }
    }

    /// Bins that carry turbulence: those between 0 and half the sampling rate.
    fn bins(&self) -> usize {
        self.time_samples / 2 - 1
    }

    fn frequency_hz(&self, bin: usize) -> f64 {
        (bin + 1) as f64 * self.frequency_step_hz
    }

    /// Amplitudes of one bin.
    fn plane(&self) -> usize {
        self.columns * self.levels
    }
}

/// The amplitudes of the spectrum.
struct BandSpectrum {
    /// sqrt(2 S df), m/s: \[bin\]\[level\].
    amplitudes: Vec<f32>,
    resolved_fraction: f32,
}

impl BandSpectrum {
    fn new(component: TurbulenceComponent, settings: &FieldSettings, profile: &LogProfile, grid: &Grid) -> Self {
        let mut amplitudes = vec![0.0; grid.bins() * grid.levels];
        let mut fractions = 0.0;
        for level in 0..grid.levels {
            let height_m = settings.resolution.level_height_m(level);
            let spectrum = LevelSpectrum::new(component, settings, profile, height_m);
            fractions += spectrum.resolved_fraction;
            for bin in 0..grid.bins() {
                let amplitude_m_s = spectrum.amplitude_m_s(grid.frequency_hz(bin), grid.frequency_step_hz);
                amplitudes[bin * grid.levels + level] = amplitude_m_s as f32;
            }
        }
        Self { amplitudes, resolved_fraction: (fractions / grid.levels as f64) as f32 }
    }
}

/// Random amplitudes of mean square 1 with the component's coherence: \[bin\]\[level\]\[column\].
fn coherent_amplitudes(
    component: TurbulenceComponent,
    settings: &FieldSettings,
    profile: &LogProfile,
    grid: &Grid,
    bin_seeds: &[u64],
    pool: Option<&TaskPool>,
) -> Vec<Complex<f32>> {
    let times_s = decay_times_s(&settings.resolution, profile, settings.coherence.of(component));
    let steps = exponentials(&times_s, grid.frequency_step_hz);
    let across: Arc<dyn Fft<f32>> = FftPlanner::new().plan_fft_inverse(grid.columns);
    let mut amplitudes = vec![Complex::ZERO; grid.bins() * grid.plane()];
    for_each_chunk(pool, &mut amplitudes, BINS_PER_TASK * grid.plane(), |task, planes| {
        let first_bin = task * BINS_PER_TASK;
        let mut kernel = CoherenceKernel::new(&times_s, grid.frequency_hz(first_bin), &steps);
        let mut factors = CoherenceFactors::new(grid.columns, grid.levels);
        for (plane, &seed) in planes.chunks_exact_mut(grid.plane()).zip(&bin_seeds[first_bin..]) {
            factors.factorise(&kernel);
            draw_amplitudes(plane, &factors, grid, &mut Xoshiro256PlusPlus::seed_from_u64(seed));
            across.process(plane);
            kernel.advance();
        }
    });
    amplitudes
}

/// `sum_j L_k(z, j) e^(i phi)` for each wavenumber k and level z: \[level\]\[wavenumber\].
fn draw_amplitudes(plane: &mut [Complex<f32>], factors: &CoherenceFactors, grid: &Grid, rng: &mut Xoshiro256PlusPlus) {
    for wavenumber in 0..grid.columns {
        let factor = factors.of_wavenumber(wavenumber);
        for (column, range) in packed_columns(grid.levels) {
            let (sin, cos) = (TAU * rng.random::<f32>()).sin_cos();
            let phase = Complex::new(cos, sin);
            for (level, &value) in (column..).zip(&factor[range]) {
                plane[level * grid.columns + wavenumber] += phase * value as f32;
            }
        }
    }
}

fn scale_to_spectrum(amplitudes: &mut [Complex<f32>], spectrum: &BandSpectrum, grid: &Grid) {
    for (row, amplitude) in amplitudes.chunks_exact_mut(grid.columns).zip(&spectrum.amplitudes) {
        row.iter_mut().for_each(|value| *value *= *amplitude);
    }
}

/// `Re sum_f a e^(2 pi i f t)` of every column and level, into one component of the velocities.
fn transform_to_time(
    amplitudes: &[Complex<f32>],
    axis: usize,
    grid: &Grid,
    velocities: &mut [Vec3A],
    pool: Option<&TaskPool>,
) {
    let to_time: Arc<dyn Fft<f32>> = FftPlanner::new().plan_fft_inverse(grid.time_samples);
    for_each_chunk(pool, velocities, grid.levels * grid.time_samples, |column, series_of_levels| {
        let mut series = vec![Complex::ZERO; grid.time_samples];
        let mut scratch = vec![Complex::ZERO; to_time.get_inplace_scratch_len()];
        for (level, velocities) in series_of_levels.chunks_exact_mut(grid.time_samples).enumerate() {
            series.fill(Complex::ZERO);
            let of_series = amplitudes[level * grid.columns + column..].iter().step_by(grid.plane());
            for (value, amplitude) in series[1..].iter_mut().zip(of_series) {
                *value = *amplitude;
            }
            to_time.process_with_scratch(&mut series, &mut scratch);
            for (velocity, value) in velocities.iter_mut().zip(&series) {
                velocity[axis] = value.re;
            }
        }
    });
}

/// Calls `work` with the index of each chunk and the chunk, on all threads of the pool where there is one.
fn for_each_chunk<T: Send>(
    pool: Option<&TaskPool>,
    mut values: &mut [T],
    chunk_size: usize,
    work: impl Fn(usize, &mut [T]) + Send + Sync,
) {
    match pool {
        Some(pool) => drop(values.par_chunk_map_mut(pool, chunk_size, work)),
        None => values.chunks_mut(chunk_size).enumerate().for_each(|(index, chunk)| work(index, chunk)),
    }
}

#[cfg(test)]
mod tests;
