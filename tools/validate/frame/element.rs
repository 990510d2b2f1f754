//! The stiffness of one straight, tapered rod, elastic and by the weight that it bears.

use nalgebra::{Matrix3, Matrix6, SMatrix, Vector3};
use std::f64::consts::PI;

pub type Matrix12 = SMatrix<f64, 12, 12>;

/// A rod of round section whose radius goes in a straight line from its start to its end.
#[derive(Clone, Copy)]
pub struct Rod {
    pub start_radius_m: f64,
    pub end_radius_m: f64,
    pub young_modulus_pa: f64,
    pub shear_modulus_pa: f64,
}

/// Places and weights of Gauss's quadrature with five points on 0..1: exact for polynomials up to the ninth degree.
const GAUSS: [(f64, f64); 5] = [
    (0.046_910_077_030_668, 0.118_463_442_528_095),
    (0.230_765_344_947_158, 0.239_314_335_249_683),
    (0.5, 0.284_444_444_444_444),
    (0.769_234_655_052_842, 0.239_314_335_249_683),
    (0.953_089_922_969_332, 0.118_463_442_528_095),
];

/// What a rigid body's motion at one place, three displacements and three rotations, is at a place `arm` away from it.
pub fn rigid(arm: &Vector3<f64>) -> Matrix6<f64> {
    let mut motion = Matrix6::identity();
    motion.fixed_view_mut::<3, 3>(0, 3).copy_from(&-arm.cross_matrix());
    motion
}

/// Elastic stiffness of a rod along `axis` (from start to end, m), for the motions of its start and its end: the inverse of
/// what its end gives when its start is held (Euler-Bernoulli bending, stretch, twist), which is exact for any taper.
pub fn elastic(axis: &Vector3<f64>, rod: &Rod) -> Matrix12 {
    let length_m = axis.norm();
    let direction = axis / length_m;
    let (mut turn, mut sway, mut sway_turn, mut stretch, mut twist) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for (place, weight) in GAUSS {
        let radius_m = rod.start_radius_m + (rod.end_radius_m - rod.start_radius_m) * place;
        let arm_m = length_m * (1.0 - place);
        let second_moment_m4 = PI / 4.0 * radius_m.powi(4);
        let bend = weight * length_m / (rod.young_modulus_pa * second_moment_m4);
        turn += bend;
        sway_turn += bend * arm_m;
        sway += bend * arm_m * arm_m;
        stretch += weight * length_m / (rod.young_modulus_pa * PI * radius_m.powi(2));
        twist += weight * length_m / (rod.shear_modulus_pa * 2.0 * second_moment_m4);
    }
    let along = direction * direction.transpose();
    let across = Matrix3::identity() - along;
    let coupled = sway_turn * direction.cross_matrix();
    let mut flexibility = Matrix6::zeros();
    flexibility.fixed_view_mut::<3, 3>(0, 0).copy_from(&(stretch * along + sway * across));
    flexibility.fixed_view_mut::<3, 3>(0, 3).copy_from(&-coupled);
    flexibility.fixed_view_mut::<3, 3>(3, 0).copy_from(&coupled);
    flexibility.fixed_view_mut::<3, 3>(3, 3).copy_from(&(twist * along + turn * across));
    let stiffness = flexibility.try_inverse().expect("a rod gives in every direction");
    // The strain is the motion of the end, less what a rigid rod would make of its start's.
    let mut strain = SMatrix::<f64, 6, 12>::zeros();
    strain.fixed_view_mut::<6, 6>(0, 0).copy_from(&-rigid(axis));
    strain.fixed_view_mut::<6, 6>(0, 6).copy_from(&Matrix6::identity());
    strain.transpose() * stiffness * strain
}

/// What weight adds to the stiffness of a rod along `axis` that bears `weight_n` beyond it, and the bending moment
/// `moment_nm` of that weight.
///
/// A rod that turns by the vector `theta` moves what it bears, in second order, by `theta x (theta x axis) / 2`, which lifts
/// or lowers it. `theta` across the rod is that of its chord, along the rod the mean twist of its ends. And a
/// bending moment does work on the second order of the curvature, `-theta x theta' / 2`.
pub fn geometric(axis: &Vector3<f64>, weight_n: f64, moment_nm: &Vector3<f64>) -> Matrix12 {
    let length_m = axis.norm();
    let direction = axis / length_m;
    let chord = direction.cross_matrix() / length_m;
    let mut turns = SMatrix::<f64, 4, 12>::zeros();
    turns.fixed_view_mut::<3, 3>(0, 0).copy_from(&-chord);
    turns.fixed_view_mut::<3, 3>(0, 6).copy_from(&chord);
    turns.fixed_view_mut::<1, 3>(3, 3).copy_from(&(direction.transpose() / 2.0));
    turns.fixed_view_mut::<1, 3>(3, 9).copy_from(&(direction.transpose() / 2.0));
    let mut lift = SMatrix::<f64, 4, 4>::from_diagonal_element(-direction.y);
    (lift[(3, 3)], lift[(1, 3)], lift[(3, 1)]) = (0.0, 0.5, 0.5);
    let mut stiffness = turns.transpose() * lift * turns * (weight_n * length_m);
    let curved = moment_nm.cross_matrix() / 2.0;
    let mut ends = stiffness.fixed_view_mut::<3, 3>(3, 9);
    ends += curved;
    let mut ends = stiffness.fixed_view_mut::<3, 3>(9, 3);
    ends += curved.transpose();
    stiffness
}

/// The same for a mass of the weight `weight_n` on a rigid arm.
pub fn geometric_arm(arm: &Vector3<f64>, weight_n: f64) -> Matrix3<f64> {
    let up = Vector3::y();
    weight_n * ((arm * up.transpose() + up * arm.transpose()) / 2.0 - Matrix3::from_diagonal_element(arm.y))
}
