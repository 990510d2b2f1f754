use super::{
    cantilever::{CantileverMode, HIGHEST_MODE, TaperedBeam, disc_second_moment_m4, natural_omega_rad_s},
    oscillator::Oscillator,
    series::{load, relative_rms},
};
use approx::assert_relative_eq;
use std::f64::consts::PI;

const UNIFORM: TaperedBeam = TaperedBeam {
    length_m: 1.5,
    base_radius_m: 0.015,
    tip_radius_m: 0.015,
    young_modulus_pa: 8e9,
    density_kg_m3: 800.0,
};

fn modes() -> [CantileverMode; 4] {
    [1, 2, 3, 4].map(CantileverMode::nth)
}

#[test]
fn roots_are_those_of_the_characteristic_equation() {
    let published = [1.875_104_069, 4.694_091_133, 7.854_757_438, 10.995_540_735];
    for (mode, root) in modes().iter().zip(published) {
        // The published digits end at the ninth decimal.
        assert!((mode.eta_l() - root).abs() < 1e-9, "{} is not {root}", mode.eta_l());
    }
}

#[test]
fn mode_shapes_match_the_printed_formula() {
    for mode in modes() {
        let l = mode.eta_l();
        let d = (l.cos() + l.cosh()) / (l.sin() - l.sinh());
        let printed = |s: f64| (l * s).sin() - (l * s).sinh() + d * ((l * s).cos() - (l * s).cosh());
        for s in [0.1, 0.35, 0.6, 0.9, 1.0] {
            // Rounding, times the e^l that cancels in the printed form.
            assert!((mode.shape(s) - printed(s) / printed(1.0)).abs() < 1e-10);
        }
    }
    let first = CantileverMode::nth(1);
    // Nine decimals are published.
    assert!((-1.0 / first.sigma + 1.362_220_557).abs() < 1e-9);
}

#[test]
fn root_is_clamped_and_tip_is_free() {
    for mode in (1..=HIGHEST_MODE).map(CantileverMode::nth) {
        let size = mode.eta_l().powi(2);
        assert!(mode.shape(0.0).abs() < 1e-14 && mode.slope(0.0).abs() < 1e-14 * size);
        // The curvature's terms are of the size of eta^2.
        assert!((mode.shape(1.0) - 1.0).abs() < 1e-12 && mode.curvature(1.0).abs() < 1e-11 * size);
    }
}

#[test]
fn slope_and_curvature_are_the_derivatives() {
    let step = 1e-5;
    for mode in modes() {
        for s in [0.2, 0.5, 0.8] {
            let slope = (mode.shape(s + step) - mode.shape(s - step)) / (2.0 * step);
            let curvature = (mode.slope(s + step) - mode.slope(s - step)) / (2.0 * step);
            // Central differences are off by step^2 l^3 / 6, below 3e-8 relative.
            assert_relative_eq!(mode.slope(s), slope, max_relative = 1e-6, epsilon = 1e-6);
            assert_relative_eq!(mode.curvature(s), curvature, max_relative = 1e-6, epsilon = 1e-6);
        }
    }
}

#[test]
fn uniform_beam_has_the_closed_forms() {
    let mass = 800.0 * PI * 0.015f64.powi(2) * 1.5;
    let load_shares = [0.391_496, -0.216_968, 0.127_213, -0.090_949];
    for (mode, share) in modes().iter().zip(load_shares) {
        assert_relative_eq!(UNIFORM.generalised_mass(mode), mass / 4.0, max_relative = 1e-9);
        // Six decimals are published.
        assert!((UNIFORM.generalised_load(mode, |_| 1.0) / 1.5 - share).abs() < 6e-7);
        let closed = natural_omega_rad_s(mode, 8e9, disc_second_moment_m4(0.015), 800.0, PI * 0.015f64.powi(2), 1.5);
        assert_relative_eq!(UNIFORM.natural_omega_rad_s(mode, 0.0), closed, max_relative = 1e-9);
    }
}

#[test]
fn frequency_of_a_branch_of_a_metre_and_a_half_is_six_hertz() {
    let frequency_hz = UNIFORM.natural_omega_rad_s(&CantileverMode::nth(1), 0.0) / (2.0 * PI);
    // 5.9 Hz to two digits, for wood of 800 kg/m^3.
    assert!((frequency_hz - 5.9).abs() < 0.05, "{frequency_hz} Hz");
}

#[test]
fn taper_raises_the_first_frequency_and_carried_mass_lowers_it() {
    let mode = CantileverMode::nth(1);
    let cone = TaperedBeam { tip_radius_m: 0.005, ..UNIFORM };
    assert!(cone.natural_omega_rad_s(&mode, 0.0) > UNIFORM.natural_omega_rad_s(&mode, 0.0));
    // Four times the mass halves the frequency.
    let mass = UNIFORM.generalised_mass(&mode);
    let loaded = UNIFORM.natural_omega_rad_s(&mode, 3.0 * mass);
    assert_relative_eq!(loaded, UNIFORM.natural_omega_rad_s(&mode, 0.0) / 2.0, max_relative = 1e-12);
}

#[test]
fn duhamel_of_a_step_has_the_closed_form() {
    let (omega, xi, dt) = (7.0, 0.15, 0.01);
    let response = Oscillator::new(omega, xi).duhamel(&[omega * omega; 300], dt);
    let damped = omega * (1.0f64 - xi * xi).sqrt();
    for (index, value) in response.iter().enumerate() {
        let t = index as f64 * dt;
        let decay = (-xi * omega * t).exp();
        let closed = 1.0 - decay * ((damped * t).cos() + xi * omega / damped * (damped * t).sin());
        // A constant load is integrated without error but for rounding.
        assert!((value - closed).abs() < 1e-11, "{value} is not {closed} at {t} s");
    }
}

#[test]
fn long_duhamel_integral_settles_into_the_periodic_response() {
    // With xi w = 1.5 / s what is left of the beginning after nine periods is e^-13.5 = 1.4e-6.
    let oscillator = Oscillator::new(15.0, 0.1);
    let errors = [32, 64, 128].map(|count| {
        let steady = oscillator.periodic_response(&load(count, 1), 1.0 / count as f64);
        let long = oscillator.duhamel(&load(count, 10), 1.0 / count as f64);
        relative_rms(&long[9 * count..], &steady)
    });
    // A load linear between samples loses (w dt)^2 / 12 of each harmonic: 8% of the fifth at 32 samples.
    assert!(errors[0] < 0.08, "{errors:?}");
    // Second order: half the step, a quarter of the error.
    for pair in errors.windows(2) {
        assert!((pair[0] / pair[1] - 4.0).abs() < 0.2, "{errors:?}");
    }
}

#[test]
fn stiff_oscillators_follow_the_load_itself() {
    let loads = load(64, 1);
    let response = Oscillator::new(1e4, 0.05).periodic_response(&loads, 1.0 / 64.0);
    let scaled: Vec<f64> = response.iter().map(|value| value * 1e8).collect();
    // The fifth harmonic is at 31 rad/s: (31 / 1e4)^2 and 2 xi 31 / 1e4 are what is left.
    assert!(relative_rms(&scaled, &loads) < 1e-3);
}

#[test]
fn empty_loads_give_empty_responses() {
    let oscillator = Oscillator::new(1.0, 0.1);
    assert!(oscillator.duhamel(&[], 0.1).is_empty() && oscillator.periodic_response(&[], 0.1).is_empty());
}
