//! Gusts that are too fast for a field's samples, and small: they shake twigs.
//!
//! Above some 2 Hz two places a metre apart share next to nothing of a gust (`exp(-C f d / U)` is 0.08 at 8 m/s). So there is
//! no need of a field of them: one short series serves all places, each of which reads it at another time. It has a period of
//! its own, which fits a whole number of times into the field's, so that together they have the field's period.
//!
//! The two bands are drawn apart. So fast gusts are as strong in a lull as in a gust; in the air they come in bursts.

use super::{
    level_spectrum::LevelSpectrum, profile::LogProfile, settings::FieldSettings, spectrum::TurbulenceComponent,
};
use bevy::math::Vec3;
use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};
use rustfft::{FftPlanner, num_complex::Complex};
use std::f64::consts::TAU;

/// About where slow gusts end and fast ones begin, Hz.
const CROSSOVER_HZ: f64 = 2.0;
/// The fastest gusts: twice the frequency of the fastest twigs that answer them with inertia.
const FASTEST_HZ: f64 = 24.0;
/// About the period of fast gusts, s: long enough that its frequencies are finer than the resonance of a twig at 4 Hz with a damping
/// ratio of 0.05 is wide.
const SHORT_PERIOD_S: f64 = 8.0;
/// Samples for each second are at least so many times the fastest frequency: loads grow with the square of the wind.
const OVERSAMPLING: f64 = 4.0;
/// Told apart from the seeds of the field itself.
const SEED_OF_FAST_GUSTS: u64 = 0x6661_7374_6775_7374;

/// How the gusts of a periodic wind are divided into slow and fast ones.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GustBands {
    /// Slow gusts have frequencies below this one, and fast ones above it, Hz: half a step before the first frequency of the
    /// short period that is at least some 2 Hz, so that together they have the power of the spectrum.
    pub crossover_hz: f64,
    /// The period of the fast gusts, s: some 8 s, a whole number of times in the wind's period.
    pub short_period_s: f64,
}

impl GustBands {
    /// For a wind of some period, s. A period that is not a positive number counts as 128 s.
    #[must_use]
    pub fn of_period(period_s: f64) -> Self {
        let period_s = if period_s > 0.0 && period_s.is_finite() { period_s } else { 16.0 * SHORT_PERIOD_S };
        let short_period_s = period_s / (period_s / SHORT_PERIOD_S).round().max(1.0);
        Self { crossover_hz: ((CROSSOVER_HZ * short_period_s).floor() + 0.5) / short_period_s, short_period_s }
    }

    /// Frequencies of the fast gusts, in cycles in the short period.
    fn cycles(&self) -> std::ops::RangeInclusive<usize> {
        let first = (self.crossover_hz * self.short_period_s).ceil() as usize;
        first..=(FASTEST_HZ * self.short_period_s).floor() as usize
    }

    /// Samples of a series of fast gusts, a power of two.
    fn samples(&self) -> usize {
        ((OVERSAMPLING * FASTEST_HZ * self.short_period_s).ceil() as usize).next_power_of_two()
    }
}

/// One short period of the fast turbulence at a height, m/s in wind coordinates: the spectra of the field that `settings`, which must be
/// valid, and `profile` describe, with random phases.
///
/// A resonance of a twig takes in a few frequencies of the short period. So that u, v and w neither add up nor cancel there by chance, they
/// are uncorrelated over any three neighbouring frequencies: each has the same phases, a third of the period later than the last.
pub(super) fn synthesise(settings: &FieldSettings, profile: &LogProfile, height_m: f32) -> Vec<Vec3> {
    let bands = GustBands::of_period(settings.resolution.period_s());
    let mut velocities = vec![Vec3::ZERO; bands.samples()];
    if profile.friction_velocity_m_s == 0.0 {
        return velocities;
    }
    let step_hz = bands.short_period_s.recip();
    let to_time = FftPlanner::new().plan_fft_inverse(velocities.len());
    let mut random = Xoshiro256PlusPlus::seed_from_u64(settings.seed ^ SEED_OF_FAST_GUSTS);
    let phases: Vec<f64> = bands.cycles().map(|_| random.random()).collect();
    for (component, third) in TurbulenceComponent::ALL.into_iter().zip(0..) {
        let spectrum = LevelSpectrum::new(component, settings, profile, height_m);
        let mut series = vec![Complex::<f64>::ZERO; velocities.len()];
        for (bin, phase) in bands.cycles().zip(&phases) {
            let amplitude_m_s = spectrum.amplitude_m_s(bin as f64 * step_hz, step_hz);
            let phase = phase + (third * bin % 3) as f64 / 3.0;
            series[bin] = Complex::from_polar(amplitude_m_s, TAU * phase);
        }
        to_time.process(&mut series);
        for (velocity, value) in velocities.iter_mut().zip(&series) {
            velocity[component.axis()] = value.re as f32;
        }
    }
    velocities
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEIGHT_M: f64 = 7.0;

    fn gusts(settings: &FieldSettings) -> Vec<Vec3> {
        let profile = LogProfile::from_reference(settings.speed, settings.roughness_m, settings.displacement_m);
        synthesise(settings, &profile, HEIGHT_M as f32)
    }

    #[test]
    fn the_short_period_fits_a_whole_number_of_times() {
        for (period_s, short_period_s) in [(128.0, 8.0), (100.0, 100.0 / 13.0), (5.0, 5.0), (0.08, 0.08)] {
            let bands = GustBands::of_period(period_s);
            assert!((bands.short_period_s - short_period_s).abs() < 1e-12);
            let cycles = bands.crossover_hz * bands.short_period_s;
            assert!((cycles.fract() - 0.5).abs() < 1e-9 && bands.crossover_hz > 2.0 - 0.5 / short_period_s);
        }
        for odd in [f64::NAN, 0.0, -3.0, f64::INFINITY] {
            assert_eq!(GustBands::of_period(odd), GustBands::of_period(128.0));
        }
    }

    /// The integral of the closed-form spectra (9) over the fast gusts, by fine trapezoids.
    #[test]
    fn fast_gusts_have_the_power_of_the_spectra_in_their_band() {
        let settings = FieldSettings { gustiness: 0.8, ..Default::default() };
        let friction_m_s = 0.4 * 8.0 / 100f64.ln();
        let speed_m_s = friction_m_s / 0.4 * (HEIGHT_M / 0.1).ln();
        let power = |of: fn(f64) -> f64| {
            let step_hz = 1e-3;
            let eddy_s = HEIGHT_M / speed_m_s;
            let sum: f64 = (0..21_999).map(|step| of((2.0625 + (f64::from(step) + 0.5) * step_hz) * eddy_s)).sum();
            0.64 * friction_m_s.powi(2) * eddy_s * sum * step_hz
        };
        let expected = [
            power(|nu| 200.0 / (1.0 + 50.0 * nu).powf(5.0 / 3.0)),
            power(|nu| 3.36 / (1.0 + 10.0 * nu.powf(5.0 / 3.0))),
            power(|nu| 15.0 / (1.0 + 9.5 * nu).powf(5.0 / 3.0)),
        ];
        let gusts = gusts(&settings);
        for (axis, expected) in expected.into_iter().enumerate() {
            let found = gusts.iter().map(|gust| f64::from(gust[axis]).powi(2)).sum::<f64>() / gusts.len() as f64;
            // Steps of 1/8 Hz in a spectrum that falls by a tenth in them.
            assert!((found / expected - 1.0).abs() < 5e-3, "axis {axis}: {found} is not {expected}");
        }
    }

    /// In a band of three frequencies, as wide as a twig's resonance, at 5 and 11 Hz.
    #[test]
    fn components_are_uncorrelated_where_a_twig_resonates() {
        let gusts = gusts(&FieldSettings::default());
        let bins = |axis: usize, first: usize| {
            (first..first + 3).map(move |bin| (axis, bin)).map(|(axis, bin)| {
                let turn = |time: usize| -TAU * (bin * time) as f64 / gusts.len() as f64;
                let terms = gusts.iter().enumerate().map(|(time, gust)| (f64::from(gust[axis]), turn(time)));
                terms.map(|(value, turn)| Complex::from_polar(value, turn)).sum::<Complex<f64>>()
            })
        };
        for first in [40, 87] {
            for (a, b) in [(0, 1), (0, 2), (1, 2)] {
                let cross: Complex<f64> = bins(a, first).zip(bins(b, first)).map(|(a, b)| a * b.conj()).sum();
                let power = |axis| bins(axis, first).map(|value| value.norm_sqr()).sum::<f64>();
                // The spectra fall by a tenth over the three.
                let correlation = cross.norm() / (power(a) * power(b)).sqrt();
                assert!(correlation < 0.05, "{a} and {b} at bin {first}: {correlation}");
            }
        }
    }

    #[test]
    fn nothing_is_slower_than_the_crossover_or_on_average() {
        let gusts = gusts(&FieldSettings::default());
        for cycles in [0, 1, 9, 16] {
            let sum = |part: fn(f64) -> f64| -> f64 {
                let turn = |time: usize| TAU * (cycles * time) as f64 / gusts.len() as f64;
                gusts.iter().enumerate().map(|(time, gust)| f64::from(gust.x) * part(turn(time))).sum()
            };
            assert!(sum(f64::cos).hypot(sum(f64::sin)) / (gusts.len() as f64) < 1e-7, "{cycles} cycles");
        }
    }

    #[test]
    fn the_same_seed_gives_the_same_gusts_and_a_calm_none() {
        let settings = FieldSettings::default();
        assert_eq!(gusts(&settings), gusts(&settings));
        assert_ne!(gusts(&settings), gusts(&FieldSettings { seed: 1, ..settings.clone() }));
        assert!(gusts(&FieldSettings { speed: 0.0, ..settings.clone() }).iter().all(|gust| *gust == Vec3::ZERO));
        assert!(gusts(&FieldSettings { gustiness: 0.0, ..settings }).iter().all(|gust| *gust == Vec3::ZERO));
    }
}
