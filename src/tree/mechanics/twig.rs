//! A branch that bears leaves alone, as the branch that carries it feels it.
//!
//! Most branches of a tree are such. With the moments `c` about its hinges by which its inertia answers a motion `r` of the place that
//! bears it, and `c_b` of the wind's drag, it adds to a rigid body
//!
//! ```text
//! - z^2 c^T (K - z M)^-1 c  to D,    z c^T (K - z M)^-1 c_b  to b        (`D`, `b`, `z`: resonance.rs)
//! ```
//!
//! Nearly all of its bend is that of its first mode, across it in whatever direction: so `(K - z M)^-1` is taken as `K^-1 / (1 - z t)`, with
//! `t` the square of that mode's period over 2 pi, by Rayleigh's method from the bend under its inertia. What then depends on
//! the frequency are two factors. The rigid body is part of the piece that bears it.

use super::{
    articulated::Articulated,
    branches::{LoadedBranch, Lump},
    four::Four,
    hinges::{Hinge, outer},
};
use bevy::math::{DMat3, DVec3};

/// Motions of the place that bears it, by 1 m along each axis and by 1 rad about each.
const MOTIONS: usize = 6;
/// Winds along x and along z.
const WINDS: [DVec3; 2] = [DVec3::X, DVec3::Z];

/// What a twig's bend adds to a rigid one.
pub(super) struct Twig {
    /// `c^T K^-1 c`.
    by_motion: [[f32; MOTIONS]; MOTIONS],
    /// `c^T K^-1 c_b`, for each wind.
    by_wind: [[f32; MOTIONS]; 2],
    /// `t`, s^2.
    square_period_s2: f32,
    pub next_sibling: Option<u32>,
}

/// A hinge with the sums over what is beyond it, about it.
struct Loaded<'a> {
    hinge: &'a Hinge,
    /// Of mass, of mass as inertia, and of drag.
    moment: DVec3,
    inertia: DMat3,
    drag_moment: DVec3,
}

impl Twig {
    /// About a place of the piece that bears it.
    pub fn new(branch: &LoadedBranch, place: DVec3, next_sibling: Option<u32>) -> Self {
        let hinges: Vec<Loaded> = branch.swaying_hinges.iter().map(|hinge| Loaded::new(hinge, &branch.lumps)).collect();
        let mut twig = Self {
            by_motion: [[0.0; MOTIONS]; MOTIONS],
            by_wind: [[0.0; MOTIONS]; 2],
            square_period_s2: 0.0,
            next_sibling,
        };
        let mut bent = 0.0;
        // How the hinges turn as it is moved along each axis.
        let mut turns = [DVec3::ZERO; 3].map(|_| Vec::with_capacity(hinges.len()));
        for loaded in &hinges {
            let moments = loaded.moments_by_motion(place);
            let turned = moments.map(|moment| loaded.hinge.turn(moment));
            for (row, moment) in twig.by_motion.iter_mut().zip(moments) {
                row.iter_mut().zip(turned).for_each(|(sum, turned)| *sum += moment.dot(turned) as f32);
            }
            for (row, wind) in twig.by_wind.iter_mut().zip(WINDS) {
                let drag = loaded.drag_moment.cross(wind);
                row.iter_mut().zip(turned).for_each(|(sum, turned)| *sum += drag.dot(turned) as f32);
            }
            for axis in 0..3 {
                bent += moments[axis].dot(turned[axis]);
                turns[axis].push(turned[axis]);
            }
        }
        let moving: f64 = turns.iter().map(|turns| inertia_of(&hinges, turns)).sum();
        twig.square_period_s2 = if bent > 0.0 { (moving / bent) as f32 } else { 0.0 };
        twig
    }

    pub fn add_to(&self, body: &mut Articulated, z: Four) {
        let by_wind = z * (Four::real(1.0) - z * self.square_period_s2).recip();
        body.add_bend(&self.by_motion, &self.by_wind, z * by_wind, by_wind);
    }
}

impl<'a> Loaded<'a> {
    fn new(hinge: &'a Hinge, lumps: &[Lump]) -> Self {
        let mut loaded = Self { hinge, moment: DVec3::ZERO, inertia: DMat3::ZERO, drag_moment: DVec3::ZERO };
        for lump in lumps.iter().filter(|lump| lump.attach_m > hinge.along_m) {
            let arm = lump.at.as_dvec3() - hinge.at;
            loaded.moment += arm * lump.mass_kg;
            loaded.drag_moment += arm * lump.drag_kg_m;
            loaded.inertia +=
                (DMat3::from_diagonal(DVec3::splat(arm.length_squared())) - outer(arm, arm)) * lump.mass_kg;
        }
        loaded
    }

    /// Moments about the hinge of what is beyond it, for a unit acceleration of each kind about a place.
    fn moments_by_motion(&self, place: DVec3) -> [DVec3; MOTIONS] {
        let arm = self.hinge.at - place;
        std::array::from_fn(|motion| {
            let axis = DVec3::AXES[motion % 3];
            if motion < 3 { self.moment.cross(axis) } else { self.moment.cross(axis.cross(arm)) + self.inertia * axis }
        })
    }
}

/// Twice the kinetic energy while the hinges turn by 1/s times these.
fn inertia_of(hinges: &[Loaded], turns: &[DVec3]) -> f64 {
    let mut sum = 0.0;
    for (index, (beyond, turn)) in hinges.iter().zip(turns).enumerate() {
        let moment = beyond.inertia * *turn;
        sum += turn.dot(moment);
        for (before, turn_before) in hinges[..index].iter().zip(turns) {
            let arm = beyond.hinge.at - before.hinge.at;
            sum += 2.0 * turn_before.dot(moment + arm.cross(turn.cross(beyond.moment)));
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tree::mechanics::{
        branches::Carrier,
        lag_curve::Resonance,
        resonance::resonances,
        response::BranchResponse,
        tests::{branch, lump, spring},
    };
    use std::f64::consts::TAU;

    /// An upright rod without mass on a hinge at its root, with these lumps, each a height and a mass. All but the first are of what it bears.
    fn rod(
        root_m: f64,
        length_m: f64,
        stiffness_nm: f64,
        lumps: &[(f64, f64)],
        carrier: Option<Carrier>,
    ) -> LoadedBranch {
        let at = |height_m: f64| DVec3::Y * height_m;
        let lumps = (0..).zip(lumps).map(|(slot, &(height_m, mass_kg))| Lump {
            arm_m: (height_m - root_m - length_m).max(0.0),
            is_own: slot == 0,
            slot,
            ..lump((height_m - root_m).min(length_m), mass_kg, at(height_m))
        });
        LoadedBranch {
            base: at(root_m),
            length_m,
            bears: carrier.is_none(),
            carrier,
            ..branch(vec![spring(at(root_m), DVec3::Y, stiffness_nm)], lumps.collect(), at(root_m + length_m))
        }
    }

    /// A mass on a rod, the twig, on another, the stem.
    const LENGTHS_M: [f64; 2] = [2.0, 0.5];
    const MASSES_KG: [f64; 2] = [1.0, 0.4];
    const STEM_NM: f64 = 4e4;

    /// Both natural frequencies, rad/s, as their squares, for a spring of the twig: `det(K - w^2 M) = 0`. Beside each the turn of the twig by
    /// that of the stem.
    fn double_pendulum(twig_nm: f64) -> [[f64; 2]; 2] {
        let ([stem_m, twig_m], [stem_kg, twig_kg]) = (LENGTHS_M, MASSES_KG);
        let whole_m = stem_m + twig_m;
        let [a, b, c] = [
            stem_kg * stem_m * stem_m + twig_kg * whole_m * whole_m,
            twig_kg * whole_m * twig_m,
            twig_kg * twig_m * twig_m,
        ];
        // In x = w^2: (a c - b^2) x^2 - (k1 c + k2 a) x + k1 k2.
        let (square, linear) = (a * c - b * b, STEM_NM * c + twig_nm * a);
        let root = (linear * linear - 4.0 * square * STEM_NM * twig_nm).sqrt();
        [-root, root].map(|root| {
            let x = (linear + root) / (2.0 * square);
            [x, (STEM_NM - x * a) / (x * b)]
        })
    }

    /// Its branches, stem and twig.
    fn stem_with_twig(twig_nm: f64) -> [LoadedBranch; 2] {
        let ([stem_m, twig_m], [stem_kg, twig_kg]) = (LENGTHS_M, MASSES_KG);
        let whole_m = stem_m + twig_m;
        let carrier = Carrier { branch: 0, attach_m: stem_m };
        [
            rod(0.0, stem_m, STEM_NM, &[(stem_m, stem_kg), (whole_m, twig_kg)], None),
            rod(stem_m, twig_m, twig_nm, &[(whole_m, twig_kg)], Some(carrier)),
        ]
    }

    fn resonance_of_stem(branches: &[LoadedBranch; 2]) -> Resonance {
        let responses = branches.each_ref().map(|branch| BranchResponse { loads: Vec::new(), sway: branch.sway() });
        resonances(branches, &responses)[0].expect("within the frequencies tried")
    }

    #[test]
    fn a_stem_with_a_twig_sways_as_a_double_pendulum_on_springs() {
        for twig_nm in [2.5e3, 4e3, 2.5e4] {
            let found = resonance_of_stem(&stem_with_twig(twig_nm));
            let expected_hz = double_pendulum(twig_nm)[0][0].sqrt() / TAU;
            assert!((found.frequency_hz / expected_hz - 1.0).abs() < 0.02, "{twig_nm}: {found:?} {expected_hz}");
        }
    }

    /// And what each mode `phi` has of the static turn of the stem under the moment `Q` on it alone, `phi_1^2 / (phi^T K phi)` by `1 / k_1`.
    #[test]
    fn a_twig_about_as_fast_as_its_stem_gives_that_two_frequencies() {
        for twig_nm in [450.0, 615.0, 850.0] {
            let modes =
                double_pendulum(twig_nm).map(|[x, twig]| (x.sqrt() / TAU, STEM_NM / (STEM_NM + twig_nm * twig * twig)));
            assert!((modes[0].1 + modes[1].1 - 1.0).abs() < 1e-9, "they make up the static turn");
            let [mut stem, mut twig] = stem_with_twig(twig_nm);
            // The wind presses on the stem alone.
            (stem.lumps[1].drag_kg_m, twig.lumps[0].drag_kg_m) = (0.0, 0.0);
            let found = resonance_of_stem(&[stem, twig]);
            let second = found.second.expect("two peaks");
            let mut pairs = [(found.frequency_hz, 1.0 - second.share), (second.frequency_hz, second.share)];
            pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
            for ((hz, share), (expected_hz, expected_share)) in pairs.into_iter().zip(modes) {
                assert!((hz / expected_hz - 1.0).abs() < 0.03, "{twig_nm}: {hz} {expected_hz}");
                assert!((share - expected_share).abs() < 0.04, "{twig_nm}, {expected_hz} Hz: {share} {expected_share}");
            }
        }
    }
}
