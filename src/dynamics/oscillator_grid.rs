//! The unit oscillators of which a table holds the responses, and how a beam's response is put together from them.
//!
//! A beam's response to a wind depends on three numbers: its natural frequency `f_n`, the size `sigma` of what it carries
//! ([`admittance`]), and its damping ratio `xi`. A table over all three would be large. It has some twenty frequencies, of
//! which a beam takes the nearest, and for each three sizes and two damping ratios, between which it mixes:
//!
//! ```text
//! R = sum_ij s_i d_j R(f, x_i, xi_j),      s_1 + s_2 = 1,   d_1 + d_2 = 1
//! x = f_n sigma / U                        reduced size: 0.006, 0.043, 0.3
//! ```
//!
//! Between sizes the amplitude `|J|` is close to linear in `ln x`, even over steps of 7. The weights of the damping ratios
//! are those with which the mix has the variance of the beam's own resonance. For two oscillators of one frequency in
//! broad-band noise, `<R_i R_j> = 2 / (xi_i + xi_j)` up to a common factor, so `d` solves a quadratic equation.
//!
//! Both weights change with the wind and the season, not with time. A frequency between two classes is not mixed: weakly
//! damped oscillators of neighbouring frequencies beat against each other. Beams of two frequencies read two rows for each
//! (`two_modes.rs`).
//!
//! # Fast beams
//!
//! Beams of a [fast class](FrequencyClasses), above 3.6 Hz, would take samples that a whole wind's period makes too many of. Their
//! motion is put together from two bands, which meet at [a crossover](GustBands) of some 2 Hz:
//!
//! ```text
//! R = sum_i s_i L(x_i) + |J(x)| sum_j d_j H(f, xi_j)
//! ```
//!
//! - *Low band* `L`: below the crossover the beam follows its load without inertia, with the admittance of its size. What inertia
//!   would add there, `1 / (1 - (f/f_n)^2)`, is 34% at the crossover for a beam of 4 Hz. There the gusts are weak: 3% of the motion
//!   (at a damping ratio of 0.05 to 0.1), 1% at 7 Hz, and less than 1% of its size.
//! - *High band* `H`: above it an oscillator in fast gusts, which are the same everywhere but for the time at which they
//!   pass. All frequencies are felt with the admittance `|J|` at the natural one, where most of that motion is.
//!
//! Beams beyond the last fast class follow the high band, too, without inertia.

use super::{admittance::admittance, frequency_classes::FrequencyClasses};
use crate::wind::GustBands;
use rustfft::num_complex::Complex;

/// Sizes in the table.
pub(crate) const SIZES: usize = 3;
/// The least reduced size in the table. Beams that carry less count as of this one: `|J|` is above 0.95 then, up to their
/// natural frequency.
pub(crate) const LEAST_SIZE: f32 = 0.006;
/// Ratio of two sizes of the table. The greatest is 0.3, at which `|J|` is 0.1 at the natural frequency.
pub(crate) const SIZE_RATIO: f32 = 7.0;
/// Damping ratios in the table.
pub(crate) const DAMPINGS: usize = 2;
/// The greater of the two by what it is above the smaller: leaves in a storm come to some 0.3.
const DAMPING_SPAN: f32 = 0.35;
/// The least damping ratio of the table: an undamped oscillator has no steady state.
const LEAST_DAMPING_RATIO: f32 = 1e-3;
/// Winds slower than this count as of this speed, m/s: a calm has no gusts.
const LEAST_SPEED_M_S: f32 = 0.1;

/// The oscillators of a table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OscillatorGrid {
    /// The classes of natural frequency.
    pub classes: FrequencyClasses,
    /// The two damping ratios, the smaller first: that of the wood and the ground, below which none is.
    pub damping_ratios: [f32; DAMPINGS],
    /// Mean speed of the wind for which the sizes are, m/s.
    pub speed_m_s: f32,
    /// How fast the gusts of that wind lose their coherence with distance: `C` of [`admittance`].
    pub decay: f32,
    /// `|J|` at the natural frequency, for each size.
    pub(crate) natural_admittances: [f32; SIZES],
}

/// What a beam reads of a table: four of its rows with their weights.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RowWeights {
    /// Rows: of two sizes and for each of the two damping ratios; for a fast beam of two sizes in the low band, then of the two damping
    /// ratios in the high one. For a beam of two modes two rows of each: of both damping ratios, or, where it is fast, of each band.
    pub rows: [u32; 4],
    /// Weights of these rows. Without those of the high band they add up to 1; for a fast beam those of the high band to `|J|`.
    pub weights: [f32; 4],
}

/// A mode of a beam, as [`OscillatorGrid::weights`] has it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct GridMode {
    pub class: f32,
    pub averaging_speed_m_s: f32,
    pub damping_ratio: f32,
}

/// Number of rows of a grid of these classes.
pub(crate) fn row_count(classes: &FrequencyClasses) -> usize {
    let (slow, fast) = (classes.first_fast(), classes.quasi_static() - classes.first_fast());
    slow * SIZES * DAMPINGS + SIZES + fast * DAMPINGS + 1
}

impl OscillatorGrid {
    /// A grid for a wind of some mean speed, m/s, and for beams whose structure alone has a damping ratio.
    #[must_use]
    pub fn new(classes: FrequencyClasses, structural_damping_ratio: f32, speed_m_s: f32, decay: f32) -> Self {
        let least = structural_damping_ratio.max(LEAST_DAMPING_RATIO);
        Self {
            classes,
            damping_ratios: [least, least + DAMPING_SPAN],
            speed_m_s: speed_m_s.max(LEAST_SPEED_M_S),
            decay,
            natural_admittances: std::array::from_fn(|size| admittance(reduced_size(size), f64::from(decay)) as f32),
        }
    }

    /// Number of rows.
    #[must_use]
    pub fn rows(&self) -> usize {
        row_count(&self.classes)
    }

    /// The row of an oscillator of a slow class.
    pub(crate) fn row(&self, class: usize, size: usize, damping: usize) -> usize {
        (class * SIZES + size) * DAMPINGS + damping
    }

    /// The row of fast beams of some size in the low band.
    pub(crate) fn low_row(&self, size: usize) -> usize {
        self.classes.first_fast() * SIZES * DAMPINGS + size
    }

    /// The row of a fast class in the high band. Damping makes no difference to the quasi-static class.
    pub(crate) fn high_row(&self, class: usize, damping: usize) -> usize {
        let damping = if class < self.classes.quasi_static() { damping } else { 0 };
        self.low_row(SIZES) + (class - self.classes.first_fast()) * DAMPINGS + damping
    }

    /// The rows of a beam: its natural frequency as a [coordinate](FrequencyClasses::coordinate), its frequency times its
    /// size, m/s, by the mean speed at its height over that of the table's wind, and its damping ratio.
    #[must_use]
    pub fn weights(&self, class: f32, averaging_speed_m_s: f32, damping_ratio: f32) -> RowWeights {
        let nearest = self.classes.nearest(class);
        let first_fast = self.classes.first_fast();
        let (first, larger) = self.size_mix(averaging_speed_m_s, self.rounding(class));
        let damped = self.damped_share(damping_ratio);
        if nearest < first_fast {
            let row = |size, damping| self.row(nearest, first + size, damping) as u32;
            return RowWeights {
                rows: [row(0, 0), row(0, 1), row(1, 0), row(1, 1)],
                weights: [
                    (1.0 - larger) * (1.0 - damped),
                    (1.0 - larger) * damped,
                    larger * (1.0 - damped),
                    larger * damped,
                ],
            };
        }
        let felt = self.natural_admittance(averaging_speed_m_s);
        let low = self.low_row(first);
        let rows = [low, low + 1, self.high_row(nearest, 0), self.high_row(nearest, 1)];
        RowWeights {
            rows: rows.map(|row| row as u32),
            weights: [1.0 - larger, larger, felt * (1.0 - damped), felt * damped],
        }
    }

    /// The row's own frequency is not quite the beam's: the logarithm of their ratio. All fast beams share the sizes of the first fast class.
    fn rounding(&self, class: f32) -> f32 {
        (self.classes.nearest(class).min(self.classes.first_fast()) as f32 - class) * self.classes.ratio.ln()
    }

    /// The smaller of the two sizes about a beam's own, and the weight of the larger. `rounding` is what is added to the logarithm
    /// of its reduced size.
    fn size_mix(&self, averaging_speed_m_s: f32, rounding: f32) -> (usize, f32) {
        let size = ((averaging_speed_m_s / (LEAST_SIZE * self.speed_m_s)).ln() + rounding) / SIZE_RATIO.ln();
        let size = if size > 0.0 { size.min((SIZES - 1) as f32) } else { 0.0 };
        let first = (size as usize).min(SIZES - 2);
        (first, size - first as f32)
    }

    /// `|J|` of a beam at its natural frequency, mixed as sizes are.
    fn natural_admittance(&self, averaging_speed_m_s: f32) -> f32 {
        self.admittance_of(self.size_mix(averaging_speed_m_s, 0.0))
    }

    fn admittance_of(&self, (first, larger): (usize, f32)) -> f32 {
        self.natural_admittances[first] * (1.0 - larger) + self.natural_admittances[first + 1] * larger
    }

    /// Coefficients `a`, `b`, `c` with which the share of the greater damping ratio is `a - sqrt(b + c / xi)`: the
    /// root of the quadratic equation of the module's page.
    pub(crate) fn damping_mix(&self) -> [f32; 3] {
        let [low, high] = self.damping_ratios.map(f64::from);
        let (of_low, of_high, of_both) = (1.0 / low, 1.0 / high, 2.0 / (low + high));
        let square = of_low + of_high - 2.0 * of_both;
        let half = of_low - of_both;
        let middle = half / square;
        [middle, middle * middle - of_low / square, 1.0 / square].map(|coefficient| coefficient as f32)
    }

    /// The weight of the greater damping ratio for a beam's own.
    pub(crate) fn damped_share(&self, damping_ratio: f32) -> f32 {
        let [low, high] = self.damping_ratios;
        let [a, b, c] = self.damping_mix();
        let ratio = if damping_ratio > low { damping_ratio.min(high) } else { low };
        (a - (b + c / ratio).max(0.0).sqrt()).clamp(0.0, 1.0)
    }

    /// Admittance of the rows of a class and a size, at the bins of a period from 0 up. Of the first fast class: that of the low band.
    pub fn admittances(&self, class: usize, size: usize, bin_hz: f64) -> impl Iterator<Item = f64> + use<> {
        let step = reduced_size(size) * bin_hz / self.class_hz(class);
        let decay = f64::from(self.decay);
        (0..).map(move |bin| admittance(f64::from(bin) * step, decay))
    }

    /// Transfer function of an oscillator from the load that it feels to its response (eq. 21), at the bins of a period from
    /// 0 up. The quasi-static class follows the load as it is.
    pub(crate) fn transfer(
        &self,
        class: usize,
        damping: usize,
        bin_hz: f64,
    ) -> impl Iterator<Item = Complex<f64>> + use<> {
        let is_quasi_static = class >= self.classes.quasi_static();
        let step = if is_quasi_static { 0.0 } else { bin_hz / self.class_hz(class) };
        let damping_ratio = f64::from(self.damping_ratios[damping]);
        (0..).map(move |bin| {
            let ratio = f64::from(bin) * step;
            Complex::new(1.0 - ratio * ratio, 2.0 * damping_ratio * ratio).inv()
        })
    }

    /// Frequency of a class; of the quasi-static one the lowest that it stands for, Hz.
    fn class_hz(&self, class: usize) -> f64 {
        f64::from(self.classes.lowest_hz) * f64::from(self.classes.ratio).powi(class as i32)
    }

    /// Samples that a row of a class needs for a period, a power of two: seven for each period of its natural frequency, and
    /// at most `available`. The cubic through them loses 1% of an oscillation at that frequency, and what is faster is weak.
    pub(crate) fn samples(&self, class: usize, period_s: f64, available: usize) -> usize {
        const PER_CYCLE: f64 = 7.0;
        if class < self.classes.quasi_static() {
            thinned(PER_CYCLE * self.class_hz(class) * period_s, available)
        } else {
            available
        }
    }

    /// Samples that a row of the low band needs for a period, likewise: at the crossover the cubic loses 7%, of the whole band less
    /// than 0.2% of the power, since its gusts are the weaker the faster they are.
    pub(crate) fn low_samples(&self, period_s: f64, available: usize) -> usize {
        const PER_CYCLE: f64 = 3.7;
        thinned(PER_CYCLE * GustBands::of_period(period_s).crossover_hz * period_s, available)
    }
}

fn reduced_size(size: usize) -> f64 {
    f64::from(LEAST_SIZE * SIZE_RATIO.powi(size as i32))
}

/// A power of two of samples that is at least `needed`, and at most `available`.
fn thinned(needed: f64, available: usize) -> usize {
    // A period that is not a power of two of samples is not thinned.
    if available.is_power_of_two() && needed < available as f64 {
        (needed.ceil() as usize).max(1).next_power_of_two()
    } else {
        available
    }
}

#[cfg(test)]
mod tests;
mod two_modes;
