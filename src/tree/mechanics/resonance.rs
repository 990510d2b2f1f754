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
//! that is one peak again. How the lag of all frequencies is found from that of a few, and which peaks of it a branch sways with,
//! is told in `lag_curve.rs`.

use super::{
    articulated::Articulated,
    bodies::Bodies,
    branches::LoadedBranch,
    four::Four,
    lag_curve::{FOURS, LagCurve, Resonance, SAMPLE_DAMPING_RATIO, Samples, sample_frequency},
    response::BranchResponse,
};
use bevy::math::Vec4;
use std::f64::consts::TAU;

/// The lowest frequency that is tried, by that of the slowest branch.
const LOWEST_SHARE: f64 = 0.6;

/// The resonance of each branch; none of those that bear no other, and where no peak is within the frequencies that are tried.
pub(super) fn resonances(branches: &[LoadedBranch], responses: &[BranchResponse]) -> Vec<Option<Resonance>> {
    let bodies = Bodies::new(branches);
    let lowest_hz = lowest_hz(branches, responses);
    let mut samples: Vec<Samples> = vec![[Vec4::ZERO; 2 * FOURS]; bodies.len()];
    let mut articulated = vec![Articulated::default(); bodies.len()];
    for four in 0..FOURS {
        let z = stiffness_ratio(lowest_hz, four);
        for (index, samples) in samples.iter_mut().enumerate().rev() {
            let answer = bodies.sway(index, z, &mut articulated);
            (samples[four], samples[FOURS + four]) = (answer.re, answer.im);
        }
    }
    let curve = LagCurve::shared();
    let mut found = vec![None; branches.len()];
    for (samples, branch) in samples.iter().zip(bodies.branches()) {
        found[branch] = curve.resonance(samples, lowest_hz);
    }
    found
}

/// `z` at four frequencies.
fn stiffness_ratio(lowest_hz: f64, four: usize) -> Four {
    let square = Vec4::from_array(std::array::from_fn(|lane| {
        (TAU * lowest_hz * sample_frequency(4 * four + lane)).powi(2) as f32
    }));
    let damping = 2.0 * SAMPLE_DAMPING_RATIO as f32;
    let norm = 1.0 + damping * damping;
    Four { re: square / norm, im: square * (-damping / norm) }
}

/// Where to begin: well below the slowest branch that bears others, were these rigid.
fn lowest_hz(branches: &[LoadedBranch], responses: &[BranchResponse]) -> f64 {
    let bearing = branches.iter().zip(responses).filter(|(branch, _)| branch.bears);
    let slowest_hz = bearing.map(|(branch, response)| response.sway.rigid_hz(branch)).fold(f64::INFINITY, f64::min);
    if slowest_hz.is_finite() { LOWEST_SHARE * slowest_hz } else { 1.0 }
}
