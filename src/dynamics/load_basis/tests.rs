use super::*;
use rand::rngs::Xoshiro256PlusPlus;
use rand::{RngExt, SeedableRng};

/// A turbulent wind of 8 m/s: independent Gaussian velocities, of an intensity of 0.2 along and less across.
fn gusts(count: usize, seed: u64) -> Vec<Vec3> {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
    let mut gaussian = || (0..12).map(|_| random.random::<f32>()).sum::<f32>() - 6.0;
    (0..count).map(|_| Vec3::new(8.0 + 1.6 * gaussian(), 0.84 * gaussian(), gaussian())).collect()
}

fn quadratic_drag(velocity: Vec3, direction: Vec3) -> Vec3 {
    let normal = velocity - velocity.dot(direction) * direction;
    normal.length() * normal
}

fn linear_drag(velocity: Vec3, direction: Vec3) -> Vec3 {
    velocity - velocity.dot(direction) * direction
}

/// Relative rms errors of the moving load over directions, in rising order.
fn errors(basis: &LoadBasis, winds: &[Vec3], load: fn(Vec3, Vec3) -> Vec3) -> Vec<f32> {
    let mut errors: Vec<f32> = hemisphere(97)
        .into_iter()
        .map(|direction| {
            let coefficients = basis.coefficients(direction);
            let direct: Vec<Vec3> = winds.iter().map(|&wind| load(wind, direction)).collect();
            let looked_up: Vec<Vec3> = winds.iter().map(|&wind| coefficients.load(basis.signals(wind))).collect();
            let means = (mean(direct.iter().copied()), mean(looked_up.iter().copied()));
            let moving = direct.iter().map(|&q| q - means.0);
            let error = looked_up.iter().zip(moving.clone()).map(|(&q, m)| (q - means.1 - m).length_squared());
            (error.sum::<f32>() / moving.map(Vec3::length_squared).sum::<f32>()).sqrt()
        })
        .collect();
    errors.sort_by(f32::total_cmp);
    errors
}

#[test]
fn principal_signals_have_a_smaller_error_than_orthogonal_beams() {
    let winds = gusts(2000, 1);
    let unseen = gusts(2000, 2);
    let median = |kind| errors(&LoadBasis::new(kind, &winds, quadratic_drag), &unseen, quadratic_drag)[48];
    let printed = median(LoadBasisKind::OrthogonalBeams { halved: false });
    let halved = median(LoadBasisKind::OrthogonalBeams { halved: true });
    let principal = median(LoadBasisKind::Principal);
    // The prototype's figures for an intensity of 0.2: 116%, 32% and 2 to 3%; here winds unseen by the regression.
    assert!(printed > 1.0 && halved < 0.4 && principal < 0.05, "{printed} {halved} {principal}");
}

#[test]
fn halved_orthogonal_beams_are_exact_for_linear_drag() {
    let winds = gusts(500, 3);
    let basis = LoadBasis::new(LoadBasisKind::OrthogonalBeams { halved: true }, &winds, linear_drag);
    // The nearest texel's coefficients are projected across its direction, then across the beam's: an error of the order
    // of half a texel, 1/128 of the square.
    assert!(*errors(&basis, &winds, linear_drag).last().unwrap() < 0.03);
}

#[test]
fn principal_signals_are_exact_for_linear_drag() {
    let winds = gusts(500, 4);
    let basis = LoadBasis::new(LoadBasisKind::Principal, &winds, linear_drag);
    // Three components of the velocity fit into four signals; what is left is the texel's.
    assert!(*errors(&basis, &winds, linear_drag).last().unwrap() < 0.03);
}

#[test]
fn mean_load_is_that_of_the_sample() {
    let winds = gusts(1000, 5);
    let basis = LoadBasis::new(LoadBasisKind::Principal, &winds, quadratic_drag);
    for direction in [Vec3::Y, Vec3::Z, Vec3::new(0.6, 0.8, 0.0)] {
        let direct = mean(winds.iter().map(|&wind| quadratic_drag(wind, direction)));
        let error = (basis.coefficients(direction).mean - direct).length() / direct.length();
        // Half a texel, as above.
        assert!(error < 0.02, "{error} for {direction}");
    }
}

#[test]
fn signals_have_no_mean_and_unit_variance() {
    let winds = gusts(1000, 6);
    let basis = LoadBasis::new(LoadBasisKind::Principal, &winds, quadratic_drag);
    let signals: Vec<Vec4> = winds.iter().map(|&wind| basis.signals(wind)).collect();
    let mean = signals.iter().sum::<Vec4>() / 1000.0;
    let variance = signals.iter().map(|&signal| signal * signal).sum::<Vec4>() / 1000.0;
    // Rounding of f32 loads of some 64 m^2/s^2; the fourth signal is a small part of them.
    assert!(mean.abs().max_element() < 1e-3, "{mean}");
    assert!((variance - 1.0).abs().max_element() < 1e-2, "{variance}");
}

#[test]
fn calm_and_nan_winds_give_no_load() {
    for winds in [&[][..], &[Vec3::ZERO; 10][..], &[Vec3::NAN; 3][..]] {
        for kind in [LoadBasisKind::Principal, LoadBasisKind::OrthogonalBeams { halved: true }] {
            let basis = LoadBasis::new(kind, winds, quadratic_drag);
            assert_eq!(basis.signals(Vec3::ZERO), Vec4::ZERO);
            assert_eq!(basis.coefficients(Vec3::Y).load(basis.signals(Vec3::NAN)), Vec3::ZERO);
        }
    }
}

#[test]
fn steady_wind_has_a_mean_load_and_no_signal() {
    let basis = LoadBasis::new(LoadBasisKind::Principal, &[Vec3::new(5.0, 0.0, 0.0); 100], quadratic_drag);
    let coefficients = basis.coefficients(Vec3::Y);
    assert!((coefficients.load(basis.signals(Vec3::X * 5.0)) - Vec3::X * 25.0).length() < 1e-4);
}

#[test]
fn basis_depends_on_the_wind_alone() {
    let build = || LoadBasis::new(LoadBasisKind::Principal, &gusts(3000, 7), quadratic_drag);
    assert_eq!(build().map(), build().map());
}
