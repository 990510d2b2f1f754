//! The frequency at which a branch resonates with all that it carries, which bends and twists as well.
//!
//! In a wind that swings with the angular frequency `w` every piece of a tree is held by its hinge and by the inertia of what is beyond.
//! Seen from a point, all of that is one body with the symmetric dynamic stiffness
//!
//! ```text
//! (f, m) = D (u, phi) - b,    D = [F C; C^T R],    of a rigid body: D = -z [M, -M r x; M r x, -M (r x)^2]
//! ```
//!
//! for forces and moments that move and turn it, with `z = w^2 / (1 + 2 i zeta)` for a damping ratio `zeta` of all hinges. A hinge of
//! the stiffness `K` (a matrix) frees the body beyond it from turning with the one before (the articulated bodies of
//! Featherstone 1983, for frequencies in place of time):
//!
//! ```text
//! S = (K + R)^-1,  N = R + [M x]/2,   F - C S C^T,  C - C S N^T,  R - N S N^T,   b_f - C S b_m,  b_m - N S b_m
//! ```
//!
//! `M` is the moment of the weight at the hinge, and `R` has the stiffness that weight gives each piece (`statics.rs`).
//!
//! So one pass from the twigs to the ground tells how all branches of a tree answer at a frequency, each of them held fast where it
//! grows: the deflection of a place at two thirds of its length is a linear function of the motion of the piece that bears it,
//! and goes down the branch by the same rules as the loads. Work grows with the number of beams. Branches that bear none, which are most of
//! them, are not worked out anew for each frequency (`twig.rs`).
//!
//! Resonance is where the deflection lags behind the wind most, in the sense of its imaginary part: every mode adds its share of the static
//! deflection there, over the width of a damped resonance. Branches as fast as the one that carries them divide its mode in many;
//! that is one peak again. Of two peaks, as of a stem that is bent and sways along two axes, the one counts by which gusts move it
//! further: their amplitude is as `sqrt(f S(f)) ~ f^(-1/3)`, with Kolmogorov's spectrum `S ~ f^(-5/3)`.

use super::{articulated::Articulated, bodies::Bodies, branches::LoadedBranch, four::Four, response::BranchResponse};
use bevy::math::Vec4;
use std::f64::consts::TAU;

/// Damping ratio of the peaks, that of branches in a moderate wind: what is nearer together than some 15% is one peak.
const DAMPING_RATIO: f32 = 0.12;
/// The frequencies that are tried: the lowest by that of the slowest branch, the natural logarithm of the ratio of neighbours, and
/// how many fours of them.
const LOWEST_SHARE: f64 = 0.6;
const STEP: f64 = 0.17;
const FOURS: usize = 4;
const FREQUENCIES: usize = 4 * FOURS;
/// Amplitude of gusts as a power of their frequency.
const GUST_EXPONENT: f64 = -1.0 / 3.0;

/// The natural frequency of each branch, Hz; none of those that bear no other, and where no peak is within the frequencies that are tried.
pub(super) fn resonances_hz(branches: &[LoadedBranch], responses: &[BranchResponse]) -> Vec<Option<f64>> {
    let bodies = Bodies::new(branches);
    let lowest_hz = lowest_hz(branches, responses);
    let mut lags = vec![[0.0; FREQUENCIES]; bodies.len()];
    let mut articulated = vec![Articulated::default(); bodies.len()];
    for four in 0..FOURS {
        let z = stiffness_ratio(lowest_hz, four);
        for (index, lags) in lags.iter_mut().enumerate().rev() {
            let answer = bodies.sway(index, z, &mut articulated);
            // Hinges of the stiffness K (1 + 2 i zeta) in place of K.
            let lag = answer.re * (2.0 * DAMPING_RATIO) - answer.im;
            lags[4 * four..4 * four + 4].copy_from_slice(&lag.to_array());
        }
    }
    let mut frequencies_hz = vec![None; branches.len()];
    for (lags, branch) in lags.iter().zip(bodies.branches()) {
        frequencies_hz[branch] = peak(lags).map(|by_lowest| lowest_hz * by_lowest);
    }
    frequencies_hz
}

/// `z` at four frequencies.
fn stiffness_ratio(lowest_hz: f64, four: usize) -> Four {
    let square = Vec4::from_array(std::array::from_fn(|lane| {
        (TAU * lowest_hz * ratio((4 * four + lane) as f64)).powi(2) as f32
    }));
    let norm = 1.0 + 4.0 * DAMPING_RATIO * DAMPING_RATIO;
    Four { re: square / norm, im: square * (-2.0 * DAMPING_RATIO / norm) }
}

fn ratio(index: f64) -> f64 {
    (STEP * index).exp()
}

/// Where to begin: well below the slowest branch that bears others, were these rigid.
fn lowest_hz(branches: &[LoadedBranch], responses: &[BranchResponse]) -> f64 {
    let bearing = branches.iter().zip(responses).filter(|(branch, _)| branch.bears);
    let slowest_hz = bearing.map(|(branch, response)| response.sway.rigid_hz(branch)).fold(f64::INFINITY, f64::min);
    if slowest_hz.is_finite() { LOWEST_SHARE * slowest_hz } else { 1.0 }
}

/// Where gusts move a branch most, by the lowest frequency; none where that is beyond the frequencies that are tried.
fn peak(lags: &[f32; FREQUENCIES]) -> Option<f64> {
    let (mut gust, weaker) = (1.0, ratio(GUST_EXPONENT));
    let motions = lags.map(|lag| {
        let motion = f64::from(lag) * gust;
        gust *= weaker;
        motion
    });
    let is_highest = |&index: &usize| motions[index] >= motions[index - 1] && motions[index] > motions[index + 1];
    let modes = (1..FREQUENCIES - 1).filter(is_highest).map(|index| mode_near(lags, index));
    let modes = modes.filter(|mode| mode.motion > 0.0 && mode.motion.is_finite());
    let strongest = modes.max_by(|a, b| a.motion.total_cmp(&b.motion))?;
    let at_ends = motions[0].max(motions[FREQUENCIES - 1]);
    (strongest.motion >= at_ends).then_some(strongest.frequency)
}

struct Mode {
    /// By the lowest that is tried.
    frequency: f64,
    /// Of the sensor in gusts.
    motion: f64,
}

/// The mode of which these lags are, at a sample and its neighbours. That of one mode is `c f / ((f_n^2 - f^2)^2 + (2 zeta f_n f)^2)`,
/// so that `f` over it is a polynomial of the second degree in `f^2`: three samples tell all of it.
fn mode_near(lags: &[f32; FREQUENCIES], index: usize) -> Mode {
    let x: [f64; 3] = std::array::from_fn(|k| ratio((index + k - 1) as f64).powi(2));
    let y: [f64; 3] = std::array::from_fn(|k| x[k].sqrt() / f64::from(lags[index + k - 1]));
    let slopes = [(y[1] - y[0]) / (x[1] - x[0]), (y[2] - y[1]) / (x[2] - x[1])];
    let curvature = (slopes[1] - slopes[0]) / (x[2] - x[0]);
    let lowest = 0.5 * (x[0] + x[1] - slopes[0] / curvature);
    let natural = lowest / (1.0 - 2.0 * f64::from(DAMPING_RATIO).powi(2));
    // Where several modes run together these are not one's lags.
    let square = if curvature > 0.0 { natural.clamp(x[0], x[2]) } else { x[1] };
    let there = y[0] + (slopes[0] + curvature * (square - x[1])) * (square - x[0]);
    let frequency = square.sqrt();
    Mode { frequency, motion: frequency / there * frequency.powf(GUST_EXPONENT) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Lags of modes of these frequencies (by the lowest that is tried) and shares.
    fn lags(modes: &[(f64, f64)]) -> [f32; FREQUENCIES] {
        let lag = |frequency: f64| -> f64 {
            let of_mode = |&(natural, share): &(f64, f64)| {
                let r = frequency / natural;
                let damping = 2.0 * f64::from(DAMPING_RATIO) * r;
                share * damping / ((1.0 - r * r).powi(2) + damping * damping)
            };
            modes.iter().map(of_mode).sum()
        };
        std::array::from_fn(|index| lag(ratio(index as f64)) as f32)
    }

    #[test]
    fn one_mode_is_found_exactly() {
        for natural in [1.5, 2.0, 3.3, 5.0, 9.0] {
            let found = peak(&lags(&[(natural, 1.0)])).unwrap();
            assert!((found / natural - 1.0).abs() < 1e-4, "{found} of {natural}");
        }
    }

    #[test]
    fn of_two_modes_that_are_as_strong_the_slower_counts() {
        for (slower, faster) in [(0.5, 0.5), (0.48, 0.52), (0.6, 0.4)] {
            let found = peak(&lags(&[(2.0, slower), (3.0, faster)])).unwrap();
            assert!((found / 2.0 - 1.0).abs() < 0.03, "{found}");
        }
        assert!(peak(&lags(&[(2.0, 0.3), (3.0, 0.7)])).unwrap() > 2.9, "the stronger one");
        assert_eq!(peak(&[0.0; FREQUENCIES]), None);
        let beyond = ratio(FREQUENCIES as f64 + 2.0);
        assert_eq!(peak(&lags(&[(2.0, 0.02), (beyond, 0.98)])), None, "a weak one is not taken for what is beyond");
    }
}
