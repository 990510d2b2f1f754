//! What oscillators of every frequency make of the basis signals: one table for all branches of all trees.
//!
//! For each class of natural frequency `w_n`, each lateral column of the wind and each sample of its period the table
//! holds the response to the four basis signals `y_k`, times `w_n^2`: a very stiff class returns the signal itself.
//! The wind is periodic, so the steady response is exact in the frequency domain, one multiplication a bin (eq. 21):
//!
//! ```text
//! Y^(w) = w_n^2 / (w_n^2 - w^2 + 2 i xi w_n w)  y^(w)
//! ```
//!
//! Since this transfer function maps real signals to real responses, two signals ride through one complex transform as
//! its real and imaginary parts.
//!
//! What this leaves out, as relative rms of the moving part at a damping ratio of 0.1 (`validate basis`):
//!
//! - The time step bounds the frequencies: a cubic through the samples wants four of them a period, so a step of 1/16 s
//!   serves oscillations up to 4 Hz. The spline loses 0.2% at 1 Hz, 1% at 2.2 Hz and 3% at 3.3 Hz, the highest class.
//! - Faster beams are in the last class, which follows the load without inertia (quasi-static). The small resonance that
//!   it leaves out is 39% of the motion at 5 Hz; the motion's size and sense are the gusts'.
//! - Rounding to a class moves a beam's frequency by up to 10%, less than the natural spread of wood's stiffness, and so
//!   shifts the phase of its sway: 22% from the motion of the exact frequency in the median, though equal in its
//!   statistics.

use super::load_basis::LoadBasis;
use bevy::math::{Vec3, Vec4};
use bevy::reflect::Reflect;
use rustfft::num_complex::Complex;
use rustfft::{Fft, FftPlanner};
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;
use std::sync::Arc;

/// The least damping ratio of the table: an undamped oscillator has no steady state.
pub const LEAST_DAMPING_RATIO: f32 = 1e-3;

/// Natural frequencies in steps of equal ratio, rounded to the nearest.
///
/// Class `i` has the frequency `lowest_hz * ratio^i`; the last of the `count` classes stands for all higher frequencies
/// and is quasi-static.
#[derive(Clone, Copy, Debug, PartialEq, Reflect, Serialize, Deserialize)]
pub struct FrequencyClasses {
    /// Frequency of class 0, in Hz. Slower beams count as of this class.
    pub lowest_hz: f32,
    /// Ratio of neighbouring classes, above 1. 1.22 keeps the rounding within 10%, less than the natural spread of
    /// wood's stiffness.
    pub ratio: f32,
    /// Number of classes, the quasi-static one included. At least 1.
    pub count: usize,
}

impl Default for FrequencyClasses {
    /// 0.05 Hz (a great tree) to 4 Hz, the most that samples of 1/16 s can show, in steps of +-10%, and the
    /// quasi-static class.
    fn default() -> Self {
        Self { lowest_hz: 0.05, ratio: 1.22, count: 23 }
    }
}

/// Why frequency classes cannot be used.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum FrequencyClassesError {
    /// The lowest frequency is not a positive number.
    #[error("lowest_hz is {0}, but must be above 0")]
    LowestFrequency(f32),
    /// The ratio is not a number above 1.
    #[error("ratio is {0}, but must be above 1")]
    Ratio(f32),
    /// There is no class.
    #[error("count is 0, but must be at least 1")]
    Count,
}

impl FrequencyClasses {
    /// These classes, if they can be used.
    pub fn validate(self) -> Result<Self, FrequencyClassesError> {
        if !(self.lowest_hz > 0.0 && self.lowest_hz.is_finite()) {
            Err(FrequencyClassesError::LowestFrequency(self.lowest_hz))
        } else if !(self.ratio > 1.0 && self.ratio.is_finite()) {
            Err(FrequencyClassesError::Ratio(self.ratio))
        } else if self.count == 0 {
            Err(FrequencyClassesError::Count)
        } else {
            Ok(self)
        }
    }

    /// Index of the last class, the quasi-static one.
    pub fn quasi_static(&self) -> usize {
        self.count.max(1) - 1
    }

    /// Place of a natural frequency on the scale of classes, not rounded. A frequency that is not a positive number
    /// counts as quasi-static.
    pub fn coordinate(&self, frequency_hz: f32) -> f32 {
        let coordinate = (frequency_hz / self.lowest_hz).ln() / self.ratio.ln();
        if coordinate.is_finite() { coordinate } else { self.quasi_static() as f32 }
    }

    /// What an instance's scale adds to its beams' coordinates: a tree `scale` times as large sways as many times more
    /// slowly. A scale that is not a positive number adds nothing.
    pub fn shift(&self, scale: f32) -> f32 {
        let shift = -scale.ln() / self.ratio.ln();
        if shift.is_finite() { shift } else { 0.0 }
    }

    /// The class nearest to a coordinate. NaN counts as quasi-static.
    pub fn nearest(&self, coordinate: f32) -> usize {
        let last = self.quasi_static();
        if coordinate < last as f32 { ((coordinate + 0.5).max(0.0) as usize).min(last) } else { last }
    }

    /// Natural frequency of a class in Hz; infinite for the quasi-static one.
    pub fn frequency_hz(&self, class: usize) -> f32 {
        if class < self.quasi_static() { self.lowest_hz * self.ratio.powi(class as i32) } else { f32::INFINITY }
    }
}

/// The responses of unit oscillators: frequency classes x lateral columns of the wind x samples of its period.
#[derive(Clone, Debug)]
pub struct ResponseTable {
    /// The classes of natural frequency.
    pub classes: FrequencyClasses,
    /// Number of lateral columns of the wind.
    pub columns: usize,
    /// Number of samples in a period.
    pub samples: usize,
    /// Time between two samples, in seconds.
    pub time_step_s: f32,
    /// Responses to the four basis signals, at index `(class * columns + column) * samples + time`.
    pub values: Vec<Vec4>,
    /// Velocities of the wind at the reference height, at index `column * samples + time`: m/s in wind coordinates, and
    /// their magnitude as w.
    pub velocities: Vec<Vec4>,
}

impl ResponseTable {
    /// The steady response to a periodic wind. `columns` are its velocities in m/s in wind coordinates, one series of a
    /// whole period, `time_step_s` apart, for each lateral place; all count as long as the shortest, and an empty wind is
    /// a calm. Velocities that are not finite count as calm. The damping ratio is that of all oscillators; it is
    /// at least [`LEAST_DAMPING_RATIO`].
    pub fn new(
        columns: &[Vec<Vec3>],
        time_step_s: f32,
        basis: &LoadBasis,
        classes: FrequencyClasses,
        damping_ratio: f32,
    ) -> Self {
        let calm = [vec![Vec3::ZERO]];
        let samples = columns.iter().map(Vec::len).min().unwrap_or(0);
        let columns = if samples == 0 { &calm[..] } else { columns };
        let samples = samples.max(1);
        let velocities: Vec<Vec4> = columns.iter().flat_map(|c| c[..samples].iter().map(|&v| with_speed(v))).collect();
        let signals: Vec<Vec4> = velocities.iter().map(|velocity| basis.signals(velocity.truncate())).collect();
        let class_count = classes.quasi_static() + 1;
        let mut table = Self {
            classes,
            columns: columns.len(),
            samples,
            time_step_s: if time_step_s > 0.0 && time_step_s.is_finite() { time_step_s } else { 1.0 },
            values: vec![Vec4::ZERO; class_count * signals.len()],
            velocities,
        };
        table.fill(&signals, damping_ratio);
        table
    }

    fn fill(&mut self, signals: &[Vec4], damping_ratio: f32) {
        let quasi_static = self.classes.quasi_static();
        self.values[quasi_static * signals.len()..].copy_from_slice(signals);
        let mut filter = PeriodicFilter::new(self.samples);
        let spectra: Vec<SignalSpectra> = signals.chunks_exact(self.samples).map(|s| filter.spectra(s)).collect();
        let rows = self.values[..quasi_static * signals.len()].chunks_exact_mut(signals.len());
        for (class, row) in rows.enumerate() {
            let frequency_hz = self.classes.frequency_hz(class);
            let transfer = transfer_function(self.samples, self.time_step_s, frequency_hz, damping_ratio);
            for (column, spectra) in row.chunks_exact_mut(self.samples).zip(&spectra) {
                filter.respond(spectra, &transfer, column);
            }
        }
    }

    /// Index into [`values`](Self::values).
    pub fn index(&self, class: usize, column: usize, time: usize) -> usize {
        (class * self.columns + column) * self.samples + time
    }

    /// Length of the wind's period, in seconds.
    pub fn period_s(&self) -> f64 {
        self.samples as f64 * f64::from(self.time_step_s)
    }

    /// The responses of a class in a column at a time, periodic, by a Catmull-Rom spline. Classes and columns beyond the
    /// last count as the last.
    pub fn response(&self, class: usize, column: usize, tau_s: f64) -> Vec4 {
        self.place(tau_s).of(self.series(class, column))
    }

    /// The responses of all classes in a column at a time; as many as `out` has room for.
    pub fn responses(&self, column: usize, tau_s: f64, out: &mut [Vec4]) {
        let place = self.place(tau_s);
        for (class, response) in out.iter_mut().enumerate().take(self.classes.quasi_static() + 1) {
            *response = place.of(self.series(class, column));
        }
    }

    /// The wind's velocity in a column at a time, m/s in wind coordinates, by a Catmull-Rom spline.
    pub fn velocity(&self, column: usize, tau_s: f64) -> Vec3 {
        let start = column.min(self.columns - 1) * self.samples;
        self.place(tau_s).of(&self.velocities[start..start + self.samples]).truncate()
    }

    fn series(&self, class: usize, column: usize) -> &[Vec4] {
        let class = class.min(self.classes.quasi_static());
        let start = self.index(class, column.min(self.columns - 1), 0);
        &self.values[start..start + self.samples]
    }

    fn place(&self, tau_s: f64) -> SplinePlace {
        SplinePlace::new(tau_s / f64::from(self.time_step_s), self.samples)
    }
}

fn with_speed(velocity: Vec3) -> Vec4 {
    let velocity = if velocity.is_finite() { velocity } else { Vec3::ZERO };
    velocity.extend(velocity.length())
}

/// The four samples around a time and their weights in the Catmull-Rom spline.
struct SplinePlace {
    samples: [usize; 4],
    weights: Vec4,
}

impl SplinePlace {
    /// At `place` samples after the first of a period of `count`. A place that is not finite counts as 0.
    fn new(place: f64, count: usize) -> Self {
        let within = place.rem_euclid(count as f64);
        let within = if within.is_finite() { within } else { 0.0 };
        let first = (within as usize).min(count - 1);
        let t = (within - first as f64) as f32;
        let after = |steps: usize| (first + steps) % count;
        let weights = Vec4::new(
            ((2.0 - t) * t - 1.0) * t,
            (3.0 * t - 5.0) * t * t + 2.0,
            ((4.0 - 3.0 * t) * t + 1.0) * t,
            (t - 1.0) * t * t,
        );
        Self { samples: [after(count - 1), first, after(1), after(2)], weights: 0.5 * weights }
    }

    fn of(&self, series: &[Vec4]) -> Vec4 {
        let [a, b, c, d] = self.samples.map(|sample| series[sample]);
        a * self.weights.x + b * self.weights.y + c * self.weights.z + d * self.weights.w
    }
}

/// Spectra of a column's four signals: the first two as real and imaginary part, and the last two.
type SignalSpectra = [Vec<Complex<f32>>; 2];

/// Filters four real signals of a period by a transfer function.
struct PeriodicFilter {
    forward: Arc<dyn Fft<f32>>,
    inverse: Arc<dyn Fft<f32>>,
    work: [Vec<Complex<f32>>; 2],
    scratch: Vec<Complex<f32>>,
}

impl PeriodicFilter {
    fn new(samples: usize) -> Self {
        let mut planner = FftPlanner::new();
        let (forward, inverse) = (planner.plan_fft_forward(samples), planner.plan_fft_inverse(samples));
        let scratch = forward.get_inplace_scratch_len().max(inverse.get_inplace_scratch_len());
        let zeros = |length| vec![Complex::ZERO; length];
        Self { forward, inverse, work: [zeros(samples), zeros(samples)], scratch: zeros(scratch) }
    }

    fn spectra(&mut self, signals: &[Vec4]) -> SignalSpectra {
        let mut spectra: SignalSpectra = [
            signals.iter().map(|signal| Complex::new(signal.x, signal.y)).collect(),
            signals.iter().map(|signal| Complex::new(signal.z, signal.w)).collect(),
        ];
        for spectrum in &mut spectra {
            self.forward.process_with_scratch(spectrum, &mut self.scratch);
        }
        spectra
    }

    fn respond(&mut self, spectra: &SignalSpectra, transfer: &[Complex<f32>], out: &mut [Vec4]) {
        for (work, spectrum) in self.work.iter_mut().zip(spectra) {
            for ((product, value), factor) in work.iter_mut().zip(spectrum).zip(transfer) {
                *product = value * factor;
            }
            self.inverse.process_with_scratch(work, &mut self.scratch);
        }
        for ((response, xy), zw) in out.iter_mut().zip(&self.work[0]).zip(&self.work[1]) {
            *response = Vec4::new(xy.re, xy.im, zw.re, zw.im);
        }
    }
}

/// The transfer function at all bins of a period, divided by their number (the inverse transform does not).
fn transfer_function(samples: usize, time_step_s: f32, frequency_hz: f32, damping_ratio: f32) -> Vec<Complex<f32>> {
    let omega_n = TAU * f64::from(frequency_hz);
    let damping = f64::from(damping_ratio.max(LEAST_DAMPING_RATIO));
    let omega_step = TAU / (samples as f64 * f64::from(time_step_s));
    let value = |bin: usize| {
        // Bins above the middle are negative frequencies; the middle one, both at once, must stay real.
        let signed = if 2 * bin > samples { bin as f64 - samples as f64 } else { bin as f64 };
        let ratio = signed * omega_step / omega_n;
        let factor = Complex::new(1.0 - ratio * ratio, 2.0 * damping * ratio).inv() / samples as f64;
        let imaginary = if 2 * bin == samples { 0.0 } else { factor.im as f32 };
        Complex::new(factor.re as f32, imaginary)
    };
    (0..samples).map(value).collect()
}

#[cfg(test)]
mod tests;
