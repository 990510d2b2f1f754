//! The wind between the columns of the field, and beyond its last one.
//!
//! The columns lie some metres apart, and gusts lose their coherence within a metre or two. So what blows between two
//! columns cannot be interpolated in the usual sense: it is made to have the right statistics.
//!
//! 1. *Power.* Four columns are blended by weights whose sum is 1 and the sum of whose squares is nearly 1
//!    (`weights_across` of `interpolation`). The first keeps the variance of slow gusts, which the columns share, the second that of fast
//!    ones, which they do not. In between, too, the power at a random place is right to 2% at every frequency.
//! 2. *Coherence.* Each cell between two columns has a lag, which grows and falls across it: `lag_j sin(2 pi s)`. It is
//!    nothing on the columns, and so the field stays as it was synthesised there. Fast gusts lose their coherence by it, slow
//!    ones do not. Over many cells the lags are spread so that pairs of places have the coherence `exp(-C f d / U)`
//!    (Setas et al., equations 11 and 12) to some 0.04, for u. The spread is fitted to that.
//! 3. *Repeat.* After the last column comes the first one again, but later: fronts are slanted. Without the slant the same gust
//!    would blow at the same moment at every width of the field.
//!
//! `render/shaders/wind.wesl` does the same.

use super::interpolation::BlendTaps;
use std::f32::consts::TAU;

/// The tangent of the angle between fronts and the line across the wind. Chosen: a share of the golden section, so that few
/// widths add up to whole periods, and small enough that coherence suffers by less than 0.02.
const SLANT: f32 = 0.381_966;

/// The lags of cells over `C L / U`, the time in which columns L apart lose their coherence. Fitted.
const LAG_SHARE: f32 = 0.084;

/// How a field is read across the wind.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LateralRule {
    columns: usize,
    spacing_m: f32,
    /// How much later the field passes a place one metre farther across, s/m.
    pub slowness_s_m: f32,
    /// The scale of the lags in cells, s.
    pub lag_s: f32,
}

impl LateralRule {
    /// For a field of `columns` that are `spacing_m` apart, which drifts at `speed_m_s` > 0 and loses its coherence across
    /// with the coefficient `decay` of equation 12.
    pub fn new(columns: usize, spacing_m: f32, speed_m_s: f32, decay: f32) -> Self {
        let lag_s = LAG_SHARE * decay * spacing_m / speed_m_s;
        Self { columns, spacing_m, slowness_s_m: SLANT / speed_m_s, lag_s }
    }

    /// The columns about a place `across_m` across the wind, and their weights.
    pub fn taps(&self, across_m: f32) -> BlendTaps {
        BlendTaps::across(f64::from(across_m) / f64::from(self.spacing_m), self.columns)
    }

    /// How much later than in the first column the field passes a place `across_m` across the wind, s.
    pub fn delay_s(&self, across_m: f32) -> f64 {
        let across_m = if across_m.is_finite() { across_m } else { 0.0 };
        let place = f64::from(across_m) / f64::from(self.spacing_m);
        let cell = place.floor();
        let within = (place - cell) as f32;
        let lag_s = self.lag_s * lag_of_cell(cell as i32) * (TAU * within).sin();
        f64::from(self.slowness_s_m) * f64::from(across_m) + f64::from(lag_s)
    }
}

/// The lag of a cell over the scale: a random number of a symmetric law with heavy tails, of size 1.
fn lag_of_cell(cell: i32) -> f32 {
    let share = ((hash(cell as u32) & 255) as f32 + 0.5) / 256.0;
    (2.0 * share - 1.0) / (4.0 * share * (1.0 - share)).sqrt().sqrt()
}

/// A random number of 32 bits: PCG-RXS-M-XS (O'Neill 2014).
fn hash(number: u32) -> u32 {
    let state = number.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    (word >> 22) ^ word
}

#[cfg(test)]
mod tests {
    use super::*;

    fn default_rule() -> LateralRule {
        LateralRule::new(16, 8.0, 8.0, 10.0)
    }

    #[test]
    fn columns_are_only_slanted() {
        let rule = default_rule();
        for column in [-40, -1, 0, 1, 16, 900] {
            let across_m = 8.0 * column as f32;
            let slanted_s = f64::from(rule.slowness_s_m) * f64::from(across_m);
            assert!((rule.delay_s(across_m) - slanted_s).abs() < 1e-5);
            let taps = rule.taps(across_m);
            assert_eq!(taps.indices[1], i32::rem_euclid(column, 16) as usize);
            assert!((taps.weights[1] - 1.0).abs() < 1e-6);
        }
    }

    #[test]
    fn delay_is_continuous_and_its_lags_are_bounded() {
        let rule = default_rule();
        let mut before = rule.delay_s(-200.0);
        for step in 1..40_000 {
            let across_m = -200.0 + 0.01 * step as f32;
            let delay_s = rule.delay_s(across_m);
            // The steepest lag of all is 3.4 of the scale, 1 s, and turns once in 8 m.
            assert!((delay_s - before).abs() < 0.01 * 2.9, "{delay_s} after {before} at {across_m}");
            assert!((delay_s - f64::from(rule.slowness_s_m * across_m)).abs() < 3.5);
            before = delay_s;
        }
        assert!([f32::NAN, f32::INFINITY, f32::MAX].map(|bad| rule.delay_s(bad)).iter().all(|delay| delay.is_finite()));
    }

    #[test]
    fn lags_of_cells_are_symmetric_with_heavy_tails() {
        let lags: Vec<f32> = (-20_000..20_000).map(lag_of_cell).collect();
        let mean = |value: fn(f32) -> f32| lags.iter().map(|&lag| value(lag)).sum::<f32>() / lags.len() as f32;
        // 40000 independent numbers of size 1: means to 0.5%.
        assert!(mean(|lag| lag).abs() < 0.02);
        let (square, fourth) = (mean(|lag| lag.powi(2)), mean(|lag| lag.powi(4)));
        // Sums over the 256 shares, computed beforehand in Python: 0.7475 and 2.421.
        assert!((square - 0.7475).abs() < 0.03, "{square}");
        assert!((fourth - 2.421).abs() < 0.3, "{fourth}");
    }

    #[test]
    fn full_coherence_has_no_lags() {
        let rule = LateralRule::new(16, 8.0, 8.0, 0.0);
        assert!((rule.delay_s(3.3) - f64::from(rule.slowness_s_m * 3.3)).abs() < 1e-6);
    }
}
