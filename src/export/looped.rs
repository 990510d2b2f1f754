//! A loop without a seam out of a stretch of a series.
//!
//! Of the stretch `x` from `-F` to `N`, the loop is `x` from 0 to `N`, whose last `F` samples go over into the `F` before the first: at `N`
//! it is where it began, with the same velocity. Deviations `d` from the mean are added with the weights `a` and `b`, `a² + b² = 1`, so
//! that the sway keeps its power where the two stretches do not know of each other:
//!
//! ```text
//! y(k) = mean + a d(k) + b d(k - N),   a = cos(pi/2 S(u)),  b = sin(pi/2 S(u)),   u = (k - (N - F)) / F
//! ```

use bevy::math::{FloatExt, Vec3A};
use std::f32::consts::FRAC_PI_2;

/// The loop of the vectors of a stretch: `before` of its samples come before the first of the loop, and become the end of it. All samples
/// have as many vectors as the first.
pub(super) fn looped(stretch: &[Vec<Vec3A>], before: usize) -> Vec<Vec<Vec3A>> {
    let before = before.min(stretch.len() / 2);
    let (early, samples) = stretch.split_at(before);
    let mut looped = samples.to_vec();
    let mean = mean(stretch);
    let first_faded = looped.len() - before;
    for (step, (sample, early)) in looped[first_faded..].iter_mut().zip(early).enumerate() {
        let (b, a) = (FRAC_PI_2 * (step as f32 / before as f32).smoothstep(0.0, 1.0)).sin_cos();
        for ((value, early), mean) in sample.iter_mut().zip(early).zip(&mean) {
            *value = *mean + a * (*value - *mean) + b * (*early - *mean);
        }
    }
    looped
}

fn mean(stretch: &[Vec<Vec3A>]) -> Vec<Vec3A> {
    let share = 1.0 / stretch.len().max(1) as f32;
    let mut mean = vec![Vec3A::ZERO; stretch.first().map_or(0, Vec::len)];
    for sample in stretch {
        mean.iter_mut().zip(sample).for_each(|(mean, value)| *mean += *value * share);
    }
    mean
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};

    /// Smooth noise: what oscillators of random phase add up to.
    fn noise(samples: usize, seed: u64) -> Vec<Vec<Vec3A>> {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
        let waves: Vec<(f32, f32)> =
            (0..40).map(|_| (random.random_range(0.02..0.3), random.random_range(0.0..7.0))).collect();
        let value = |k: usize| waves.iter().map(|(step, phase)| (step * k as f32 + phase).sin()).sum::<f32>();
        (0..samples).map(|k| vec![Vec3A::new(3.0 + value(k), 0.0, 0.0)]).collect()
    }

    #[test]
    fn a_loop_closes_in_place_and_velocity() {
        let (before, count) = (90, 480);
        let stretch = noise(before + count, 1);
        let looped = looped(&stretch, before);
        assert_eq!(looped.len(), count);
        assert_eq!(looped[..count - before], stretch[before..count]);
        let x = |k: usize| looped[k % count][0].x;
        // Across the seam the second difference is no greater than anywhere else.
        let bend = |k: usize| (x(k + 1) - 2.0 * x(k) + x(k + count - 1)).abs();
        let greatest = (1..count - before - 1).map(bend).fold(0.0, f32::max);
        assert!([count - 2, count - 1, count].into_iter().all(|k| bend(k) < greatest), "a kink at the seam");
    }

    #[test]
    fn the_end_keeps_the_power_of_the_sway() {
        let (before, count) = (90, 480);
        let mut powers = [0.0, 0.0];
        for seed in 0..400 {
            let looped = looped(&noise(before + count, seed), before);
            let power = |k: usize| f64::from(looped[k][0].x - 3.0).powi(2);
            powers[0] += power(count / 2);
            powers[1] += power(count - before / 2);
        }
        // 400 squares of normal variables have a mean within 7% in two of three cases.
        assert!((powers[1] / powers[0] - 1.0).abs() < 0.25, "{powers:?}");
    }

    #[test]
    fn a_series_that_is_periodic_by_itself_stays_as_it_is() {
        let stretch: Vec<Vec<Vec3A>> = (0..64).map(|k| vec![Vec3A::splat((k % 32) as f32)]).collect();
        assert_eq!(looped(&stretch, 0), stretch);
    }
}
