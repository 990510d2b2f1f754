//! At which frequencies a branch resonates, from its answers at a few.
//!
//! Its deflection in a wind that swings with the frequency `f` is a sum over modes, each with its share `a` of the static deflection. It is
//! known at some `f_k`, for hinges that take as much of the motion at any frequency (a damping ratio `zeta` at resonance). What tells peaks apart is
//! how it lags in a moderate wind, at all frequencies:
//!
//! ```text
//! R(f_k) = sum a_j / (1 + 2 i zeta - (f_k/f_j)^2)                                     (samples, zeta = 0.12)
//! lag(f) = sum a_j 2 xi r / ((1 - r^2)^2 + (2 xi r)^2),    r = f / f_j                (curve, xi = 0.09)
//! ```
//!
//! Both are linear in the `a_j`, and smooth over a step of a fifth of the frequency: so the lag at each frequency is taken as a linear
//! combination of the samples, that with the least error in the square mean over shares that are alike for modes of all frequencies and
//! independent of each other (a linear estimate with a prior: Wiener 1949). The combinations are the same for all branches of all trees, relative
//! to the lowest frequency. Twelve samples tell what sixteen did not before, when peaks were looked for among the samples themselves: two of
//! a ratio of 1.3.
//!
//! Of the peaks a branch sways with that which gusts move furthest: their amplitude is as `sqrt(f S(f)) ~ f^(-1/3)`, with Kolmogorov's
//! spectrum `S ~ f^(-5/3)`. And with the next one, if gusts move it by a good part as far and it is no flank of the first. What each of
//! both has of the deflection follows from both heights, to which the other adds its flank.

use bevy::math::Vec4;
use nalgebra::{Cholesky, SMatrix, SVector};
use std::sync::LazyLock;

/// Samples, in fours.
pub(super) const FOURS: usize = 3;
const SAMPLES: usize = 4 * FOURS;
/// Ratio of the frequencies of neighbours: `exp(0.21)`.
const SAMPLE_RATIO: f64 = 1.233_678_059_956_743;
/// Damping ratio of the hinges in the samples. The greater, the smoother are the answers.
pub(super) const SAMPLE_DAMPING_RATIO: f64 = 0.12;

/// Damping ratio of the curve, that of branches in a moderate wind: what is nearer together than some 15% is one peak.
const DAMPING_RATIO: f64 = 0.09;
/// Points of the curve: their ratio, `exp(0.05)`, and how many there are before the first sample and in all. Before it and after the
/// last a peak is known by its flank.
const POINT_RATIO: f64 = 1.051_271_096_376_024;
const POINTS_BEFORE: i32 = 12;
const POINTS: usize = 61;
/// Modes for which the combinations are right: the ratio of their frequencies, `exp(0.03)`, how many there are below the first sample and
/// in all.
const MODE_RATIO: f64 = 1.030_454_533_953_517;
const MODES_BEFORE: i32 = 33;
const MODES: usize = 144;
/// Noise of the samples by their power: their rounding, and what modes beyond those do.
const NOISE: f64 = 1e-5;

/// Amplitude of gusts as a power of their frequency, and so its ratio from sample to sample, from point to point and from mode to mode:
/// `exp(-0.07)`, `exp(-0.05 / 3)`, `exp(-0.01)`.
const GUST_EXPONENT: f64 = -1.0 / 3.0;
const SAMPLE_GUST_RATIO: f64 = 0.932_393_819_905_948_3;
const POINT_GUST_RATIO: f64 = 0.983_471_453_821_617_5;
const MODE_GUST_RATIO: f64 = 0.990_049_833_749_168_1;
/// Least motion in gusts of a second peak, by that of the first.
const LEAST_MOTION: f64 = 0.4;
/// Least ratio of the frequencies of two peaks: a step of the [classes](crate::dynamics::FrequencyClasses).
const LEAST_RATIO: f64 = 1.22;

/// Answers of a branch as real parts, then imaginary ones, at the frequencies of the samples. Hinges have the stiffness K there in place of
/// `K (1 + 2 i zeta)`.
pub(super) type Samples = [Vec4; 2 * FOURS];

/// The natural frequencies by which a branch sways.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Resonance {
    /// That by which gusts move it furthest, Hz.
    pub frequency_hz: f64,
    pub second: Option<SecondResonance>,
}

/// Another, by which gusts move it about as far.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SecondResonance {
    pub frequency_hz: f64,
    /// Share of the deflection by both, 0 to 1.
    pub share: f64,
}

/// Frequency of a sample, by the lowest.
pub(super) fn sample_frequency(index: usize) -> f64 {
    power(SAMPLE_RATIO, index as i32)
}

/// By multiplication alone, which is the same on all machines.
fn power(ratio: f64, exponent: i32) -> f64 {
    let step = if exponent < 0 { 1.0 / ratio } else { ratio };
    (0..exponent.unsigned_abs()).fold(1.0, |product, _| product * step)
}

/// The lag at all frequencies from samples.
pub(super) struct LagCurve {
    /// What each sample adds, for each point.
    weights: Vec<Samples>,
    /// Frequencies of the points by the lowest sample's, and amplitudes of gusts there.
    points: Vec<(f64, f32)>,
}

const UNKNOWNS: usize = 2 * SAMPLES;
type Row = [f64; UNKNOWNS];

impl LagCurve {
    pub fn shared() -> &'static Self {
        static CURVE: LazyLock<LagCurve> = LazyLock::new(LagCurve::new);
        &CURVE
    }

    fn new() -> Self {
        let frequencies: [f64; POINTS] = std::array::from_fn(|point| power(POINT_RATIO, point as i32 - POINTS_BEFORE));
        // Samples count by what gusts make of them.
        let gusts: [f64; SAMPLES] = std::array::from_fn(|index| power(SAMPLE_GUST_RATIO, index as i32));
        let mut covariances = [[0.0; UNKNOWNS]; UNKNOWNS];
        let mut with_points = vec![[0.0; UNKNOWNS]; POINTS];
        for mode in 0..MODES {
            let natural = power(MODE_RATIO, mode as i32 - MODES_BEFORE);
            // Such that gusts move all alike.
            let gust = power(MODE_GUST_RATIO, mode as i32 - MODES_BEFORE);
            let variance = 1.0 / (gust * gust);
            let samples = samples_of(natural);
            let samples: Row = std::array::from_fn(|index| samples[index] * gusts[index % SAMPLES]);
            for (row, sample) in covariances.iter_mut().zip(samples) {
                row.iter_mut().zip(samples).for_each(|(sum, other)| *sum += variance * sample * other);
            }
            for (row, frequency) in with_points.iter_mut().zip(frequencies) {
                let lag = variance * lag(frequency / natural);
                row.iter_mut().zip(samples).for_each(|(sum, sample)| *sum += lag * sample);
            }
        }
        let mean_power = (0..UNKNOWNS).map(|index| covariances[index][index]).sum::<f64>() / UNKNOWNS as f64;
        (0..UNKNOWNS).for_each(|index| covariances[index][index] += NOISE * mean_power);
        // Definite by its noise.
        let factor = Cholesky::new_unchecked(SMatrix::from(covariances));
        let weights = with_points.into_iter().map(|row| {
            let solved = factor.solve(&SVector::from(row));
            of_answers(std::array::from_fn(|index| solved[index] * gusts[index % SAMPLES]))
        });
        let point = |(index, frequency): (i32, f64)| (frequency, power(POINT_GUST_RATIO, index - POINTS_BEFORE) as f32);
        Self { weights: weights.collect(), points: (0..).zip(frequencies).map(point).collect() }
    }

    /// With what frequencies a branch sways; none where gusts move it most beyond the frequencies of the curve.
    pub fn resonance(&self, samples: &Samples, lowest_hz: f64) -> Option<Resonance> {
        let lags: [f32; POINTS] = std::array::from_fn(|point| {
            let products = self.weights[point].iter().zip(samples).map(|(weight, sample)| *weight * *sample);
            products.sum::<Vec4>().element_sum()
        });
        let motion = |point: usize| lags[point] * self.points[point].1;
        let is_highest = |&point: &usize| motion(point) >= motion(point - 1) && motion(point) > motion(point + 1);
        let peaks =
            || (1..POINTS - 1).filter(is_highest).map(|point| self.peak_near(&lags, point)).filter(Peak::is_real);
        let by_motion = |a: &Peak, b: &Peak| a.motion.total_cmp(&b.motion);
        let first = peaks().max_by(by_motion)?;
        if first.motion < f64::from(motion(0).max(motion(POINTS - 1))) {
            return None;
        }
        let ratio = |peak: &Peak| (peak.frequency / first.frequency).max(first.frequency / peak.frequency);
        let is_second = |peak: &Peak| ratio(peak) >= LEAST_RATIO && peak.motion >= LEAST_MOTION * first.motion;
        let second = peaks().filter(is_second).max_by(by_motion).map(|second| SecondResonance {
            frequency_hz: lowest_hz * second.frequency,
            share: second_share(&first, &second),
        });
        Some(Resonance { frequency_hz: lowest_hz * first.frequency, second })
    }

    /// The mode of which these lags are, at a point and its neighbours. That of one mode is `c f / ((f_n^2 - f^2)^2 + (2 xi f_n f)^2)`,
    /// so that `f` over it is a polynomial of the second degree in `f^2`: three points tell all of it.
    fn peak_near(&self, lags: &[f32; POINTS], point: usize) -> Peak {
        let x: [f64; 3] = std::array::from_fn(|k| self.points[point + k - 1].0.powi(2));
        let y: [f64; 3] = std::array::from_fn(|k| x[k].sqrt() / f64::from(lags[point + k - 1]));
        let slopes = [(y[1] - y[0]) / (x[1] - x[0]), (y[2] - y[1]) / (x[2] - x[1])];
        let curvature = (slopes[1] - slopes[0]) / (x[2] - x[0]);
        let lowest = 0.5 * (x[0] + x[1] - slopes[0] / curvature);
        let natural = lowest / (1.0 - 2.0 * DAMPING_RATIO * DAMPING_RATIO);
        // Where several modes run together these are not one's lags.
        let square = if curvature > 0.0 { natural.clamp(x[0], x[2]) } else { x[1] };
        let there = y[0] + (slopes[0] + curvature * (square - x[1])) * (square - x[0]);
        let frequency = square.sqrt();
        let lag = frequency / there;
        Peak { frequency, lag, motion: lag * frequency.powf(GUST_EXPONENT) }
    }
}

struct Peak {
    /// By the lowest of the samples.
    frequency: f64,
    lag: f64,
    /// In gusts.
    motion: f64,
}

impl Peak {
    fn is_real(&self) -> bool {
        self.motion > 0.0 && self.motion.is_finite()
    }
}

/// What the second of two peaks has of the deflection by both: each lags by its own share and by the flank of the other.
fn second_share(first: &Peak, second: &Peak) -> f64 {
    let own = lag(1.0);
    let [to_first, to_second] = [first.frequency / second.frequency, second.frequency / first.frequency].map(lag);
    let [a, b] = [first.lag * own - second.lag * to_first, second.lag * own - first.lag * to_second];
    (b / (a + b)).clamp(0.0, 1.0)
}

/// Lag of a mode by its static deflection, for a frequency by its own.
fn lag(ratio: f64) -> f64 {
    let damping = 2.0 * DAMPING_RATIO * ratio;
    damping / ((1.0 - ratio * ratio).powi(2) + damping * damping)
}

/// `1 / (1 + 2 i zeta - (f_k/f)^2)` of a mode at all samples: real parts, then imaginary ones.
fn samples_of(natural: f64) -> Row {
    let damping = 2.0 * SAMPLE_DAMPING_RATIO;
    std::array::from_fn(|index| {
        let real = 1.0 - (sample_frequency(index % SAMPLES) / natural).powi(2);
        let norm = real * real + damping * damping;
        if index < SAMPLES { real / norm } else { -damping / norm }
    })
}

/// Weights of the answers, from those of the answers over `1 + 2 i zeta`.
fn of_answers(weights: Row) -> Samples {
    let damping = 2.0 * SAMPLE_DAMPING_RATIO;
    let norm = 1.0 + damping * damping;
    let (real, imaginary) = weights.split_at(SAMPLES);
    let of_answer = |index: usize| {
        let [re, im] = [real[index % SAMPLES], imaginary[index % SAMPLES]];
        let weight = if index < SAMPLES { re - damping * im } else { im + damping * re };
        (weight / norm) as f32
    };
    std::array::from_fn(|four| Vec4::from_array(std::array::from_fn(|lane| of_answer(4 * four + lane))))
}

#[cfg(test)]
mod tests;
