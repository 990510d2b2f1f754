//! A turbulent wind at one point, in wind coordinates: the spectra of eq. 9, corrected, with random phases. It is written again here so
//! that checks do not depend on the code that they check.

use bevy::math::Vec3;
use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};
use rustfft::{FftPlanner, num_complex::Complex};
use std::{f64::consts::TAU, ops::Range};

pub const MEAN_SPEED_M_S: f64 = 8.0;
pub const TURBULENCE_INTENSITY: f64 = 0.2;
/// Step of the tables, s. Slow gusts have frequencies below half a cycle in it.
pub const TIME_STEP_S: f64 = 1.0 / 16.0;
/// At which the spectra are, m.
pub const HEIGHT_M: f64 = 10.0;
/// Where the gusts of a fine wind end, Hz.
const FASTEST_HZ: f64 = 24.0;

/// A period of `samples` steps of the tables, at `oversampling` times as many, with gusts of up to 8 Hz.
pub fn test_wind(seed: u64, samples: usize, oversampling: usize, intensity: f64) -> Vec<Vec3> {
    wind(seed, samples, oversampling, intensity, 1..samples / 2)
}

/// The same with gusts of up to 24 Hz.
pub fn fine_wind(seed: u64, samples: usize, oversampling: usize, intensity: f64) -> Vec<Vec3> {
    wind(seed, samples, oversampling, intensity, 1..(FASTEST_HZ * samples as f64 * TIME_STEP_S) as usize)
}

fn wind(seed: u64, samples: usize, oversampling: usize, intensity: f64, cycles: Range<usize>) -> Vec<Vec3> {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
    let (count, step_hz) = (samples * oversampling, 1.0 / (samples as f64 * TIME_STEP_S));
    let scale = intensity * MEAN_SPEED_M_S / slow_rms();
    let [along, up, across] = [0, 1, 2].map(|component| {
        let mut spectrum = vec![Complex::<f64>::default(); count];
        for bin in cycles.clone() {
            let amplitude = (2.0 * spectra(bin as f64 * step_hz)[component] * step_hz).sqrt();
            spectrum[bin] = Complex::from_polar(scale * amplitude, random.random_range(0.0..TAU));
        }
        FftPlanner::new().plan_fft_inverse(count).process(&mut spectrum);
        spectrum.into_iter().map(|value| value.re).collect::<Vec<f64>>()
    });
    let velocity =
        |index: usize| Vec3::new((MEAN_SPEED_M_S + along[index]) as f32, up[index] as f32, across[index] as f32);
    (0..count).map(velocity).collect()
}

/// Rms of the component along the wind, in u*, of the gusts of 1/256 to 8 Hz: to those the intensity refers.
pub fn slow_rms() -> f64 {
    const PERIOD_S: f64 = 256.0;
    (1..(8.0 * PERIOD_S) as usize).map(|bin| spectra(bin as f64 / PERIOD_S)[0] / PERIOD_S).sum::<f64>().sqrt()
}

/// One-sided spectra of the components along, up and across, in u*^2 / Hz.
fn spectra(frequency_hz: f64) -> [f64; 3] {
    let reduced = frequency_hz * HEIGHT_M / MEAN_SPEED_M_S;
    let unit = reduced / frequency_hz;
    let power = |base: f64| base.powf(5.0 / 3.0);
    [
        200.0 * unit / power(1.0 + 50.0 * reduced),
        3.36 * unit / (1.0 + 10.0 * power(reduced)),
        15.0 * unit / power(1.0 + 9.5 * reduced),
    ]
}
