//! What a beam of two frequencies reads: two rows for each of its modes, with their shares as weights.
//!
//! Four rows are what a pose reads, for two sizes and two damping ratios. With two rows a mode has one of the two mixed, and that is
//! the damping: the two ratios are so far apart (0.05 and 0.4) that the nearer one alone would be off by a factor of 1.7 in the motion
//! at resonance. Of the sizes it takes the nearest. That may feel 1.7 times as much of the gusts at the natural frequency, and
//! little more of slower ones. So the damping ratio makes up for it: with the power of a resonance, `|J|^2 / xi`, as that of the mode's own size,
//!
//! ```text
//! xi' = xi (|J(x_i)| / |J(x)|)^2
//! ```
//!
//! A fast mode takes the nearest size in the low band, and in the high band, where there is nothing but resonance, the less damped row, by
//! `sqrt(xi_1 / xi)`.
//!
//! Over sizes, damping ratios and shares such mixes sway as far as both oscillators to 1.8% rms, 6% at worst, no worse than four rows do for one.

use super::{DAMPINGS, GridMode, OscillatorGrid, RowWeights};

impl OscillatorGrid {
    /// The rows of a beam of two modes, of which the second has a share of the motion, 0 to 1.
    pub(crate) fn weights_of_two(&self, modes: [GridMode; 2], second_share: f32) -> RowWeights {
        let second_share = second_share.clamp(0.0, 1.0);
        let [(rows, weights), (second_rows, second_weights)] = modes.map(|mode| self.two_rows(&mode));
        let [a, b] = weights.map(|weight| weight * (1.0 - second_share));
        let [c, d] = second_weights.map(|weight| weight * second_share);
        RowWeights { rows: [rows[0], rows[1], second_rows[0], second_rows[1]], weights: [a, b, c, d] }
    }

    fn two_rows(&self, mode: &GridMode) -> ([u32; 2], [f32; DAMPINGS]) {
        let nearest = self.classes.nearest(mode.class);
        let (first, larger) = self.size_mix(mode.averaging_speed_m_s, self.rounding(mode.class));
        let size = first + usize::from(larger >= 0.5);
        if nearest < self.classes.first_fast() {
            let more = self.natural_admittances[size] / self.admittance_of((first, larger));
            let damped = self.damped_share(mode.damping_ratio * more * more);
            let rows = [0, 1].map(|damping| self.row(nearest, size, damping) as u32);
            return (rows, [1.0 - damped, damped]);
        }
        let least = self.damping_ratios[0];
        let is_resonant = nearest < self.classes.quasi_static() && mode.damping_ratio > least;
        let damped = if is_resonant { (least / mode.damping_ratio).sqrt() } else { 1.0 };
        let felt = self.natural_admittance(mode.averaging_speed_m_s);
        ([self.low_row(size) as u32, self.high_row(nearest, 0) as u32], [1.0, felt * damped])
    }
}
