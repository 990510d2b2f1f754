//! The responses of unit oscillators to the basis signals: one table for all branches of all trees.
//!
//! For each oscillator of the [grid](super::oscillator_grid), each lateral column of the wind and each sample of its period
//! the table holds the response to the four basis signals `y_k`, times `w_n^2`: a very stiff one returns the signal itself.
//! The wind is periodic, so the steady response is exact in the frequency domain, one multiplication a bin (eq. 21, with
//! the aerodynamic admittance):
//!
//! ```text
//! Y^(w) = |J(w)| w_n^2 / (w_n^2 - w^2 + 2 i xi w_n w)  y^(w)
//! ```
//!
//! This transfer function maps real signals to real responses. So two signals go through one complex transform, as its
//! real and imaginary parts. Slow oscillators leave nothing of fast gusts: their rows have fewer samples.
//!
//! What this leaves out, as relative rms of the moving part (`validate basis`):
//!
//! - The time step bounds the frequencies: a cubic through the samples wants four of them a period, so a step of 1/16 s
//!   serves oscillations up to 4 Hz. The spline loses 0.2% at 1 Hz, 1% at 2.2 Hz and 3% at 3.3 Hz, the highest class.
//! - Faster beams are in the last class, which follows the load without inertia (quasi-static). The small resonance that
//!   it leaves out is 39% of the motion at 5 Hz; the size and direction of the motion are those of the gusts.
//! - Rounding to a class moves a beam's frequency by up to 10%, less than the natural spread of wood's stiffness, and so
//!   shifts the phase of its sway: 22% from the motion of the exact frequency in the median, though equal in its
//!   statistics.

use super::{
    load_basis::LoadBasis,
    oscillator_grid::{DAMPINGS, OscillatorGrid, SIZES},
};
use crate::interpolation::catmull_rom;
use bevy::math::{Vec3, Vec4};
use rustfft::num_complex::Complex;
use rustfft::{Fft, FftPlanner};
use std::sync::Arc;

/// The responses of unit oscillators: rows of the grid x lateral columns of the wind x samples of its period.
#[derive(Clone, Debug)]
pub struct ResponseTable {
    /// The oscillators.
    pub grid: OscillatorGrid,
    /// Number of lateral columns of the wind.
    pub(crate) columns: usize,
    /// Number of samples of the wind in a period.
    pub(crate) samples: usize,
    /// Time between two samples of the wind, in seconds.
    pub(crate) time_step_s: f32,
    /// Where each row is in the values.
    pub(crate) rows: Vec<TableRow>,
    /// Responses to the four basis signals, at index `row.first + column * row.samples + time`.
    pub(crate) values: Vec<Vec4>,
    /// Velocities of the wind at the reference height, at index `column * samples + time`: m/s in wind coordinates, and
    /// their magnitude as w.
    pub(crate) velocities: Vec<Vec4>,
}

/// Where the responses of one oscillator are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct TableRow {
    /// Index of its first value.
    pub first: usize,
    /// Samples in a period.
    pub samples: usize,
}

impl ResponseTable {
    /// The steady response to a periodic wind. `columns` are its velocities in m/s in wind coordinates, one series of a
    /// whole period, `time_step_s` apart, for each lateral place; all count as long as the shortest, and an empty wind is
    /// a calm. Velocities that are not finite count as calm.
    pub fn new(columns: &[Vec<Vec3>], time_step_s: f32, basis: &LoadBasis, grid: OscillatorGrid) -> Self {
        let calm = [vec![Vec3::ZERO]];
        let samples = columns.iter().map(Vec::len).min().unwrap_or(0);
        let columns = if samples == 0 { &calm[..] } else { columns };
        let samples = samples.max(1);
        let time_step_s = if time_step_s > 0.0 && time_step_s.is_finite() { time_step_s } else { 1.0 };
        let velocities: Vec<Vec4> = columns.iter().flat_map(|c| c[..samples].iter().map(|&v| with_speed(v))).collect();
        let signals: Vec<Vec4> = velocities.iter().map(|velocity| basis.signals(velocity.truncate())).collect();
        let mut table = Self {
            grid,
            columns: columns.len(),
            samples,
            time_step_s,
            rows: Vec::with_capacity(grid.rows()),
            values: Vec::new(),
            velocities,
        };
        table.fill(&signals);
        table
    }

    fn fill(&mut self, signals: &[Vec4]) {
        let grid = self.grid;
        let mut filter = PeriodicFilter::new(self.samples);
        let spectra: Vec<SignalSpectra> = signals.chunks_exact(self.samples).map(|s| filter.spectra(s)).collect();
        let bin_hz = 1.0 / self.period_s();
        for class in 0..=grid.classes.quasi_static() {
            let samples = grid.samples(class, self.period_s(), self.samples);
            filter.resample(samples);
            let dampings = if class < grid.classes.quasi_static() { DAMPINGS } else { 1 };
            let oscillators: Vec<Vec<Complex<f64>>> =
                (0..dampings).map(|d| grid.transfer(class, d, bin_hz).take(samples / 2 + 1).collect()).collect();
            for size in 0..SIZES {
                let felt: Vec<f64> = grid.admittances(class, size, bin_hz).take(samples / 2 + 1).collect();
                for oscillator in &oscillators {
                    let transfer = oscillator.iter().zip(&felt).map(|(response, felt)| response * felt);
                    let transfer: Vec<Complex<f32>> =
                        transfer.map(|f| Complex::new(f.re as f32, f.im as f32)).collect();
                    self.rows.push(TableRow { first: self.values.len(), samples });
                    spectra.iter().for_each(|spectra| filter.respond(spectra, &transfer, &mut self.values));
                }
            }
        }
    }

    /// Length of the wind's period, in seconds.
    pub fn period_s(&self) -> f64 {
        self.samples as f64 * f64::from(self.time_step_s)
    }

    /// The responses of a row of the [grid](OscillatorGrid::weights) at a place of the table, periodic in time, by a
    /// Catmull-Rom spline. Rows and columns beyond the last count as the last.
    pub fn response(&self, row: usize, place: &TablePlace) -> Vec4 {
        let row = self.rows[row.min(self.rows.len() - 1)];
        self.blend(row, place, &self.spline(place, row.samples))
    }

    /// The responses of some rows at a place, in place of what `out` held.
    pub fn responses(&self, place: &TablePlace, rows: &[u32], out: &mut Vec<Vec4>) {
        // Rows of a class, and often of some classes, have the same number of samples.
        let mut spline = self.spline(place, 1);
        let mut samples = 1;
        out.clear();
        out.extend(rows.iter().map(|&row| {
            let row = self.rows[(row as usize).min(self.rows.len() - 1)];
            if row.samples != samples {
                (spline, samples) = (self.spline(place, row.samples), row.samples);
            }
            self.blend(row, place, &spline)
        }));
    }

    /// The wind's velocity at a place, m/s in wind coordinates, by a Catmull-Rom spline.
    pub fn velocity(&self, place: &TablePlace) -> Vec3 {
        let spline = self.spline(place, self.samples);
        let of_column = |column: usize| {
            let start = column.min(self.columns - 1) * self.samples;
            spline.of(&self.velocities[start..start + self.samples])
        };
        place.sum(of_column).truncate()
    }

    fn blend(&self, row: TableRow, place: &TablePlace, spline: &SplinePlace) -> Vec4 {
        place.sum(|column| {
            let start = row.first + column.min(self.columns - 1) * row.samples;
            spline.of(&self.values[start..start + row.samples])
        })
    }

    /// A time in a series of so many samples a period.
    fn spline(&self, place: &TablePlace, samples: usize) -> SplinePlace {
        SplinePlace::new(place.tau_s / self.period_s() * samples as f64, samples)
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
    planner: FftPlanner<f32>,
    /// Samples of the signals.
    samples: usize,
    /// To so many samples.
    inverse: Arc<dyn Fft<f32>>,
    work: [Vec<Complex<f32>>; 2],
    scratch: Vec<Complex<f32>>,
}

impl PeriodicFilter {
    fn new(samples: usize) -> Self {
        let mut planner = FftPlanner::new();
        let inverse = planner.plan_fft_inverse(samples);
        Self { planner, samples, inverse, work: [Vec::new(), Vec::new()], scratch: Vec::new() }
    }

    fn spectra(&mut self, signals: &[Vec4]) -> SignalSpectra {
        let mut spectra: SignalSpectra = [
            signals.iter().map(|signal| Complex::new(signal.x, signal.y)).collect(),
            signals.iter().map(|signal| Complex::new(signal.z, signal.w)).collect(),
        ];
        let forward = self.planner.plan_fft_forward(self.samples);
        for spectrum in &mut spectra {
            forward.process(spectrum);
        }
        spectra
    }

    /// Chooses how many samples responses have from now on, at most as many as the signals.
    fn resample(&mut self, samples: usize) {
        self.inverse = self.planner.plan_fft_inverse(samples);
        self.scratch.resize(self.inverse.get_inplace_scratch_len(), Complex::ZERO);
        for work in &mut self.work {
            work.clear();
            work.resize(samples, Complex::ZERO);
        }
    }

    /// Appends the response to one column's signals. `transfer` has the bins from 0 to the middle.
    fn respond(&mut self, spectra: &SignalSpectra, transfer: &[Complex<f32>], out: &mut Vec<Vec4>) {
        // The transforms do not divide by the number of samples.
        let share = 1.0 / self.samples as f32;
        for (work, spectrum) in self.work.iter_mut().zip(spectra) {
            let count = work.len();
            work[0] = spectrum[0] * transfer[0] * share;
            for bin in 1..count.div_ceil(2) {
                let factor = transfer[bin] * share;
                work[bin] = spectrum[bin] * factor;
                work[count - bin] = spectrum[self.samples - bin] * factor.conj();
            }
            // The bin in the middle stands for both signs at once: it stays real, and of a longer series nothing is known of it.
            if count.is_multiple_of(2) {
                let is_whole = count == self.samples;
                work[count / 2] =
                    if is_whole { spectrum[count / 2] * (transfer[count / 2].re * share) } else { Complex::ZERO };
            }
            self.inverse.process_with_scratch(work, &mut self.scratch);
        }
        let [xy, zw] = &self.work;
        out.extend(xy.iter().zip(zw).map(|(xy, zw)| Vec4::new(xy.re, xy.im, zw.re, zw.im)));
    }
}

#[cfg(test)]
mod tests;
