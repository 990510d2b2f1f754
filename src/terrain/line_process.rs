//! The one-dimensional processes that turning bands are made of, exactly and fast (Setas et al., equation 3).
//!
//! ```text
//! z(u) = sum_k a_k cos(2 pi n_k u / N + phi_k)          n_k whole, a_k = s sqrt(2 p_k / L)
//! ```
//!
//! u counts samples. The process has a period of N samples, because every frequency is rounded to a whole number of
//! waves in it. So one table of a period serves the whole line, however far away a place is, and needs no seams.
//!
//! The alternatives: tables for each chunk allow any frequency, but make a single query far from any chunk as dear as
//! the sum itself, and neighbours agree only to the error of the lookup. Recurrences that turn phases from point to
//! point serve the rows of a grid alone and add up their rounding. What the period costs is that each line repeats
//! after some 30 ranges or more, when all other lines have moved on by another share of their periods: the field itself
//! correlates with itself again by about one part in L, and nowhere repeats.
//!
//! The table holds coefficients of a cubic B-spline, so that ground has continuous curvature. They come from the
//! harmonics by one inverse FFT, each divided by the spline's own gain, `beta = (2 + cos x) / 3` at `x = 2 pi n / N`:
//! at the samples the spline has the exact value. Between them it holds, beside each wave, its images at x + 2 pi m,
//! with amplitudes sinc^4(x/2 + pi m) / beta.

use rustfft::{FftPlanner, num_complex::Complex};
use std::f64::consts::{PI, TAU};

/// One wave of a line process.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Harmonic {
    /// Waves in a period.
    pub waves: u32,
    /// m.
    pub amplitude_m: f64,
    /// rad.
    pub phase: f64,
}

/// A value and its derivative by the coordinate in samples.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Jet {
    pub value: f64,
    pub derivative: f64,
}

/// One line process.
pub(super) struct LineProcess {
    harmonics: Vec<Harmonic>,
    /// B-spline coefficients of one period and the first three of the next, so that four in a row are always there.
    coefficients: Vec<f32>,
}

impl LineProcess {
    /// The process with these harmonics and a period of `samples`, a power of two above twice any harmonic's waves.
    pub fn new(harmonics: Vec<Harmonic>, samples: usize, planner: &mut FftPlanner<f64>) -> Self {
        let mut spectrum = vec![Complex::ZERO; samples];
        for harmonic in &harmonics {
            let bin = harmonic.waves as usize % samples;
            let gain = spline_gain(TAU * bin as f64 / samples as f64);
            spectrum[bin] += Complex::from_polar(harmonic.amplitude_m / gain, harmonic.phase);
        }
        planner.plan_fft_inverse(samples).process(&mut spectrum);
        let coefficient = |index: usize| spectrum[index % samples].re as f32;
        Self { harmonics, coefficients: (0..samples + 3).map(coefficient).collect() }
    }

    /// The process at `coordinate` samples: the sum of equation 3 itself.
    pub fn exact(&self, coordinate: f64) -> Jet {
        let turns = coordinate / self.period() as f64;
        let of_harmonic = |jet: Jet, harmonic: &Harmonic| {
            // The whole waves are taken off first, so that the cosine keeps its digits far away.
            let (sin, cos) = (TAU * (turns * f64::from(harmonic.waves)).fract() + harmonic.phase).sin_cos();
            let per_sample = TAU * f64::from(harmonic.waves) / self.period() as f64;
            Jet {
                value: jet.value + harmonic.amplitude_m * cos,
                derivative: jet.derivative - harmonic.amplitude_m * per_sample * sin,
            }
        };
        self.harmonics.iter().fold(Jet::default(), of_harmonic)
    }

    /// The process at `coordinate` samples, looked up.
    #[inline]
    pub fn value(&self, coordinate: f64) -> f32 {
        let (taps, t) = self.taps(coordinate);
        let s = 1.0 - t;
        let inner = |t: f32, s: f32| 4.0 - 3.0 * t * t * (1.0 + s);
        (taps[0] * s * s * s + taps[1] * inner(t, s) + taps[2] * inner(s, t) + taps[3] * t * t * t) / 6.0
    }

    /// The derivative of [`value`](Self::value) by the coordinate.
    #[inline]
    pub fn derivative(&self, coordinate: f64) -> f32 {
        let (taps, t) = self.taps(coordinate);
        let s = 1.0 - t;
        // The derivative of the cubic spline is the quadratic one through the differences.
        let [a, b, c] = [taps[1] - taps[0], taps[2] - taps[1], taps[3] - taps[2]];
        0.5 * (a * s * s + b * (1.0 + 2.0 * t * s) + c * t * t)
    }

    /// The four coefficients about a coordinate, and how far it lies between the middle ones.
    #[inline]
    fn taps(&self, coordinate: f64) -> (&[f32; 4], f32) {
        let floor = coordinate.floor();
        // Coefficient j belongs to sample j, and the taps begin one before the coordinate's sample.
        let first = (floor as i64).wrapping_sub(1) as usize & (self.period() - 1);
        let taps = self.coefficients[first..].first_chunk().unwrap_or(&[0.0; 4]);
        (taps, (coordinate - floor) as f32)
    }

    /// Samples in a period, a power of two.
    #[inline]
    fn period(&self) -> usize {
        self.coefficients.len() - 3
    }

    /// Mean square of what the lookup adds, over all coordinates and phases, m^2.
    pub fn lookup_error_m2(&self) -> f64 {
        let of_harmonic = |harmonic: &Harmonic| {
            let x = TAU * f64::from(harmonic.waves) / self.period() as f64;
            0.5 * harmonic.amplitude_m.powi(2) * spline_error(x)
        };
        self.harmonics.iter().map(of_harmonic).sum()
    }
}

/// What a cubic B-spline with coefficients cos(j x) has at its samples, in units of the cosine.
fn spline_gain(x: f64) -> f64 {
    (2.0 + x.cos()) / 3.0
}

/// Mean square of the interpolating spline's error at a wave of x radians a sample, in units of the wave's own.
fn spline_error(x: f64) -> f64 {
    let image = |m: i32| sinc(0.5 * x + PI * f64::from(m)).powi(4) / spline_gain(x);
    let images: f64 = (1..=4).map(|m| image(m).powi(2) + image(-m).powi(2)).sum();
    (1.0 - image(0)).powi(2) + images
}

fn sinc(x: f64) -> f64 {
    if x == 0.0 { 1.0 } else { x.sin() / x }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn process(harmonics: &[(u32, f64, f64)]) -> LineProcess {
        let harmonic = |&(waves, amplitude_m, phase)| Harmonic { waves, amplitude_m, phase };
        LineProcess::new(harmonics.iter().map(harmonic).collect(), 64, &mut FftPlanner::new())
    }

    #[test]
    fn at_the_samples_the_lookup_is_exact() {
        let line = process(&[(0, 0.5, 1.0), (3, 1.0, 0.3), (9, 2.0, 4.0), (16, 0.5, 2.0)]);
        for sample in -100..200 {
            let coordinate = f64::from(sample);
            assert_relative_eq!(f64::from(line.value(coordinate)), line.exact(coordinate).value, epsilon = 2e-6);
        }
    }

    #[test]
    fn between_samples_the_error_of_each_wave_is_the_predicted_one() {
        for waves in [2, 7, 12, 16] {
            // The phase must be averaged over where a period holds few samples of a wave.
            let (mut squares, mut predicted, mut count) = (0.0, 0.0, 0.0);
            for phase in 0..64 {
                let line = process(&[(waves, 1.0, f64::from(phase) * 0.3)]);
                predicted += line.lookup_error_m2() / 64.0;
                for step in 0..64 {
                    let coordinate = f64::from(step) * 1.017;
                    squares += (f64::from(line.value(coordinate)) - line.exact(coordinate).value).powi(2);
                    count += 1.0;
                }
            }
            let measured: f64 = squares / count;
            // Below 1e-6 the table's own single precision shows.
            assert_relative_eq!(measured.sqrt(), predicted.sqrt(), max_relative = 0.05, epsilon = 2e-7);
        }
    }

    #[test]
    fn derivatives_are_those_of_the_values() {
        let line = process(&[(3, 1.0, 0.3), (9, 2.0, 4.0)]);
        let step = 1e-3;
        for coordinate in [-7.3, 0.5, 11.9, 63.7, 1000.1] {
            let slope =
                |value: &dyn Fn(f64) -> f64| (value(coordinate + step) - value(coordinate - step)) / (2.0 * step);
            let looked_up = slope(&|u| f64::from(line.value(u)));
            assert_relative_eq!(f64::from(line.derivative(coordinate)), looked_up, epsilon = 2e-3);
            assert_relative_eq!(line.exact(coordinate).derivative, slope(&|u| line.exact(u).value), epsilon = 1e-5);
        }
    }

    #[test]
    fn the_process_is_periodic_and_finite_everywhere() {
        let line = process(&[(3, 1.0, 0.3), (9, 2.0, 4.0)]);
        for coordinate in [0.25, 5.5, 63.75] {
            assert_eq!(line.value(coordinate), line.value(coordinate + 64.0 * 1e9));
            assert_eq!(line.value(coordinate), line.value(coordinate - 64.0 * 1e9));
        }
        assert!(line.value(1e300).is_finite() && line.value(f64::MIN).is_finite());
    }
}
