use super::{
    super::settings::{FieldResolution, TurbulenceBand},
    *,
};
use approx::assert_relative_eq;
use bevy::tasks::TaskPoolBuilder;

fn small_settings() -> FieldSettings {
    let resolution = FieldResolution { time_samples: 256, columns: 6, levels: 4, ..Default::default() };
    FieldSettings { resolution, ..Default::default() }
}

fn profile(settings: &FieldSettings) -> LogProfile {
    LogProfile::from_reference(settings.speed, settings.roughness_m, settings.displacement_m)
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
    let term = |(time, velocity): (usize, &Vec3A)| Complex::from_polar(f64::from(velocity[axis]), -turn * time as f64);
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
fn transform_to_time_is_the_real_part_of_the_sum_of_waves() {
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
fn bands_have_the_resolved_or_the_whole_variance() {
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
