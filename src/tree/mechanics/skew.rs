//! Skew bending: a crooked branch does not move along the wind alone.
//!
//! Where a branch is crooked or carries more on one side, the wood before twists and bends so that the tip moves up or down, too. The turn
//! of each beam under a load `q` across it is taken as `C q`, with the symmetric `C` across the beam that comes nearest to moving the
//! branch's tip as the beam's hinges do, for winds along three axes (least squares). `C` has two principal axes. The gain of a beam is that of
//! the softer one; along the stiffer one, which the beam is given, it bends less.

use super::{
    branches::LoadedBranch,
    hinges::Hinge,
    statics::{self, Beyond},
};
use crate::{
    dynamics::bend::SLOPE_TIP,
    tree::skeleton::{Skeleton, SkeletonBeam},
};
use bevy::math::{DMat3, DVec3, Vec3};

/// Winds along and across a branch, level and from below, with their weights. A gust from below has half of the strength of a level one
/// (Kaimal & Finnigan 1994: 1.25 of 2.4 friction velocities), and loads the tree by half of what that does, which changes the square of the
/// speed. A wind along a branch counts as little: what it does is for the most part what no turn of a beam does. A stem has no such direction.
fn winds(branch: &LoadedBranch) -> [(DVec3, f64); 3] {
    let across = statics::winds(branch)[0];
    let along = if branch.carrier.is_none() { 1.0 } else { 0.25 };
    [(across, 1.0), (across.cross(DVec3::Y), along), (DVec3::Y, 0.25)]
}

/// How far a beam is drawn to bend alike in all directions, as a share of what the winds tell: decides where these tell nothing.
const ISOTROPY: f64 = 1e-3;

/// The stiff axis of each beam of a branch ([`BeamDynamics::stiff_axis`](crate::dynamics::BeamDynamics::stiff_axis)): none where the branch is straight.
pub(super) fn stiff_axes(branch: &LoadedBranch, skeleton: &Skeleton) -> Vec<Vec3> {
    if branch.beams.len() == 1 {
        return vec![Vec3::ZERO];
    }
    let winds = winds(branch);
    let drag = Beyond::sums(branch, &branch.hinges, |lump| [lump.drag_kg_m]);
    // By beam and wind: where its hinges move the tip.
    let mut moved = vec![[DVec3::ZERO; 3]; branch.beams.len()];
    for (hinge, beyond) in branch.hinges.iter().zip(&drag) {
        for (moved, (wind, _)) in moved[hinge.beam].iter_mut().zip(winds) {
            *moved += motion(hinge, branch.tip, beyond.about(hinge.at, 0).cross(wind));
        }
    }
    let axis = |(&beam, moved): (&u32, &[DVec3; 3])| {
        let beam = &skeleton.beams[beam as usize];
        stiff_axis(beam, branch.tip, &winds, moved)
    };
    branch.beams.iter().zip(&moved).map(axis).collect()
}

/// How a hinge moves the tip under a moment.
fn motion(hinge: &Hinge, tip: DVec3, moment_nm: DVec3) -> DVec3 {
    hinge.turn(moment_nm).cross(tip - hinge.at)
}

/// Of a beam that is to move the tip so far, m, by each of the winds.
fn stiff_axis(beam: &SkeletonBeam, tip: DVec3, winds: &[(DVec3, f64); 3], moved: &[DVec3; 3]) -> Vec3 {
    let (x, y) = beam.direction.any_orthonormal_pair();
    let across = [x.as_dvec3(), y.as_dvec3()];
    let posed = across.map(|turn| posed_m(beam, tip, turn));
    // Normal equations for C_xx, C_xy, C_yy.
    let (mut matrix, mut right) = (DMat3::ZERO, DVec3::ZERO);
    for (moved, (wind, weight)) in moved.iter().zip(winds) {
        let [a, b] = across.map(|across| wind.dot(across));
        let columns = [posed[0] * a, posed[0] * b + posed[1] * a, posed[1] * b];
        let row = |of: DVec3| DVec3::from_array(columns.map(|column| column.dot(of))) * weight;
        matrix += DMat3::from_cols(row(columns[0]), row(columns[1]), row(columns[2]));
        right += row(*moved);
    }
    let isotropy = ISOTROPY * (matrix.x_axis.x + matrix.z_axis.z);
    matrix +=
        DMat3::from_cols(DVec3::new(1.0, 0.0, -1.0), DVec3::new(0.0, 4.0, 0.0), DVec3::new(-1.0, 0.0, 1.0)) * isotropy;
    let compliance = matrix.inverse() * right;
    let axis = principal_stiff_axis(compliance).map(|[a, b]| across[0] * a + across[1] * b);
    axis.map_or(Vec3::ZERO, DVec3::as_vec3)
}

/// The stiff axis of `((xx, xy), (xy, yy))`: its length is the square root of the share by which it is stiffer.
fn principal_stiff_axis(compliance: DVec3) -> Option<[f64; 2]> {
    let DVec3 { x: xx, y: xy, z: yy } = compliance;
    let (mean, half_difference) = (0.5 * (xx + yy), 0.5 * (xx - yy));
    let deviator = half_difference.hypot(xy);
    let (greatest, least) = (mean + deviator, (mean - deviator).max(0.0));
    let length = (1.0 - least / greatest).sqrt();
    // The soft axis is at half of this angle, the stiff one across it.
    let (sine, cosine) = (0.5 * xy.atan2(half_difference)).sin_cos();
    (greatest > 0.0 && length.is_finite()).then_some([-sine * length, cosine * length])
}

/// Where a beam's turn, a vector across it in the sense of the deflection, moves the tip of its branch, m/rad.
pub(super) fn posed_m(beam: &SkeletonBeam, tip: DVec3, turn: DVec3) -> DVec3 {
    let (direction, length_m) = (beam.direction.as_dvec3(), f64::from(beam.length_m));
    let beyond = tip - (beam.base.as_dvec3() + direction * length_m);
    turn * (length_m / f64::from(SLOPE_TIP)) + direction.cross(turn).cross(beyond)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Eigenvalues 5 and 2, the stiff axis at 30 degrees.
    #[test]
    fn the_stiff_axis_is_that_of_the_least_eigenvalue() {
        let (sine, cosine) = std::f64::consts::FRAC_PI_6.sin_cos();
        let [greatest, least] = [5.0, 2.0];
        let along = |a: f64, b: f64| greatest * a + (least - greatest) * b;
        let compliance = DVec3::new(along(1.0, cosine * cosine), along(0.0, sine * cosine), along(1.0, sine * sine));
        let [a, b] = principal_stiff_axis(compliance).expect("it has one");
        let share: f64 = 1.0 - least / greatest;
        assert!((a.hypot(b) - share.sqrt()).abs() < 1e-12);
        assert!((a * sine - b * cosine).abs() < 1e-12, "{a} {b}");
        let isotropic = principal_stiff_axis(DVec3::new(3.0, 0.0, 3.0)).expect("it has one");
        assert_eq!(isotropic.map(f64::abs), [0.0, 0.0]);
        assert_eq!(principal_stiff_axis(DVec3::ZERO), None);
        assert_eq!(principal_stiff_axis(DVec3::NAN), None);
    }
}
