//! One realisation of the turbulence with given spectra and cross-spectra (Setas et al., algorithm 3, corrected).
//!
//! ```text
//! a(f, y, z) = sqrt(2 S(f, z) df) sum_k e^(i k y) sum_j L_k(z, j) e^(i phi)     phi independent, uniform
//! u(t, y, z) = Re sum_f a(f, y, z) e^(2 pi i f t)
//! ```
//!
//! L_k are the factors of the coherence (see `coherence`): |L_k| is the square root of the transformed cross-spectrum,
//! which the paper's step 2 leaves out. Taking the real part of a sum over positive frequencies is the same as the
//! conjugate symmetry of equation 13 over *all* bins. The bin of frequency 0 is empty, because the mean is the
//! profile's; so is the one at half the sampling rate, where a sampled sine cannot be told from its phase.

use super::{
    FieldSettings, LogProfile, TurbulenceBand, TurbulenceComponent,
    coherence::{CoherenceFactors, CoherenceKernel, decay_times_s, exponentials},
    factorisation::packed_columns,
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

/// The amplitudes that the spectrum asks for.
struct BandSpectrum {
    /// sqrt(2 S df), m/s: \[bin\]\[level\].
    amplitudes: Vec<f32>,
    resolved_fraction: f32,
}

impl BandSpectrum {
    fn new(component: TurbulenceComponent, settings: &FieldSettings, profile: &LogProfile, grid: &Grid) -> Self {
        let mut amplitudes = vec![0.0; grid.bins() * grid.levels];
        let friction_velocity_m_s = f64::from(profile.friction_velocity_m_s);
        let variance = component.variance_factor() * friction_velocity_m_s.powi(2);
        let mut fractions = 0.0;
        for level in 0..grid.levels {
            let (height_m, mean_speed_m_s) = profile.turbulence_scales(settings.resolution.level_height_m(level));
            let bin_variance = |bin| {
                let density = component.power_spectral_density(
                    grid.frequency_hz(bin),
                    f64::from(height_m),
                    f64::from(mean_speed_m_s),
                    friction_velocity_m_s,
                );
                density * grid.frequency_step_hz
            };
            let fraction = (0..grid.bins()).map(bin_variance).sum::<f64>() / variance;
            fractions += fraction;
            let factor = f64::from(settings.gustiness) * band_factor(settings.band, fraction);
            for bin in 0..grid.bins() {
                amplitudes[bin * grid.levels + level] = (factor * (2.0 * bin_variance(bin)).sqrt()) as f32;
            }
        }
        Self { amplitudes, resolved_fraction: (fractions / grid.levels as f64) as f32 }
    }
}

/// The factor on all amplitudes of a level whose band holds `fraction` > 0 of the variance.
fn band_factor(band: TurbulenceBand, fraction: f64) -> f64 {
    match band {
        TurbulenceBand::TrueSpectrum => 1.0,
        TurbulenceBand::TrueVariance => fraction.sqrt().recip(),
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

/// sum_j L_k(z, j) e^(i phi) for each wavenumber k and level z: \[level\]\[wavenumber\].
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

/// Re sum_f a e^(2 pi i f t) of every column and level, into one component of the velocities.
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
mod tests {
    use super::*;
    use crate::wind::FieldResolution;
    use approx::assert_relative_eq;
    use bevy::tasks::TaskPoolBuilder;

    fn small_settings() -> FieldSettings {
        let resolution = FieldResolution { time_samples: 256, columns: 6, levels: 4, ..Default::default() };
        FieldSettings { resolution, ..Default::default() }
    }

    fn profile(settings: &FieldSettings) -> LogProfile {
        LogProfile::from_reference(settings.mean_speed_m_s, settings.roughness_length_m, settings.displacement_height_m)
    }

    fn realise(settings: &FieldSettings) -> Turbulence {
        synthesise(settings, &profile(settings), None)
    }

    fn ensemble(seeds: u64, settings: &FieldSettings) -> impl Iterator<Item = Turbulence> {
        (0..seeds).map(|seed| realise(&FieldSettings { seed, ..settings.clone() }))
    }

    /// One bin of the discrete Fourier transform, by its definition.
    fn bin_of(series: &[Vec3A], axis: usize, bin: usize) -> Complex<f64> {
        let turn = std::f64::consts::TAU * bin as f64 / series.len() as f64;
        let term =
            |(time, velocity): (usize, &Vec3A)| Complex::from_polar(f64::from(velocity[axis]), -turn * time as f64);
        series.iter().enumerate().map(term).sum()
    }

    #[test]
    fn the_same_seed_gives_the_same_bits_on_any_number_of_threads() {
        let settings = small_settings();
        let serial = realise(&settings);
        assert_eq!(serial.velocities, realise(&settings).velocities);
        for threads in [1, 3] {
            let pool = TaskPoolBuilder::new().num_threads(threads).build();
            assert_eq!(serial.velocities, synthesise(&settings, &profile(&settings), Some(&pool)).velocities);
        }
        let other = realise(&FieldSettings { seed: 1, ..settings });
        assert_ne!(serial.velocities, other.velocities);
    }

    #[test]
    fn the_transform_to_time_is_the_real_part_of_the_sum_of_waves() {
        let grid = Grid { time_samples: 16, columns: 3, levels: 2, frequency_step_hz: 1.0 };
        let amplitudes: Vec<Complex<f32>> = (0..grid.bins() * grid.plane())
            .map(|index| Complex::from_polar(1.0 + index as f32 % 5.0, index as f32))
            .collect();
        let mut velocities = vec![Vec3A::ZERO; grid.plane() * grid.time_samples];
        transform_to_time(&amplitudes, 1, &grid, &mut velocities, None);
        for (index, velocity) in velocities.iter().enumerate() {
            let (series, time) = (index / grid.time_samples, index % grid.time_samples);
            let (column, level) = (series / grid.levels, series % grid.levels);
            let wave = |bin: usize| {
                let amplitude = amplitudes[bin * grid.plane() + level * grid.columns + column];
                (amplitude * Complex::from_polar(1.0, TAU * ((bin + 1) * time) as f32 / 16.0)).re
            };
            // Seven waves of amplitudes up to 5 in f32.
            assert_relative_eq!(velocity.y, (0..grid.bins()).map(wave).sum::<f32>(), epsilon = 1e-4);
        }
    }

    #[test]
    fn each_frequency_has_its_power_and_its_coherence() {
        const SEEDS: u64 = 200;
        let settings = small_settings();
        let profile = profile(&settings);
        let grid = Grid::new(&settings);
        let resolution = &settings.resolution;
        let bins = 12..24;
        for component in TurbulenceComponent::ALL {
            let axis = component.axis();
            // Level 0 at a column, level 2 at the next column.
            let [mut power, mut power_aside, mut cross] = [0.0; 3];
            for turbulence in ensemble(SEEDS, &settings) {
                let series: Vec<&[Vec3A]> = turbulence.velocities.chunks_exact(grid.time_samples).collect();
                for column in 0..grid.columns {
                    let aside = (column + 1) % grid.columns;
                    for bin in bins.clone() {
                        let here = bin_of(series[column * grid.levels], axis, bin);
                        let there = bin_of(series[aside * grid.levels + 2], axis, bin);
                        power += here.norm_sqr();
                        power_aside += there.norm_sqr();
                        cross += (here * there.conj()).re;
                    }
                }
            }
            let count = (SEEDS as usize * grid.columns * bins.len()) as f64;
            let periodogram = 2.0 * f64::from(resolution.time_step_s) / grid.time_samples as f64 / count;
            let mean_over_bins = |value: &dyn Fn(f64) -> f64| {
                let frequencies = bins.clone().map(|bin| bin as f64 * grid.frequency_step_hz);
                frequencies.map(value).sum::<f64>() / bins.len() as f64
            };
            let scales = [2.5, 7.5].map(|height| profile.turbulence_scales(height));
            let friction = f64::from(profile.friction_velocity_m_s);
            let density = mean_over_bins(&|frequency_hz| {
                component.power_spectral_density(frequency_hz, 2.5, f64::from(scales[0].1), friction)
            });
            // 200 x 12 independent estimates, and more where columns differ: a scatter below 2%.
            assert_relative_eq!(power * periodogram, density, max_relative = 0.05);
            let speed = 0.5 * f64::from(scales[0].1 + scales[1].1);
            let decay = settings.coherence.of(component);
            let coherence = mean_over_bins(&|frequency_hz| decay.root_coherence(frequency_hz, 8.0, 5.0, speed));
            // The scatter of a correlation of that many estimates is below 0.015.
            assert_relative_eq!(cross / (power * power_aside).sqrt(), coherence, epsilon = 0.04);
        }
    }

    #[test]
    fn the_two_bands_hold_the_resolved_and_the_whole_variance() {
        let spectrum = small_settings();
        let whole = FieldSettings { band: TurbulenceBand::TrueVariance, ..small_settings() };
        let friction = f64::from(profile(&spectrum).friction_velocity_m_s);
        for component in TurbulenceComponent::ALL {
            let variance = |settings| {
                let power = |turbulence: Turbulence| {
                    let squares =
                        turbulence.velocities.iter().map(|velocity| f64::from(velocity[component.axis()]).powi(2));
                    squares.sum::<f64>() / turbulence.velocities.len() as f64
                };
                ensemble(50, settings).map(power).sum::<f64>() / 50.0
            };
            let total = component.variance_factor() * friction * friction;
            let index = TurbulenceComponent::ALL.iter().position(|&other| other == component).unwrap();
            let resolved = f64::from(realise(&spectrum).resolved_fraction[index]);
            assert!((0.3..0.95).contains(&resolved));
            // The slowest bins dominate and hardly scatter where all columns move as one: 1 to 2% over 50 fields.
            assert_relative_eq!(variance(&spectrum), resolved * total, max_relative = 0.05);
            assert_relative_eq!(variance(&whole), total, max_relative = 0.05);
        }
    }

    #[test]
    fn gustiness_is_a_factor_on_the_turbulence() {
        let plain = realise(&small_settings());
        let doubled = realise(&FieldSettings { gustiness: 2.0, ..small_settings() });
        for (plain, doubled) in plain.velocities.iter().zip(&doubled.velocities) {
            // A power of two scales every rounding with it, but for the root that makes the amplitude.
            assert!((2.0 * *plain).abs_diff_eq(*doubled, 1e-4));
        }
    }
}
