//! The flicker of a fire: its brightness at any moment. `shaders/fire.wesl` has the same formula.
//!
//! A sum of three sines whose frequencies have no simple ratio, so that it does not look periodic; whole cycles in the
//! period [`FLUTTER_PERIOD_S`] of all periodic motion here, so that it never jumps:
//!
//! ```text
//! level = 1 + depth sum_j w_j sin 2 pi (m_j t / period + phase_j),   sum_j w_j = 1
//! ```

use crate::sway::FLUTTER_PERIOD_S;
use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};
use std::f64::consts::TAU;

/// Frequencies of the sines, relative to the fire's: slow changes of the whole, its puffs, single tongues.
const RATIOS: [f32; 3] = [0.382, 1.0, 4.236];
/// Their weights.
pub const WEIGHTS: [f32; 3] = [0.3, 0.45, 0.25];

/// The flicker of one fire.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flicker {
    /// Whole cycles of each sine in the period.
    pub cycles: [f32; 3],
    /// Phase of each, in turns.
    pub phases: [f32; 3],
    /// Largest deviation from the mean, 0 to 1.
    pub depth: f32,
}

impl Flicker {
    /// The flicker of a fire, with a mean frequency of `rate_hz`.
    pub(super) fn new(rate_hz: f32, depth: f32, seed: u64) -> Self {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
        Self {
            cycles: RATIOS.map(|ratio| (ratio * rate_hz * FLUTTER_PERIOD_S as f32).round()),
            phases: RATIOS.map(|_| random.random()),
            depth,
        }
    }

    /// Brightness at a moment, as a share of the mean: 1 - depth to 1 + depth.
    pub fn level(&self, time_s: f64) -> f32 {
        let share = time_s.rem_euclid(FLUTTER_PERIOD_S) / FLUTTER_PERIOD_S;
        let sines = self.cycles.iter().zip(self.phases).zip(WEIGHTS).map(|((cycles, phase), weight)| {
            let turns = (f64::from(*cycles) * share + f64::from(phase)).fract();
            weight * (TAU * turns).sin() as f32
        });
        1.0 + self.depth * sines.sum::<f32>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn levels(flicker: &Flicker) -> Vec<f32> {
        (0..12_800).map(|k| flicker.level(f64::from(k) * 0.01)).collect()
    }

    #[test]
    fn level_stays_within_its_depth_and_has_the_mean_1() {
        for seed in 0..5 {
            let levels = levels(&Flicker::new(1.7, 0.3, seed));
            assert!(levels.iter().all(|level| (0.7..=1.3).contains(level)));
            let mean = levels.iter().sum::<f32>() / levels.len() as f32;
            // Whole cycles in the period: the mean is exact but for rounding.
            assert!((mean - 1.0).abs() < 1e-4, "{mean}");
            let variance = levels.iter().map(|level| (level - 1.0).powi(2)).sum::<f32>() / levels.len() as f32;
            // Half the sum of the squares of the amplitudes.
            let expected = 0.5 * WEIGHTS.iter().map(|weight| (0.3 * weight).powi(2)).sum::<f32>();
            assert!((variance / expected - 1.0).abs() < 1e-2, "{variance} {expected}");
        }
    }

    #[test]
    fn level_is_a_continuous_function_of_time_and_seed() {
        let flicker = Flicker::new(1.7, 0.3, 1);
        assert_eq!(flicker, Flicker::new(1.7, 0.3, 1));
        assert_ne!(flicker.level(3.0), Flicker::new(1.7, 0.3, 2).level(3.0));
        let across = [FLUTTER_PERIOD_S - 1e-4, FLUTTER_PERIOD_S + 1e-4].map(|time_s| flicker.level(time_s));
        assert!((across[0] - across[1]).abs() < 1e-2);
        assert!((flicker.level(5.0) - flicker.level(5.0 + 1000.0 * FLUTTER_PERIOD_S)).abs() < 1e-4);
    }
}
