use super::*;

/// Answers of modes of these frequencies (by the lowest sample's) and shares.
fn answers(modes: &[(f64, f64)]) -> Samples {
    let damping = 2.0 * SAMPLE_DAMPING_RATIO;
    let part = |index: usize| -> f32 {
        let sum = |of: usize| modes.iter().map(|(natural, share)| share * samples_of(*natural)[of]).sum::<f64>();
        let [re, im] = [sum(index % SAMPLES), sum(index % SAMPLES + SAMPLES)];
        // Of hinges of the stiffness K.
        (if index < SAMPLES { re - damping * im } else { im + damping * re }) as f32
    };
    std::array::from_fn(|four| Vec4::from_array(std::array::from_fn(|lane| part(4 * four + lane))))
}

fn found(modes: &[(f64, f64)]) -> Option<Resonance> {
    LagCurve::shared().resonance(&answers(modes), 1.0)
}

#[test]
fn one_mode_is_found() {
    for natural in [1.0, 1.2, 1.5, 2.0, 3.3, 5.0, 9.0] {
        let Resonance { frequency_hz, second } = found(&[(natural, 1.0)]).expect("within the frequencies tried");
        assert!((frequency_hz / natural - 1.0).abs() < 0.02, "{frequency_hz} of {natural}");
        assert_eq!(second, None, "{natural}");
    }
    // Slower than all samples, it is known by its flank.
    assert!(found(&[(0.7, 1.0)]).is_some_and(|it| (it.frequency_hz / 0.7 - 1.0).abs() < 0.12));
}

/// The sharpest peak, that of one mode, comes out some 9% too low: the samples are of a greater damping ratio.
#[test]
fn lags_between_samples_are_those_of_the_modes() {
    let curve = LagCurve::shared();
    for modes in [&[(2.0, 1.0)][..], &[(1.3, 0.4), (1.8, 0.3), (4.0, 0.3)], &[(3.1, 0.6), (6.5, 0.4)]] {
        let samples = answers(modes);
        let sharpest = modes.iter().map(|mode| mode.1).fold(0.0, f64::max) * lag(1.0);
        for ((frequency, _), weights) in curve.points.iter().zip(&curve.weights).skip(POINTS_BEFORE as usize) {
            let estimated: f32 = weights.iter().zip(&samples).map(|(a, b)| a.dot(*b)).sum();
            let expected: f64 = modes.iter().map(|(natural, share)| share * lag(frequency / natural)).sum();
            let error = (f64::from(estimated) - expected) / sharpest;
            assert!(error.abs() < 0.1, "{modes:?} {frequency}: {estimated} {expected}");
        }
    }
}

#[test]
fn two_modes_are_found_with_their_shares() {
    for (slower, faster) in [(2.0, 3.0), (1.5, 3.0), (1.2, 4.0), (2.5, 3.4)] {
        for share in [0.4, 0.5, 0.6] {
            let Resonance { frequency_hz, second } =
                found(&[(slower, 1.0 - share), (faster, share)]).expect("two peaks");
            let second = second.expect("another");
            let told = format!("{slower} {faster} {share}: {frequency_hz} {second:?}");
            let is_slower_first = frequency_hz < second.frequency_hz;
            let (low_hz, high_hz) = (frequency_hz.min(second.frequency_hz), frequency_hz.max(second.frequency_hz));
            let faster_share = if is_slower_first { second.share } else { 1.0 - second.share };
            assert!((low_hz / slower - 1.0).abs() < 0.02 && (high_hz / faster - 1.0).abs() < 0.02, "{told}");
            assert!((faster_share - share).abs() < 0.03, "{told}");
        }
    }
}

#[test]
fn of_two_modes_that_are_as_strong_the_slower_is_the_first() {
    for (slower, faster) in [(0.5, 0.5), (0.48, 0.52), (0.6, 0.4)] {
        let hz = found(&[(2.0, slower), (3.0, faster)]).map(|it| it.frequency_hz).expect("two peaks");
        assert!((hz / 2.0 - 1.0).abs() < 0.03, "{hz}");
    }
    assert!(found(&[(2.0, 0.3), (3.0, 0.7)]).is_some_and(|it| it.frequency_hz > 2.9), "the stronger one");
}

#[test]
fn weak_modes_and_flanks_are_no_second_frequencies() {
    assert_eq!(found(&[(2.0, 0.85), (4.0, 0.15)]).and_then(|it| it.second), None);
    assert_eq!(found(&[(2.0, 0.5), (2.2, 0.5)]).and_then(|it| it.second), None, "one peak");
    assert_eq!(LagCurve::shared().resonance(&[Vec4::ZERO; 2 * FOURS], 1.0), None);
    assert_eq!(LagCurve::shared().resonance(&[Vec4::NAN; 2 * FOURS], 1.0), None);
    let beyond = sample_frequency(SAMPLES + 2);
    assert_eq!(found(&[(2.0, 0.02), (beyond, 0.98)]), None, "a weak one is not taken for what is beyond");
}
