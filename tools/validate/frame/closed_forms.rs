//! The finite elements against closed forms.

use super::{Frame, Lump, element::Rod, modes::modes};
use nalgebra::Vector3;
use std::f64::consts::{PI, TAU};

const LENGTH_M: f64 = 6.0;
const RADIUS_M: f64 = 0.1;
const YOUNG_PA: f64 = 8e9;
const SHEAR_PA: f64 = 6e8;
const DENSITY_KG_M3: f64 = 900.0;
const RODS: usize = 32;
const SECOND_MOMENT_M4: f64 = PI / 4.0 * RADIUS_M * RADIUS_M * RADIUS_M * RADIUS_M;
const MASS_KG_M: f64 = DENSITY_KG_M3 * PI * RADIUS_M * RADIUS_M;

/// Greatest relative error over all.
pub fn worst_error() -> f64 {
    let errors = [
        ("tip load on a uniform cantilever", uniform_deflection()),
        ("tip load on a tapered cantilever", tapered_deflection()),
        ("tip load on a bent cantilever", bent_deflection()),
        ("first frequency of a uniform cantilever", frequency(0, 1.875_104_07)),
        ("second frequency of a uniform cantilever", frequency(1, 4.694_091_13)),
        ("gravity that buckles a column", own_weight()),
        ("load that tips a beam sideways", sideways()),
    ];
    for (what, error) in errors {
        println!("  {what:<42} {error:>12.2e}");
    }
    errors.iter().map(|(_, error)| error.abs()).fold(0.0, f64::max)
}

/// A cantilever of a straight axis, and its tip.
fn cantilever(axis: Vector3<f64>, base_radius_m: f64, tip_radius_m: f64) -> (Frame, usize) {
    let mut frame = Frame::default();
    let root = frame.stand(Vector3::zeros(), None);
    let tip = add_beam(&mut frame, root, axis, base_radius_m, tip_radius_m);
    (frame, tip)
}

fn add_beam(frame: &mut Frame, root: usize, axis: Vector3<f64>, base_radius_m: f64, tip_radius_m: f64) -> usize {
    let base = frame.place(root);
    let place = |step: usize| base + axis * (step as f64 / RODS as f64);
    let radius_m = |step: usize| base_radius_m + (tip_radius_m - base_radius_m) * step as f64 / RODS as f64;
    (0..RODS).fold(root, |from, step| {
        let rod = Rod {
            start_radius_m: radius_m(step),
            end_radius_m: radius_m(step + 1),
            young_modulus_pa: YOUNG_PA,
            shear_modulus_pa: SHEAR_PA,
        };
        let node = frame.extend(from, place(step), place(step + 1), rod);
        let mass_kg = MASS_KG_M * axis.norm() / (2 * RODS) as f64;
        for (holder, share) in [(from, 0.25), (node, 0.75)] {
            let at = place(step) + axis * (share / RODS as f64);
            frame.lumps.push(Lump { node: holder, at, mass_kg, drag_kg_m: 0.0 });
        }
        node
    })
}

/// Deflection at the tip under a force of 1 N there, along the force.
fn tip_deflection(frame: &Frame, tip: usize, force_n: Vector3<f64>) -> f64 {
    let motions = frame.factor(0.0).solve(&frame.load_at(tip, force_n));
    motions[tip].fixed_rows::<3>(0).dot(&force_n)
}

fn uniform_deflection() -> f64 {
    let (frame, tip) = cantilever(LENGTH_M * Vector3::y(), RADIUS_M, RADIUS_M);
    let exact = LENGTH_M.powi(3) / (3.0 * YOUNG_PA * SECOND_MOMENT_M4);
    tip_deflection(&frame, tip, Vector3::x()) / exact - 1.0
}

/// For a straight taper the integral of x^2 / (a + b x)^4 gives that of the uniform beam times the ratio of the radii.
fn tapered_deflection() -> f64 {
    let (frame, tip) = cantilever(LENGTH_M * Vector3::new(0.6, 0.0, 0.8), RADIUS_M, 0.2 * RADIUS_M);
    let exact = LENGTH_M.powi(3) / (3.0 * YOUNG_PA * SECOND_MOMENT_M4) / 0.2;
    tip_deflection(&frame, tip, Vector3::y()) / exact - 1.0
}

/// A cantilever with a right angle: both legs bend, and the first is twisted by the second.
fn bent_deflection() -> f64 {
    let (mut frame, corner) = cantilever(LENGTH_M * Vector3::y(), RADIUS_M, RADIUS_M);
    let arm_m = 2.0_f64;
    let tip = add_beam(&mut frame, corner, arm_m * Vector3::x(), RADIUS_M, RADIUS_M);
    let bends = (LENGTH_M.powi(3) + arm_m.powi(3)) / (3.0 * YOUNG_PA * SECOND_MOMENT_M4);
    let twist = arm_m.powi(2) * LENGTH_M / (SHEAR_PA * 2.0 * SECOND_MOMENT_M4);
    tip_deflection(&frame, tip, Vector3::z()) / (bends + twist) - 1.0
}

fn frequency(order: usize, root: f64) -> f64 {
    let (frame, tip) = cantilever(LENGTH_M * Vector3::y(), RADIUS_M, RADIUS_M);
    let found = modes(&frame, 0.0, &frame.load_at(tip, Vector3::x()), (tip, Vector3::x()));
    let exact = (root / LENGTH_M).powi(2) * (YOUNG_PA * SECOND_MOMENT_M4 / MASS_KG_M).sqrt() / TAU;
    found[order].frequency_hz / exact - 1.0
}

/// The gravity at which a standing column buckles under its own weight: 7.8373 E I / (m L^3) (Greenhill 1881).
fn own_weight() -> f64 {
    let (frame, _) = cantilever(LENGTH_M * Vector3::y(), RADIUS_M, RADIUS_M);
    critical_gravity(&frame) / (7.837_347 * YOUNG_PA * SECOND_MOMENT_M4 / (MASS_KG_M * LENGTH_M.powi(3))) - 1.0
}

/// The load at the tip of a level cantilever without weight at which it tips sideways: 4.0126 sqrt(E I G J) / L^2
/// (Timoshenko & Gere 1961).
fn sideways() -> f64 {
    let (mut frame, tip) = cantilever(LENGTH_M * Vector3::x(), RADIUS_M, RADIUS_M);
    frame.lumps.clear();
    frame.lumps.push(Lump { node: tip, at: frame.place(tip), mass_kg: 1.0, drag_kg_m: 0.0 });
    let twist_stiffness = SHEAR_PA * 2.0 * SECOND_MOMENT_M4;
    let exact = 4.0126 * (YOUNG_PA * SECOND_MOMENT_M4 * twist_stiffness).sqrt() / LENGTH_M.powi(2);
    critical_gravity(&frame) / exact - 1.0
}

/// The least gravity under which the frame is not stable, by bisection.
fn critical_gravity(frame: &Frame) -> f64 {
    let is_stable = |gravity: f64| frame.factor(gravity).negative_eigenvalues() == 0;
    let mut unstable = 1e-3;
    while is_stable(unstable) {
        unstable *= 2.0;
    }
    let mut stable = unstable / 2.0;
    for _ in 0..40 {
        let middle = (stable + unstable) / 2.0;
        if is_stable(middle) { stable = middle } else { unstable = middle }
    }
    stable
}
