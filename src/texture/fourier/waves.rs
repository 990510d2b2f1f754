//! The sums of waves that a Fourier texture is made of.

use std::f32::consts::{FRAC_1_SQRT_2, FRAC_PI_2, PI, TAU};

use bevy::math::{Vec2, Vec3};
use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};

use super::{
    settings::{Combination, FourierTexture},
    threshold::threshold_above,
};
use crate::{sequence::r2, setting::SettingError};

/// Samples from which thresholds are read.
const SAMPLES: usize = 8192;
/// Where those samples lie if the texture does not tile, in periods of its first term: enough to be typical.
const SAMPLED_PERIODS: f32 = 8.0;

/// One term of both series.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Wave {
    frequency_rad: f32,
    /// Frequency of the term below, by which its phase is disturbed.
    below_rad: f32,
    amplitude: f32,
    phases_rad: Vec2,
}

/// The waves of a [`FourierTexture`].
#[derive(Clone, Debug, PartialEq)]
pub struct FourierWaves {
    settings: FourierTexture,
    waves: Vec<Wave>,
    /// Sum of the amplitudes.
    total: f32,
}

impl FourierWaves {
    /// Value at a place in the plane, 0 to 1. Places should be within some thousand units, beyond which single
    /// precision blurs the highest frequencies.
    #[must_use]
    pub fn at(&self, place: Vec2) -> f32 {
        self.at_solid(place.extend(0.0))
    }

    /// Value at a place in space, 0 to 1 (Gardner 1985). Only x and y tile.
    #[must_use]
    pub fn at_solid(&self, place: Vec3) -> f32 {
        let (mut along_x, mut along_y) = (0.0, 0.0);
        let (coupling, offset) = (self.settings.coupling, self.settings.offset);
        for wave in &self.waves {
            let depth = coupling * PI * (0.5 * wave.frequency_rad * place.z).sin();
            let disturbed = |across: f32| coupling * FRAC_PI_2 * (wave.below_rad * across).sin() + depth;
            let phase_x = wave.frequency_rad * place.x + wave.phases_rad.x + disturbed(place.y);
            let phase_y = wave.frequency_rad * place.y + wave.phases_rad.y + disturbed(place.x);
            along_x += wave.amplitude * (phase_x.cos() + offset);
            along_y += wave.amplitude * (phase_y.cos() + offset);
        }
        let (low, high) = self.bounds();
        ((self.combine(along_x, along_y) - low) / (high - low)).clamp(0.0, 1.0)
    }

    /// The value above which `share` (0 to 1) of the texture lies: measured all over the unit square if it tiles, and
    /// over eight of its longest periods if not. Shares of 0 and 1 give the greatest and least measured values.
    #[must_use]
    pub fn threshold_above(&self, share: f32) -> f32 {
        let side = if self.settings.tiles { 1.0 } else { SAMPLED_PERIODS * TAU / self.settings.first_frequency_rad };
        let even = |index: usize| side * Vec2::from(r2([0.0; 2], index));
        threshold_above((0..SAMPLES).map(|index| self.at(even(index))).collect(), share)
    }

    fn combine(&self, along_x: f32, along_y: f32) -> f32 {
        match self.settings.combination {
            Combination::Product => along_x * along_y,
            Combination::Sum => along_x + along_y,
        }
    }

    /// What the combined series cannot pass.
    fn bounds(&self) -> (f32, f32) {
        let (low, high) = (self.total * (self.settings.offset - 1.0), self.total * (self.settings.offset + 1.0));
        match self.settings.combination {
            // With an offset below 1 a series may be negative: the least product is that of the two extremes.
            Combination::Product => (low * if low < 0.0 { high } else { low }, high * high),
            Combination::Sum => (2.0 * low, 2.0 * high),
        }
    }
}

impl FourierTexture {
    /// The waves of this texture, ready to be summed.
    ///
    /// # Errors
    /// Those of [`validate`](Self::validate).
    pub fn waves(&self) -> Result<FourierWaves, SettingError> {
        self.validate()?;
        let mut random = Xoshiro256PlusPlus::seed_from_u64(self.seed);
        let mut frequency_rad = self.first_frequency_rad;
        if self.tiles {
            frequency_rad = TAU * (frequency_rad / TAU).round().max(1.0);
        }
        let mut amplitude = self.first_amplitude;
        let mut below_rad = frequency_rad;
        let mut waves = Vec::with_capacity(self.terms as usize);
        for _ in 0..self.terms {
            let phases_rad = Vec2::new(random.random_range(0.0..TAU), random.random_range(0.0..TAU));
            waves.push(Wave { frequency_rad, below_rad, amplitude, phases_rad });
            below_rad = frequency_rad;
            frequency_rad *= 2.0;
            amplitude *= FRAC_1_SQRT_2;
        }
        let total = waves.iter().map(|wave| wave.amplitude).sum();
        Ok(FourierWaves { settings: *self, waves, total })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::texture::fourier::settings::TERMS_LIMIT;
    use proptest::prelude::*;
    use rustfft::{FftPlanner, num_complex::Complex};

    const SIDE: usize = 256;

    fn texture(combination: Combination, coupling: f32) -> FourierTexture {
        FourierTexture { combination, coupling, tiles: true, ..FourierTexture::default() }
    }

    /// Slow oracle in double precision, straight from the formulas: frequencies and amplitudes as powers.
    fn slow(settings: &FourierTexture, waves: &FourierWaves, x: f64, y: f64, z: f64) -> f64 {
        let (k, a) = (f64::from(settings.coupling), f64::from(settings.offset));
        let turns = (f64::from(settings.first_frequency_rad) / f64::from(TAU)).round().max(1.0);
        let w0 = if settings.tiles { f64::from(TAU) * turns } else { f64::from(settings.first_frequency_rad) };
        let pi = std::f64::consts::PI;
        let (mut sum_x, mut sum_y, mut c_total) = (0.0, 0.0, 0.0);
        for (i, wave) in waves.waves.iter().enumerate() {
            let w = w0 * 2.0_f64.powi(i as i32);
            let below = w0 * 2.0_f64.powi((i as i32 - 1).max(0));
            let c = f64::from(settings.first_amplitude) * 0.5_f64.powf(0.5 * i as f64);
            let [p, q] = [f64::from(wave.phases_rad.x), f64::from(wave.phases_rad.y)];
            let depth = k * pi * (0.5 * w * z).sin();
            sum_x += c * ((w * x + p + k * pi / 2.0 * (below * y).sin() + depth).cos() + a);
            sum_y += c * ((w * y + q + k * pi / 2.0 * (below * x).sin() + depth).cos() + a);
            c_total += c;
        }
        let ends = [c_total * (a - 1.0), c_total * (a + 1.0)];
        let combine = |x: f64, y: f64| match settings.combination {
            Combination::Product => x * y,
            Combination::Sum => x + y,
        };
        let corners = ends.iter().flat_map(|&x| ends.iter().map(move |&y| combine(x, y)));
        let (low, high) = corners.fold((f64::MAX, f64::MIN), |(low, high), v| (low.min(v), high.max(v)));
        (combine(sum_x, sum_y) - low) / (high - low)
    }

    fn combinations() -> impl Strategy<Value = Combination> {
        prop_oneof![Just(Combination::Product), Just(Combination::Sum)]
    }

    prop_compose! {
        fn settings()(
            terms in 1_u32..=8,
            (first_frequency_rad, first_amplitude) in (0.1_f32..40.0, 0.01_f32..50.0),
            (offset, coupling) in (0.0_f32..3.0, 0.0_f32..=1.5),
            combination in combinations(),
            (tiles, seed) in (any::<bool>(), any::<u64>()),
        ) -> FourierTexture {
            FourierTexture { terms, first_frequency_rad, first_amplitude, offset, coupling, combination, tiles, seed }
        }
    }

    proptest! {
        #[test]
        fn values_equal_the_sum_of_the_waves(
            settings in settings(), x in -1.0_f32..1.0, y in -1.0_f32..1.0, z in -1.0_f32..1.0,
        ) {
            let waves = settings.waves().unwrap();
            let value = waves.at_solid(Vec3::new(x, y, z));
            let expected = slow(&settings, &waves, f64::from(x), f64::from(y), f64::from(z));
            // The highest phase here is some 5000 rad, which single precision holds to 2.5e-4 (5e-4 with its
            // couplings).
            prop_assert!((0.0..=1.0).contains(&value));
            prop_assert!((f64::from(value) - expected).abs() < 1e-3, "{value} against {expected}");
        }

        #[test]
        fn valid_extremes_stay_finite(
            terms in prop_oneof![Just(1_u32), Just(TERMS_LIMIT)],
            w in prop_oneof![Just(0.01_f32), Just(1000.0_f32)],
            c in prop_oneof![Just(0.001_f32), Just(1000.0_f32)],
            a in prop_oneof![Just(0.0_f32), Just(1.0_f32), Just(100.0_f32)],
            combination in combinations(),
        ) {
            let settings = FourierTexture {
                terms, first_frequency_rad: w, first_amplitude: c, offset: a, combination, ..FourierTexture::default()
            };
            let waves = settings.waves().unwrap();
            for place in [Vec2::ZERO, Vec2::new(0.3, -0.8), Vec2::splat(1e3)] {
                prop_assert!((0.0..=1.0).contains(&waves.at(place)));
            }
        }
    }

    #[test]
    fn peaks_double_in_frequency_and_fall_by_the_root_of_two() {
        let waves = texture(Combination::Sum, 0.0).waves().unwrap();
        // Uncoupled, a row is the series of x and a constant. 12 rad are 1.9 periods in the unit square, rounded to 2.
        let mut row: Vec<Complex<f32>> =
            (0..SIDE).map(|x| Complex::new(waves.at(Vec2::new(x as f32 / SIDE as f32, 0.37)), 0.0)).collect();
        FftPlanner::new().plan_fft_forward(SIDE).process(&mut row);
        let peaks: Vec<usize> = (1..SIDE / 2).filter(|&k| row[k].norm() > 0.01 * row[2].norm()).collect();
        assert_eq!(peaks, [2, 4, 8, 16, 32, 64]);
        for pair in peaks.windows(2) {
            let fall = row[pair[1]].norm() / row[pair[0]].norm();
            assert!((fall - FRAC_1_SQRT_2).abs() < 1e-3, "{fall}");
        }
    }

    #[test]
    fn tiling_textures_have_no_seam() {
        for combination in [Combination::Product, Combination::Sum] {
            let waves = texture(combination, 1.0).waves().unwrap();
            for step in 0..200 {
                let along = step as f32 / 200.0;
                let pairs = [(Vec2::new(0.0, along), Vec2::X), (Vec2::new(along, 0.0), Vec2::Y)];
                for (place, period) in pairs {
                    assert!((waves.at(place) - waves.at(place + period)).abs() < 1e-3, "{place}");
                }
            }
        }
        let open = FourierTexture { tiles: false, ..texture(Combination::Sum, 1.0) }.waves().unwrap();
        assert!(
            (0..20)
                .any(|y| (open.at(Vec2::new(0.0, 0.05 * y as f32)) - open.at(Vec2::new(1.0, 0.05 * y as f32))).abs()
                    > 0.1)
        );
    }

    /// Uncoupled cosines over whole periods have the mean 0 and the variance c^2/2, and x and y are independent.
    #[test]
    fn mean_and_variance_are_those_of_the_closed_form() {
        let settings = texture(Combination::Sum, 0.0);
        let waves = settings.waves().unwrap();
        let count = (SIDE * SIDE) as f64;
        let values: Vec<f64> = (0..SIDE * SIDE)
            .map(|index| Vec2::new((index % SIDE) as f32, (index / SIDE) as f32) / SIDE as f32)
            .map(|place| f64::from(waves.at(place)))
            .collect();
        let mean = values.iter().sum::<f64>() / count;
        let variance = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / count;
        // X + Y has the variance sum c^2, over the range 4 C.
        let amplitudes: Vec<f64> = (0..6).map(|i| 0.5_f64.powf(0.5 * f64::from(i))).collect();
        let (squares, total) = (amplitudes.iter().map(|c| c * c).sum::<f64>(), amplitudes.iter().sum::<f64>());
        assert!((mean - 0.5).abs() < 1e-4, "{mean}");
        assert!((variance / (squares / (16.0 * total * total)) - 1.0).abs() < 1e-3, "{variance}");
    }

    #[test]
    fn a_threshold_leaves_the_share_that_was_asked_for() {
        for combination in [Combination::Product, Combination::Sum] {
            for tiles in [true, false] {
                let waves = FourierTexture { tiles, ..texture(combination, 1.0) }.waves().unwrap();
                for share in [0.1, 0.5, 0.8] {
                    let threshold = waves.threshold_above(share);
                    // A fine grid, other places than it was measured at.
                    let side = if tiles { 1.0 } else { SAMPLED_PERIODS * TAU / 12.0 };
                    let place = |n: usize| Vec2::new((n % 331) as f32, (n / 331) as f32) * (side / 331.0);
                    let above = (0..331 * 331).filter(|&n| waves.at(place(n)) > threshold).count() as f32;
                    let measured = above / (331.0 * 331.0);
                    assert!((measured - share).abs() < 0.02, "{combination:?} {tiles}: {measured} against {share}");
                }
            }
        }
        assert_eq!(threshold_above(Vec::new(), 0.5), 0.0);
    }

    #[test]
    fn the_same_seed_gives_the_same_texture() {
        let other = FourierTexture { seed: 1, ..FourierTexture::default() };
        assert_eq!(other.waves().unwrap(), other.waves().unwrap());
        assert_ne!(other.waves().unwrap().at(Vec2::ONE), FourierTexture::default().waves().unwrap().at(Vec2::ONE));
    }

    #[test]
    fn a_bad_field_is_named() {
        let broken = FourierTexture { first_frequency_rad: f32::NAN, ..FourierTexture::default() };
        let message = broken.waves().unwrap_err().to_string();
        assert_eq!(message, "`first_frequency_rad` is NaN, but must be 0.01 to 1000");
        assert!(FourierTexture { terms: 13, ..FourierTexture::default() }.validate().is_err());
    }
}
