//! Interpolation between the samples of a regular axis.

use std::ops::{Add, Mul, Sub};

/// Weights of the samples at -1, 0, 1 and 2 in the Catmull-Rom spline, for the place t in \[0, 1\]: it passes through the
/// samples, with a continuous slope.
pub(crate) fn catmull_rom<T>(t: T) -> [T; 4]
where
    T: Copy + From<f32> + Add<Output = T> + Sub<Output = T> + Mul<Output = T>,
{
    let n = |number: f32| T::from(number);
    [
        ((n(2.0) - t) * t - n(1.0)) * t,
        (n(3.0) * t - n(5.0)) * t * t + n(2.0),
        ((n(4.0) - n(3.0) * t) * t + n(1.0)) * t,
        (t - n(1.0)) * t * t,
    ]
    .map(|weight| n(0.5) * weight)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parabola_is_reproduced() {
        // Slopes are central differences, exact for parabolas.
        for step in 0..=10 {
            let t = step as f32 / 10.0;
            let weights = catmull_rom(t);
            let value: f32 = (0..4).map(|tap| weights[tap] * (tap as f32 - 1.0).powi(2)).sum();
            assert!((value - t * t).abs() < 1e-6);
        }
    }

    #[test]
    fn samples_are_passed_through() {
        assert_eq!(catmull_rom(0.0_f32), [0.0, 1.0, 0.0, 0.0]);
        assert_eq!(catmull_rom(1.0_f64), [0.0, 0.0, 1.0, 0.0]);
    }
}
