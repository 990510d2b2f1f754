//! How a branch bends and twists under the drag of all that it carries, and under its weight.
//!
//! A tree is statically determinate: the moment at a hinge follows from the drag beyond it alone, whatever gives there. With the
//! wind along the unit vector `e`, the drag `c` of each lump at `p`, hinges at `j` of the compliance `C` (a matrix: they bend
//! and twist) and the branch's tip at `t`, a hinge moves the tip along the wind by
//!
//! ```text
//! T = ((sum c (p - j)) x e) . C ((t - j) x e)
//! ```
//!
//! The twist counts wherever the branch is crooked or carries more on one side. The wind blows level and across a branch,
//! along x and along z for a stem.
//!
//! Weight acts on the bent branch, in the second order of the pieces' turns `phi` (rotation vectors, from rest):
//!
//! ```text
//! energy = sum_i (phi_i - phi_(i-1)) . C_i^-1 (phi_i - phi_(i-1)) / 2 + phi_(i-1) . M_i x phi_i / 2 + phi_i . W_i phi_i / 2
//! W = g ((G up^T + up G^T) / 2 - (G . up) 1)
//! ```
//!
//! `G` is the first moment of the mass that the piece bears about its hinge, that of what is beyond the next hinge taken
//! there, and `M` the moment of the weight at a hinge, which tips a level branch over sideways.

use super::{
    branches::{LoadedBranch, Lump},
    hinges::{Hinge, outer},
};
use bevy::math::{DMat3, DVec3};

/// Gravity, m/s^2 (standard).
pub(super) const GRAVITY_M_S2: f64 = 9.806_65;
/// Least share of its stiffness that weight leaves a branch, or it counts as weightless. Real trees keep far more: they have a quarter of
/// the height at which they would buckle (McMahon 1973, Science 179, 1201).
const LEAST_STIFFNESS_SHARE: f64 = 0.5;
/// Where a branch is thinner than this share of its root, what it bears weighs as if it were rigid: a leader, as it is drawn,
/// would hardly stand under sprays that are lumps.
const WEIGHED_SHARE: f64 = 0.2;

/// Directions of the wind that a branch is bent by: level and across it, or any for a stem.
pub(super) fn winds(branch: &LoadedBranch) -> Vec<DVec3> {
    if branch.carrier.is_none() {
        return vec![DVec3::X, DVec3::Z];
    }
    vec![(branch.tip - branch.base).cross(DVec3::Y).try_normalize().unwrap_or(DVec3::X)]
}

/// Sums over what is beyond a hinge: of a weight on each lump, and of that times its place.
#[derive(Clone, Copy)]
pub(super) struct Beyond<const N: usize> {
    pub weights: [f64; N],
    pub moments: [DVec3; N],
}

impl<const N: usize> Beyond<N> {
    /// One for each hinge.
    pub fn sums(branch: &LoadedBranch, hinges: &[Hinge], weights: impl Fn(&Lump) -> [f64; N]) -> Vec<Self> {
        let mut sum = Self { weights: [0.0; N], moments: [DVec3::ZERO; N] };
        let mut before = branch.lumps.iter().rev().peekable();
        let mut sums: Vec<Self> = hinges
            .iter()
            .rev()
            .map(|hinge| {
                while let Some(lump) = before.next_if(|lump| lump.attach_m > hinge.along_m) {
                    let at = lump.at.as_dvec3();
                    for (n, weight) in weights(lump).into_iter().enumerate() {
                        sum.weights[n] += weight;
                        sum.moments[n] += at * weight;
                    }
                }
                sum
            })
            .collect();
        sums.reverse();
        sums
    }

    /// First moments about a place.
    pub fn about(&self, place: DVec3, n: usize) -> DVec3 {
        self.moments[n] - place * self.weights[n]
    }
}

/// What gives the motion of the tip along the wind by a hinge, from the first moment of the drag about it.
pub(super) fn influence(hinge: &Hinge, tip: DVec3, wind: DVec3) -> DVec3 {
    wind.cross(hinge.turn((tip - hinge.at).cross(wind)))
}

/// What weight adds to the stiffness of a piece, and the moment of the weight at its hinge.
#[derive(Clone, Copy)]
pub(super) struct PieceWeight {
    pub stiffness: DMat3,
    pub moment_nm: DVec3,
}

impl PieceWeight {
    const NONE: Self = Self { stiffness: DMat3::ZERO, moment_nm: DVec3::ZERO };

    /// Of every piece of a branch. Nothing where the branch would not stand if it were twice as heavy: as it is drawn, it is too thin for
    /// what it bears.
    pub fn of(hinges: &[Hinge], mass: &[Beyond<1>]) -> Vec<Self> {
        let slender = hinges.iter().position(|hinge| hinge.radius_m < WEIGHED_SHARE * hinges[0].radius_m);
        let weighed = slender.unwrap_or(hinges.len());
        let weight = |index: usize| {
            if index >= weighed {
                return Self::NONE;
            }
            let about = mass[index].about(hinges[index].at, 0);
            let bears = match hinges.get(index + 1).filter(|_| index + 1 < weighed) {
                Some(next) => about - mass[index + 1].about(next.at, 0),
                None => about,
            };
            let up = DVec3::Y;
            let lift = (outer(bears, up) + outer(up, bears)) * 0.5 - DMat3::from_diagonal(DVec3::splat(bears.y));
            Self { stiffness: lift * GRAVITY_M_S2, moment_nm: about.cross(up * -GRAVITY_M_S2) }
        };
        let weights: Vec<Self> = (0..hinges.len()).map(weight).collect();
        if stands(hinges, &weights, 1.0 / LEAST_STIFFNESS_SHARE) { weights } else { vec![Self::NONE; hinges.len()] }
    }
}

/// Whether a branch stands if it is so many times as heavy.
pub(super) fn stands(hinges: &[Hinge], weights: &[PieceWeight], times: f64) -> bool {
    Chain::new(hinges, weights, times).is_some()
}

/// The tip's deflection under the drag, by what it would be without weight.
pub(super) fn softening(hinges: &[Hinge], drag: &[Beyond<1>], mass: &[Beyond<1>], tip: DVec3, winds: &[DVec3]) -> f64 {
    let weights = PieceWeight::of(hinges, mass);
    let Some(chain) = Chain::new(hinges, &weights, 1.0) else { return 1.0 };
    let weighed: f64 = winds.iter().map(|wind| chain.tip_deflection(hinges, drag, tip, *wind)).sum();
    let by_wind = |wind: &DVec3| {
        let by_hinge = |(hinge, drag): (&Hinge, &Beyond<1>)| drag.about(hinge.at, 0).dot(influence(hinge, tip, *wind));
        hinges.iter().zip(drag).map(by_hinge).sum::<f64>()
    };
    let softening = weighed / winds.iter().map(by_wind).sum::<f64>();
    if softening.is_finite() && softening > 0.0 { softening } else { 1.0 }
}

/// The pieces' turns, eliminated from the tip to the root.
struct Chain {
    inverses: Vec<DMat3>,
    /// How a piece is coupled to the one before it.
    to_before: Vec<DMat3>,
}

impl Chain {
    /// None if it does not stand, so many times as heavy.
    fn new(hinges: &[Hinge], weights: &[PieceWeight], times: f64) -> Option<Self> {
        let mut chain = Self { inverses: vec![DMat3::ZERO; hinges.len()], to_before: vec![DMat3::ZERO; hinges.len()] };
        let mut carried = DMat3::ZERO;
        for (index, (hinge, weight)) in hinges.iter().zip(weights).enumerate().rev() {
            let stiffness = hinge.stiffness();
            let pivot = carried + stiffness + weight.stiffness * times;
            let coupling = cross_matrix(weight.moment_nm).transpose() * (0.5 * times) - stiffness;
            if !is_positive(&pivot) {
                return None;
            }
            let inverse = pivot.inverse();
            carried = stiffness - coupling.transpose() * inverse * coupling;
            (chain.inverses[index], chain.to_before[index]) = (inverse, coupling);
        }
        Some(chain)
    }

    fn tip_deflection(&self, hinges: &[Hinge], drag: &[Beyond<1>], tip: DVec3, wind: DVec3) -> f64 {
        // Moments on the pieces, carried to the root.
        let mut moments = vec![DVec3::ZERO; hinges.len()];
        let mut carried = DVec3::ZERO;
        for (index, hinge) in hinges.iter().enumerate().rev() {
            let about = drag[index].about(hinge.at, 0);
            let bears = hinges.get(index + 1).map_or(about, |next| about - drag[index + 1].about(next.at, 0));
            moments[index] = bears.cross(wind) + carried;
            carried = -(self.to_before[index].transpose() * (self.inverses[index] * moments[index]));
        }
        let mut turn = DVec3::ZERO;
        let mut deflection = 0.0;
        for (index, hinge) in hinges.iter().enumerate() {
            turn = self.inverses[index] * (moments[index] - self.to_before[index] * turn);
            let next = hinges.get(index + 1).map_or(tip, |next| next.at);
            deflection += turn.dot((next - hinge.at).cross(wind));
        }
        deflection
    }
}

/// The matrix of `v x`.
fn cross_matrix(v: DVec3) -> DMat3 {
    DMat3::from_cols(DVec3::new(0.0, v.z, -v.y), DVec3::new(-v.z, 0.0, v.x), DVec3::new(v.y, -v.x, 0.0))
}

/// Whether a symmetric matrix is positive definite: so are its leading minors.
fn is_positive(matrix: &DMat3) -> bool {
    let (x, y) = (matrix.x_axis, matrix.y_axis);
    x.x > 0.0 && x.x * y.y - x.y * y.x > 0.0 && matrix.determinant() > 0.0
}
