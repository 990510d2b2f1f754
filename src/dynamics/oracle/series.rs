//! Series that the tests of oscillators share.

use std::f64::consts::TAU;

/// A load of a few harmonics of the period 1, sampled `count` times over `periods` periods.
pub fn load(count: usize, periods: usize) -> Vec<f64> {
    let value = |t: f64| (TAU * t).sin() + 0.5 * (TAU * 3.0 * t + 1.0).cos() + 0.2 * (TAU * 5.0 * t).sin() + 0.3;
    (0..count * periods).map(|index| value(index as f64 / count as f64)).collect()
}

pub fn relative_rms(values: &[f64], reference: &[f64]) -> f64 {
    let square = |series: &mut dyn Iterator<Item = f64>| series.map(|value| value * value).sum::<f64>();
    let error = square(&mut values.iter().zip(reference).map(|(a, b)| a - b));
    (error / square(&mut reference.iter().copied())).sqrt()
}
