//! The cantilever against finite elements, and the periodic steady state against the Duhamel integral.

use crate::cantilever::{CantileverMode, TaperedBeam, disc_second_moment_m4, natural_omega_rad_s};
use crate::oscillator::Oscillator;
use crate::report::Report;
use crate::test_wind::{TURBULENCE_INTENSITY, test_wind};
use nalgebra::{DMatrix, Matrix4, SymmetricEigen};
use std::f64::consts::{PI, TAU};

/// A branch of 1.5 m.
const UNIFORM: TaperedBeam = TaperedBeam {
    length_m: 1.5,
    base_radius_m: 0.015,
    tip_radius_m: 0.015,
    young_modulus_pa: 8e9,
    density_kg_m3: 800.0,
};

pub fn run() -> Report {
    let mut report = Report::default();
    report.at_most("frequency_worst_error", worst_frequency_error(), 1e-4, "4 modes against finite elements, relative");
    for (key, ratio) in [("taper_0_5_error", 0.5), ("taper_0_2_error", 0.2)] {
        let beam = TaperedBeam { tip_radius_m: ratio * UNIFORM.base_radius_m, ..UNIFORM };
        let assumed = beam.natural_omega_rad_s(&CantileverMode::nth(1), 0.0);
        let error = assumed / finite_element_omegas(&beam)[0] - 1.0;
        report.record(key, error, "mode 1 of a cone with the uniform beam's shape");
    }
    report.at_most("steady_vs_duhamel", steady_error(16), 5e-4, "rms, relative, oversampling 16");
    report.record("steady_vs_duhamel_4", steady_error(4), "the same, oversampling 4");
    report.record("steady_vs_duhamel_1", steady_error(1), "the same, oversampling 1");
    report
}

fn worst_frequency_error() -> f64 {
    let area_m2 = PI * UNIFORM.base_radius_m.powi(2);
    let second_moment_m4 = disc_second_moment_m4(UNIFORM.base_radius_m);
    let closed = |n: usize| {
        let (modulus, density) = (UNIFORM.young_modulus_pa, UNIFORM.density_kg_m3);
        natural_omega_rad_s(&CantileverMode::nth(n), modulus, second_moment_m4, density, area_m2, UNIFORM.length_m)
    };
    let computed = finite_element_omegas(&UNIFORM);
    (1..=4).map(|n| (closed(n) / computed[n - 1] - 1.0).abs()).fold(0.0, f64::max)
}

/// Natural angular frequencies, lowest first, by Euler-Bernoulli beam elements with Hermite cubics. Each has the radius of its
/// middle.
fn finite_element_omegas(beam: &TaperedBeam) -> Vec<f64> {
    const ELEMENTS: usize = 50;
    let length = beam.length_m / ELEMENTS as f64;
    let freedoms = 2 * (ELEMENTS + 1);
    let mut stiffness = DMatrix::<f64>::zeros(freedoms, freedoms);
    let mut mass = stiffness.clone();
    for element in 0..ELEMENTS {
        let radius_m = beam.radius_m((element as f64 + 0.5) / ELEMENTS as f64);
        let rigidity = beam.young_modulus_pa * disc_second_moment_m4(radius_m) / length.powi(3);
        let weight = beam.density_kg_m3 * PI * radius_m.powi(2) * length / 420.0;
        let add = |matrix: &mut DMatrix<f64>, part: Matrix4<f64>| {
            let mut block = matrix.fixed_view_mut::<4, 4>(2 * element, 2 * element);
            block += part;
        };
        add(&mut stiffness, rigidity * element_stiffness(length));
        add(&mut mass, weight * element_mass(length));
    }
    // The root is clamped, so its two degrees of freedom are left out.
    let stiffness = stiffness.view((2, 2), (freedoms - 2, freedoms - 2)).into_owned();
    let mass = mass.view((2, 2), (freedoms - 2, freedoms - 2)).into_owned();
    let lower = mass.cholesky().expect("a mass matrix is positive definite").l();
    let half = lower.solve_lower_triangular(&stiffness).expect("its factor is regular");
    let standard = lower.solve_lower_triangular(&half.transpose()).expect("its factor is regular");
    let symmetric = (&standard + standard.transpose()) / 2.0;
    let mut omegas: Vec<f64> = SymmetricEigen::new(symmetric).eigenvalues.iter().map(|value| value.sqrt()).collect();
    omegas.sort_by(f64::total_cmp);
    omegas
}

#[rustfmt::skip]
fn element_stiffness(l: f64) -> Matrix4<f64> {
    Matrix4::new(
        12.0,    6.0 * l,     -12.0,    6.0 * l,
        6.0 * l, 4.0 * l * l, -6.0 * l, 2.0 * l * l,
        -12.0,   -6.0 * l,    12.0,     -6.0 * l,
        6.0 * l, 2.0 * l * l, -6.0 * l, 4.0 * l * l,
    )
}

#[rustfmt::skip]
fn element_mass(l: f64) -> Matrix4<f64> {
    Matrix4::new(
        156.0,     22.0 * l,     54.0,      -13.0 * l,
        22.0 * l,  4.0 * l * l,  13.0 * l,  -3.0 * l * l,
        54.0,      13.0 * l,     156.0,     -22.0 * l,
        -13.0 * l, -3.0 * l * l, -22.0 * l, 4.0 * l * l,
    )
}

/// Relative rms difference of the exact steady state and the Duhamel integral four periods after its start, for an oscillator
/// of 1 Hz under the drag of a turbulent wind.
fn steady_error(oversampling: usize) -> f64 {
    const SAMPLES: usize = 256;
    const PERIODS: usize = 5;
    let load: Vec<f64> = test_wind(1, SAMPLES, oversampling, TURBULENCE_INTENSITY)
        .iter()
        .map(|wind| f64::from(wind.length() * wind.x))
        .collect();
    let mean = load.iter().sum::<f64>() / load.len() as f64;
    let load: Vec<f64> = load.iter().map(|value| value - mean).collect();
    let time_step_s = 1.0 / (16.0 * oversampling as f64);
    let oscillator = Oscillator::new(TAU, 0.05);
    let steady = oscillator.periodic_response(&load, time_step_s);
    let long: Vec<f64> = load.iter().copied().cycle().take(PERIODS * load.len()).collect();
    let last_period = (PERIODS - 1) * load.len();
    let (mut error, mut size) = (0.0, 0.0);
    for step in (0..load.len()).step_by(oversampling) {
        let integral = oscillator.duhamel_at(&long, time_step_s, last_period + step);
        error += (integral - steady[step]).powi(2);
        size += steady[step].powi(2);
    }
    (error / size).sqrt()
}
