//! The natural modes that a load excites, by the method of Lanczos.
//!
//! The vectors `K^-1 f, (K^-1 M) K^-1 f, ...` span the modes that a load `f` excites best. In an M-orthonormal basis of them
//! `K^-1 M` is tridiagonal, and its eigenvalues tend to `1 / w^2`, the greatest first.

use super::{Frame, tree_matrix::dot};
use nalgebra::{DMatrix, SymmetricEigen, Vector3, Vector6};
use std::f64::consts::TAU;

const STEPS: usize = 90;
/// What is smaller than this beside the first eigenvalue is rounding.
const NEGLIGIBLE: f64 = 1e-9;

/// ln of the ratio of frequencies that a peak unites: about the width of a resonance with the product's damping.
const PEAK_WIDTH: f64 = 0.15;

/// A mode that a load excites.
#[derive(Clone, Copy)]
pub struct Mode {
    pub frequency_hz: f64,
    /// Its share of the static deflection of the probe under the load.
    pub share: f64,
}

/// Modes in the order of their share, the greatest first. The probe is a node and a direction.
pub fn modes(frame: &Frame, gravity_m_s2: f64, load: &[Vector6<f64>], probe: (usize, Vector3<f64>)) -> Vec<Mode> {
    let (factor, mass) = (frame.factor(gravity_m_s2), frame.mass());
    let probed = |vector: &[Vector6<f64>]| vector[probe.0].fixed_rows::<3>(0).dot(&probe.1);
    let mut vector = factor.solve(load);
    let deflection = probed(&vector);
    let mut massed = mass.times(&vector);
    let mut norm = dot(&vector, &massed).sqrt();
    let first_norm = norm;
    let mut basis: Vec<[Vec<Vector6<f64>>; 2]> = Vec::new();
    let mut tridiagonal = DMatrix::<f64>::zeros(STEPS, STEPS);
    for step in 0..STEPS.min(6 * frame.node_count()) {
        scale(&mut vector, 1.0 / norm);
        scale(&mut massed, 1.0 / norm);
        let mut next = factor.solve(&massed);
        tridiagonal[(step, step)] = dot(&next, &massed);
        basis.push([vector, massed]);
        // Twice is enough against rounding (Parlett).
        for _ in 0..2 {
            for [vector, massed] in &basis {
                let part = dot(&next, massed);
                next.iter_mut().zip(vector).for_each(|(value, old)| *value -= part * old);
            }
        }
        massed = mass.times(&next);
        vector = next;
        norm = dot(&vector, &massed).max(0.0).sqrt();
        if norm <= NEGLIGIBLE * tridiagonal[(0, 0)].abs() || step + 1 == STEPS {
            break;
        }
        tridiagonal[(step, step + 1)] = norm;
        tridiagonal[(step + 1, step)] = norm;
    }
    let size = basis.len();
    let eigen = SymmetricEigen::new(tridiagonal.view((0, 0), (size, size)).into_owned());
    let of_basis: Vec<f64> = basis.iter().map(|[vector, _]| probed(vector)).collect();
    let mut modes: Vec<Mode> = eigen
        .eigenvalues
        .iter()
        .zip(eigen.eigenvectors.column_iter())
        .filter(|(value, _)| **value > 1e3 * NEGLIGIBLE * eigen.eigenvalues.max())
        .map(|(value, weights)| {
            let shape: f64 = weights.iter().zip(&of_basis).map(|(weight, probe)| weight * probe).sum();
            Mode { frequency_hz: value.sqrt().recip() / TAU, share: shape * first_norm * weights[0] / deflection }
        })
        .collect();
    modes.sort_by(|a, b| b.share.total_cmp(&a.share));
    modes
}

fn scale(vector: &mut [Vector6<f64>], factor: f64) {
    vector.iter_mut().for_each(|value| *value *= factor);
}

/// The resonance at the probe: of all groups of modes within [`PEAK_WIDTH`] of each other the one with the greatest share, and its mean
/// frequency. Branches as fast as their trunk divide its mode in many, which damping makes one peak.
pub fn peak(modes: &[Mode]) -> Mode {
    strongest(modes, |peak| peak.share)
}

/// The one of these groups that moves the probe furthest in gusts, whose amplitude at a frequency `f` is as `sqrt(f S(f)) ~ f^(-1/3)`
/// (Kolmogorov's spectrum).
pub fn gust_peak(modes: &[Mode]) -> Mode {
    strongest(modes, |peak| {
        // Groups whose shares all but cancel have no mean frequency.
        if peak.frequency_hz > 0.0 { peak.share / peak.frequency_hz.cbrt() } else { f64::NEG_INFINITY }
    })
}

fn strongest(modes: &[Mode], motion: impl Fn(&Mode) -> f64) -> Mode {
    let near = |middle: &Mode| {
        let (mut share, mut weighted) = (0.0, 0.0);
        for mode in modes.iter().filter(|mode| (mode.frequency_hz / middle.frequency_hz).ln().abs() < PEAK_WIDTH) {
            share += mode.share;
            weighted += mode.share * mode.frequency_hz;
        }
        Mode { frequency_hz: weighted / share, share }
    };
    modes.iter().map(near).max_by(|a, b| motion(a).total_cmp(&motion(b))).expect("a load excites a mode")
}

/// The frequency at which the probe begins to resonate, Hz. Under a load that swings slowly, at `w`, its deflection is the
/// static one times `1 + w^2 sum (share / w_i^2) + ...` over all modes, as if there were one mode with `1 / w_i^2` that sum. That
/// holds however the modes of single branches divide the sway of the trunk.
pub fn onset_hz(frame: &Frame, gravity_m_s2: f64, load: &[Vector6<f64>], probe: (usize, Vector3<f64>)) -> f64 {
    let factor = frame.factor(gravity_m_s2);
    let still = factor.solve(load);
    let moved = factor.solve(&frame.mass().times(&still));
    let [still, moved] = [still, moved].map(|motions| motions[probe.0].fixed_rows::<3>(0).dot(&probe.1));
    (still / moved).sqrt() / TAU
}
