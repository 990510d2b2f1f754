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
//! Slow oscillators leave nothing of fast gusts: their rows have fewer samples. Rows of the low band, which fast beams read
//! ([`oscillator_grid`](super::oscillator_grid)), have nothing above the crossover. Rows of the high band have nothing below it, no columns,
//! and a [short period](GustBands) of their own: all places read the same fast gusts, each at its time.
//!
//! What this leaves out, as relative rms of the moving part (`validate basis`):
//!
//! - The time step bounds the frequencies: a cubic through the samples wants four of them a period, so a step of 1/16 s
//!   serves oscillations up to 4 Hz. The spline loses 0.2% at 1 Hz, 1% at 2.2 Hz and 3% at 3.3 Hz, the highest slow class.
//! - Fast gusts blow on the mean wind, with the root mean square of its speed: their loads have the right power, and do not
//!   come in bursts with slow gusts. They are another realisation than the gusts of the field. What twigs of 4 to 12 Hz do above the
//!   crossover has the right size to 2% in the median, 12% at most in 19 of 20, over turbulence intensities of 0.1 to 0.6.
//! - Rounding to a class moves a beam's frequency by up to 10%, less than the natural spread of wood's stiffness, and so
//!   shifts the phase of its sway: 22% from the motion of the exact frequency in the median, though equal in its
//!   statistics.

use super::{
    load_basis::LoadBasis,
    oscillator_grid::{DAMPINGS, OscillatorGrid, SIZES},
    periodic_filter::{PeriodicFilter, SignalSpectra},
    table_place::{SplinePlace, TablePlace},
};
use crate::wind::GustBands;
use bevy::math::{Vec3, Vec4};
use rustfft::num_complex::Complex;
use std::ops::Range;

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
    /// How its gusts are divided.
    pub(crate) bands: GustBands,
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
    /// Whether it is of the high band: one column for all places, and the short period.
    pub is_high: bool,
}

impl ResponseTable {
    /// The steady response to a periodic wind. `columns` are its velocities in m/s in wind coordinates, one series of a
    /// whole period, `time_step_s` apart, for each lateral place; all count as long as the shortest, and an empty wind is
    /// a calm. `fast_gusts` are one [short period](GustBands) of turbulence above the crossover
    /// ([`WindField::fast_gusts`](crate::wind::WindField::fast_gusts)), m/s, evenly spaced; without any, fast beams answer slow gusts
    /// alone. Velocities that are not finite count as calm.
    pub fn new(
        columns: &[Vec<Vec3>],
        time_step_s: f32,
        fast_gusts: &[Vec3],
        basis: &LoadBasis,
        grid: OscillatorGrid,
    ) -> Self {
        let calm = [vec![Vec3::ZERO]];
        let samples = columns.iter().map(Vec::len).min().unwrap_or(0);
        let columns = if samples == 0 { &calm[..] } else { columns };
        let samples = samples.max(1);
        let time_step_s = if time_step_s > 0.0 && time_step_s.is_finite() { time_step_s } else { 1.0 };
        let velocities: Vec<Vec4> = columns.iter().flat_map(|c| c[..samples].iter().map(|&v| with_speed(v))).collect();
        let signals: Vec<Vec4> = velocities.iter().map(|velocity| basis.signals(velocity.truncate())).collect();
        let fast_signals = fast_signals(fast_gusts, &velocities, basis);
        let mut table = Self {
            grid,
            columns: columns.len(),
            samples,
            time_step_s,
            bands: GustBands::of_period(samples as f64 * f64::from(time_step_s)),
            rows: Vec::with_capacity(grid.rows()),
            values: Vec::new(),
            velocities,
        };
        let mut filter = PeriodicFilter::new(samples);
        let spectra: Vec<SignalSpectra> = signals.chunks_exact(samples).map(|s| filter.spectra(s)).collect();
        table.add_slow_rows(&mut filter, &spectra);
        table.add_low_rows(&mut filter, &spectra);
        table.add_high_rows(&fast_signals);
        table
    }

    fn add_slow_rows(&mut self, filter: &mut PeriodicFilter, spectra: &[SignalSpectra]) {
        let grid = self.grid;
        let bin_hz = 1.0 / self.period_s();
        for class in 0..grid.classes.first_fast() {
            let samples = grid.samples(class, self.period_s(), self.samples);
            filter.resample(samples);
            let oscillators: [Vec<Complex<f64>>; DAMPINGS] =
                std::array::from_fn(|d| grid.transfer(class, d, bin_hz).take(samples / 2 + 1).collect());
            for size in 0..SIZES {
                let felt: Vec<f64> = grid.admittances(class, size, bin_hz).take(samples / 2 + 1).collect();
                for oscillator in &oscillators {
                    self.add_row(filter, spectra, oscillator.iter().zip(&felt).map(|(o, felt)| o * felt), false);
                }
            }
        }
    }

    fn add_low_rows(&mut self, filter: &mut PeriodicFilter, spectra: &[SignalSpectra]) {
        let grid = self.grid;
        let bin_hz = 1.0 / self.period_s();
        let samples = grid.low_samples(self.period_s(), self.samples);
        filter.resample(samples);
        let slow_bins = (self.bands.crossover_hz / bin_hz).floor() as usize + 1;
        for size in 0..SIZES {
            let felt = grid.admittances(grid.classes.first_fast(), size, bin_hz).take(slow_bins).map(Complex::from);
            let below = felt.chain(std::iter::repeat(Complex::ZERO));
            self.add_row(filter, spectra, below.take(samples / 2 + 1), false);
        }
    }

    fn add_high_rows(&mut self, fast_signals: &[Vec4]) {
        let grid = self.grid;
        let GustBands { crossover_hz, short_period_s } = self.bands;
        let mut filter = PeriodicFilter::new(fast_signals.len());
        let spectra = [filter.spectra(fast_signals)];
        let bin_hz = 1.0 / short_period_s;
        let slow_bins = (crossover_hz / bin_hz).ceil() as usize;
        for class in grid.classes.first_fast()..=grid.classes.quasi_static() {
            let samples = grid.samples(class, short_period_s, fast_signals.len());
            filter.resample(samples);
            let dampings = if class < grid.classes.quasi_static() { DAMPINGS } else { 1 };
            for damping in 0..dampings {
                let oscillator = grid.transfer(class, damping, bin_hz).enumerate();
                // Drag is not linear: some of what fast gusts do is slow. That is left to the low band.
                let above = oscillator.map(|(bin, o)| if bin < slow_bins { Complex::ZERO } else { o });
                self.add_row(&mut filter, &spectra, above.take(samples / 2 + 1), true);
            }
        }
    }

    /// Adds the responses of all columns by a transfer function, given at the bins from 0 to the middle.
    fn add_row(
        &mut self,
        filter: &mut PeriodicFilter,
        spectra: &[SignalSpectra],
        transfer: impl Iterator<Item = Complex<f64>>,
        is_high: bool,
    ) {
        let transfer: Vec<Complex<f32>> = transfer.map(|f| Complex::new(f.re as f32, f.im as f32)).collect();
        let first = self.values.len();
        spectra.iter().for_each(|spectra| filter.respond(spectra, &transfer, &mut self.values));
        self.rows.push(TableRow { first, samples: filter.samples(), is_high });
    }

    /// Length of the wind's period, in seconds.
    pub fn period_s(&self) -> f64 {
        self.samples as f64 * f64::from(self.time_step_s)
    }

    /// All responses of some rows.
    pub(crate) fn values_of(&self, rows: Range<usize>) -> &[Vec4] {
        let start = |row: usize| self.rows.get(row).map_or(self.values.len(), |row| row.first);
        &self.values[start(rows.start)..start(rows.end)]
    }

    /// The responses of a row of the [grid](OscillatorGrid::weights) at a place of the table, periodic in time, by a
    /// Catmull-Rom spline. Rows and columns beyond the last count as the last.
    pub fn response(&self, row: usize, place: &TablePlace) -> Vec4 {
        let row = self.rows[row.min(self.rows.len() - 1)];
        self.blend(row, place, &self.spline(place, row.samples, row.is_high))
    }

    /// The responses of some rows at a place, in place of what `out` held.
    pub fn responses(&self, place: &TablePlace, rows: &[u32], out: &mut Vec<Vec4>) {
        // Rows of a class, and often of some classes, have the same number of samples.
        let mut of_spline = (1, false);
        let mut spline = self.spline(place, 1, false);
        out.clear();
        out.extend(rows.iter().map(|&row| {
            let row = self.rows[(row as usize).min(self.rows.len() - 1)];
            if (row.samples, row.is_high) != of_spline {
                of_spline = (row.samples, row.is_high);
                spline = self.spline(place, row.samples, row.is_high);
            }
            self.blend(row, place, &spline)
        }));
    }

    /// The wind's velocity at a place, m/s in wind coordinates, by a Catmull-Rom spline. Without fast gusts.
    pub fn velocity(&self, place: &TablePlace) -> Vec3 {
        let spline = self.spline(place, self.samples, false);
        let of_column = |column: usize| {
            let start = column.min(self.columns - 1) * self.samples;
            spline.of(&self.velocities[start..start + self.samples])
        };
        place.sum(of_column).truncate()
    }

    fn blend(&self, row: TableRow, place: &TablePlace, spline: &SplinePlace) -> Vec4 {
        if row.is_high {
            return spline.of(&self.values[row.first..row.first + row.samples]);
        }
        place.sum(|column| {
            let start = row.first + column.min(self.columns - 1) * row.samples;
            spline.of(&self.values[start..start + row.samples])
        })
    }

    /// A time in a series of so many samples a period.
    fn spline(&self, place: &TablePlace, samples: usize, is_high: bool) -> SplinePlace {
        let periods =
            if is_high { place.fast_tau_s / self.bands.short_period_s } else { place.tau_s / self.period_s() };
        SplinePlace::new(periods * samples as f64, samples)
    }
}

fn with_speed(velocity: Vec3) -> Vec4 {
    let velocity = finite_or_calm(velocity);
    velocity.extend(velocity.length())
}

fn finite_or_calm(velocity: Vec3) -> Vec3 {
    if velocity.is_finite() { velocity } else { Vec3::ZERO }
}

/// What fast gusts add to the basis signals. They blow on the mean of the slow wind, at the root mean square of its speed: a gust adds to the
/// load in proportion to the speed, so that is where the load has its power. At a turbulence intensity of 0.6 the mean speed itself would be
/// too low by a fifth.
fn fast_signals(fast_gusts: &[Vec3], slow: &[Vec4], basis: &LoadBasis) -> Vec<Vec4> {
    if fast_gusts.is_empty() {
        return vec![Vec4::ZERO];
    }
    let share = 1.0 / slow.len() as f32;
    let mean = slow.iter().map(|velocity| velocity.truncate() * share).sum::<Vec3>();
    let mean_square = slow.iter().map(|velocity| velocity.w * velocity.w * share).sum::<f32>();
    let carrier = mean.normalize_or_zero() * mean_square.sqrt();
    let at_rest = basis.signals(carrier);
    fast_gusts.iter().map(|&gust| basis.signals(carrier + finite_or_calm(gust)) - at_rest).collect()
}

#[cfg(test)]
mod tests;
