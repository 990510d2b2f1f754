//! The responses of oscillators of every frequency class to the basis signals: one table for all branches of all trees.
//!
//! For each class of natural frequency `w_n`, each lateral column of the wind and each sample of its period the table
//! holds the response to the four basis signals `y_k`, times `w_n^2`: a very stiff class returns the signal itself.
//! The wind is periodic, so the steady response is exact in the frequency domain, one multiplication a bin (eq. 21):
//!
//! ```text
//! Y^(w) = w_n^2 / (w_n^2 - w^2 + 2 i xi w_n w)  y^(w)
//! ```
//!
//! This transfer function maps real signals to real responses. So two signals go through one complex transform, as its
//! real and imaginary parts.
//!
//! What this leaves out, as relative rms of the moving part at a damping ratio of 0.1 (`validate basis`):
//!
//! - The time step bounds the frequencies: a cubic through the samples wants four of them a period, so a step of 1/16 s
//!   serves oscillations up to 4 Hz. The spline loses 0.2% at 1 Hz, 1% at 2.2 Hz and 3% at 3.3 Hz, the highest class.
//! - Faster beams are in the last class, which follows the load without inertia (quasi-static). The small resonance that
//!   it leaves out is 39% of the motion at 5 Hz; the size and direction of the motion are those of the gusts.
//! - Rounding to a class moves a beam's frequency by up to 10%, less than the natural spread of wood's stiffness, and so
//!   shifts the phase of its sway: 22% from the motion of the exact frequency in the median, though equal in its
//!   statistics.

use super::{frequency_classes::FrequencyClasses, load_basis::LoadBasis};
use crate::interpolation::catmull_rom;
use bevy::math::{Vec3, Vec4};
use rustfft::num_complex::Complex;
use rustfft::{Fft, FftPlanner};
use std::f64::consts::TAU;
use std::sync::Arc;

/// The least damping ratio of the table: an undamped oscillator has no steady state.
const LEAST_DAMPING_RATIO: f32 = 1e-3;

/// The responses of unit oscillators: frequency classes x lateral columns of the wind x samples of its period.
#[derive(Clone, Debug)]
pub struct ResponseTable {
    /// The classes of natural frequency.
    pub classes: FrequencyClasses,
    /// Number of lateral columns of the wind.
    pub(crate) columns: usize,
    /// Number of samples in a period.
    pub(crate) samples: usize,
    /// Time between two samples, in seconds.
    pub(crate) time_step_s: f32,
    /// Responses to the four basis signals, at index `(class * columns + column) * samples + time`.
    pub(crate) values: Vec<Vec4>,
    /// Velocities of the wind at the reference height, at index `column * samples + time`: m/s in wind coordinates, and
    /// their magnitude as w.
    pub(crate) velocities: Vec<Vec4>,
}

impl ResponseTable {
    /// The steady response to a periodic wind. `columns` are its velocities in m/s in wind coordinates, one series of a
    /// whole period, `time_step_s` apart, for each lateral place; all count as long as the shortest, and an empty wind is
    /// a calm. Velocities that are not finite count as calm. The damping ratio is that of all oscillators; it is
    /// at least 0.001.
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
    fn index(&self, class: usize, column: usize, time: usize) -> usize {
        (class * self.columns + column) * self.samples + time
    }

    /// Length of the wind's period, in seconds.
    pub fn period_s(&self) -> f64 {
        self.samples as f64 * f64::from(self.time_step_s)
    }

    /// The responses of a class at a place of the table, periodic in time, by a Catmull-Rom spline. Classes and columns beyond the
    /// last count as the last.
    pub fn response(&self, class: usize, place: &TablePlace) -> Vec4 {
        self.blend(class, place, &self.spline(place))
    }

    /// The responses of all classes at a place; as many as `out` has room for.
    pub fn responses(&self, place: &TablePlace, out: &mut [Vec4]) {
        let spline = self.spline(place);
        for (class, response) in out.iter_mut().enumerate().take(self.classes.quasi_static() + 1) {
            *response = self.blend(class, place, &spline);
        }
    }

    /// The wind's velocity at a place, m/s in wind coordinates, by a Catmull-Rom spline.
    pub fn velocity(&self, place: &TablePlace) -> Vec3 {
        let spline = self.spline(place);
        let of_column = |column: usize| {
            let start = column.min(self.columns - 1) * self.samples;
            spline.of(&self.velocities[start..start + self.samples])
        };
        place.sum(of_column).truncate()
    }

    fn blend(&self, class: usize, place: &TablePlace, spline: &SplinePlace) -> Vec4 {
        place.sum(|column| spline.of(self.series(class, column)))
    }

    fn series(&self, class: usize, column: usize) -> &[Vec4] {
        let class = class.min(self.classes.quasi_static());
        let start = self.index(class, column.min(self.columns - 1), 0);
        &self.values[start..start + self.samples]
    }

    fn spline(&self, place: &TablePlace) -> SplinePlace {
        SplinePlace::new(place.tau_s / f64::from(self.time_step_s), self.samples)
    }
}

/// Where a tree stands in a [`ResponseTable`]: the columns of the wind about it with their weights, and a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TablePlace {
    /// Lateral columns.
    pub columns: [usize; 4],
    /// Their weights.
    pub weights: [f32; 4],
    /// Time in the wind's period, s.
    pub tau_s: f64,
}

impl TablePlace {
    /// On a column.
    pub fn on_column(column: usize, tau_s: f64) -> Self {
        Self { columns: [column; 4], weights: [1.0, 0.0, 0.0, 0.0], tau_s }
    }

    /// The weighted sum over the columns. One without a weight is not read.
    fn sum(&self, of_column: impl Fn(usize) -> Vec4) -> Vec4 {
        let weighted = self.columns.iter().zip(self.weights).filter(|(_, weight)| *weight != 0.0);
        weighted.map(|(&column, weight)| weight * of_column(column)).sum()
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
        Self { samples: [after(count - 1), first, after(1), after(2)], weights: catmull_rom(t).into() }
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
