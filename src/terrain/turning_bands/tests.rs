use super::*;
use crate::terrain::{Anisotropy, CovarianceModel};
use approx::assert_relative_eq;
use std::thread;

fn settings(model: CovarianceModel) -> TurningBandsSettings {
    let scale_m = 100.0;
    TurningBandsSettings { model, scale_m, deviation_m: 10.0, finest_wavelength_m: 4.0, ..Default::default() }
}

fn field(settings: &TurningBandsSettings) -> TurningBands {
    TurningBands::new(settings).unwrap()
}

/// Scattered places.
fn places(count: u32) -> impl Iterator<Item = DVec2> {
    (0..count).map(f64::from).map(|index| DVec2::new(index * 7.31 - 900.0, index * index * 0.173 % 3000.0))
}

fn rms(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), value| (sum + value * value, count + 1.0));
    (sum / count).sqrt()
}

#[test]
fn the_lookup_error_is_the_predicted_one_and_below_a_thousandth_of_the_deviation() {
    for model in CovarianceModel::ALL {
        let field = field(&settings(model));
        let error_m = rms(places(2000).map(|place| field.height_m(place) - field.exact_height_m(place)));
        // Single precision adds its own part in 10^7 of the coefficients where the spline does not err.
        let predicted_m = field.lookup_error_m() + 1e-6 * field.settings().deviation_m;
        assert!(error_m < 1.1 * predicted_m, "{model:?}: {error_m} m, predicted {predicted_m} m");
        assert!(error_m > 0.5 * field.lookup_error_m(), "{model:?}: {error_m} m, predicted {predicted_m} m");
        assert!(field.lookup_error_m() < 1e-3 * field.settings().deviation_m, "{model:?}: {predicted_m} m");
    }
}

#[test]
fn gradients_are_those_of_the_heights() {
    for model in [CovarianceModel::Exponential, CovarianceModel::Bessel, CovarianceModel::DoubleExponential] {
        let field = field(&TurningBandsSettings {
            anisotropy: Anisotropy { ratio: 3.0, azimuth_deg: 25.0 },
            ..settings(model)
        });
        let step = 1e-3;
        for place in places(200) {
            let rise = |step: DVec2| field.exact_height_m(place + step) - field.exact_height_m(place - step);
            let by_difference = DVec2::new(rise(step * DVec2::X), rise(step * DVec2::Y)) / (2.0 * step);
            assert_relative_eq!(field.exact_gradient(place).x, by_difference.x, epsilon = 1e-4);
            assert_relative_eq!(field.exact_gradient(place).y, by_difference.y, epsilon = 1e-4);
        }
        let error = rms(places(2000).map(|place| (field.gradient(place) - field.exact_gradient(place)).length()));
        let size = rms(places(2000).map(|place| field.exact_gradient(place).length()));
        assert!(error < 0.03 * size, "{model:?}: {error} of {size}");
    }
}

/// Mean over places of the product of elevations a lag apart, for each lag.
fn covariances(field: &TurningBands, lags: &[DVec2]) -> Vec<f64> {
    let product = |lag: DVec2| places(600).map(move |place| field.height_m(place) * field.height_m(place + lag));
    lags.iter().map(|&lag| product(lag).sum::<f64>() / 600.0).collect()
}

#[test]
fn the_covariance_is_the_model_s_in_every_direction() {
    const SEEDS: u64 = 24;
    let lags = [DVec2::ZERO, DVec2::new(40.0, 10.0), DVec2::new(-60.0, 90.0), DVec2::new(30.0, -150.0)];
    for model in CovarianceModel::ALL {
        for anisotropy in [Anisotropy::default(), Anisotropy { ratio: 2.5, azimuth_deg: 30.0 }] {
            let settings = TurningBandsSettings { anisotropy, harmonics: 40, ..settings(model) };
            let fields: Vec<_> =
                (0..SEEDS).map(|seed| field(&TurningBandsSettings { seed, ..settings.clone() })).collect();
            let measured: Vec<_> = fields.iter().map(|field| covariances(field, &lags)).collect();
            for (index, &lag) in lags.iter().enumerate() {
                let mean = measured.iter().map(|of_field| of_field[index]).sum::<f64>() / SEEDS as f64;
                let error = rms(measured.iter().map(|of_field| of_field[index] - mean)) / (SEEDS as f64).sqrt();
                let expected = fields[0].model_covariance_m2(lag);
                let allowed = 3.5 * error + 0.02 * settings.deviation_m.powi(2);
                assert!((mean - expected).abs() < allowed, "{model:?} at {lag}: {mean} +-{error}, not {expected}");
            }
        }
    }
}

#[test]
fn the_same_seed_gives_the_same_bits_on_any_thread() {
    let settings = settings(CovarianceModel::Bessel);
    let shared = field(&settings);
    let heights = |field: &TurningBands| places(300).map(|place| field.height_m(place)).collect::<Vec<_>>();
    let here = heights(&shared);
    assert_eq!(here, heights(&field(&settings)));
    thread::scope(|scope| {
        let threads = [0, 1].map(|_| scope.spawn(|| heights(&shared)));
        threads.into_iter().for_each(|thread| assert_eq!(thread.join().unwrap(), here));
    });
    assert_ne!(here, heights(&field(&TurningBandsSettings { seed: 1, ..settings })));
}

#[test]
fn ground_is_continuous_far_from_the_origin() {
    let field = field(&settings(CovarianceModel::DoubleExponential));
    // 10 000 km away, steps of a centimetre on a smooth field: the greatest must be as small as the slope allows.
    let start = DVec2::new(1e7, -1e7);
    let height = |step: u32| field.height_m(start + DVec2::new(0.01, 0.004) * f64::from(step));
    let rises: Vec<f64> = (0..100_000).map(|step| (height(step + 1) - height(step)).abs()).collect();
    let greatest_slope = rises.iter().fold(0.0f64, |greatest, &rise| greatest.max(rise)) / 0.0108;
    // Slopes of the model have the deviation sqrt(2) / scale x deviation = 0.14; 5 of them are never met.
    assert!(greatest_slope < 0.7, "{greatest_slope}");
    assert!(rms(places(1000).map(|place| field.height_m(start + place))) > 5.0);
}

#[test]
fn bad_places_have_ground_and_bad_settings_an_error() {
    let field = field(&TurningBandsSettings::default());
    for place in [DVec2::NAN, DVec2::INFINITY, DVec2::splat(f64::MAX), DVec2::new(-f64::MAX, 1.0)] {
        assert!(field.height_m(place).is_finite() && field.gradient(place).is_finite());
        assert!(field.exact_height_m(place).is_finite());
    }
    assert_eq!(field.height_m(DVec2::NAN), field.height_m(DVec2::ZERO));
    assert!(TurningBands::new(&TurningBandsSettings { scale_m: f64::NAN, ..Default::default() }).is_err());
}

#[test]
fn the_resolved_fraction_is_that_of_the_spectrum() {
    let rough = settings(CovarianceModel::Exponential);
    let coarse = TurningBandsSettings { finest_wavelength_m: 50.0, ..rough.clone() };
    assert_relative_eq!(field(&rough).resolved_fraction(), 1.0, epsilon = 0.01);
    // w scale = 2 pi 100 / 50
    let share = 1.0 - (1.0 + (TAU * 2.0).powi(2)).sqrt().recip();
    assert_relative_eq!(field(&coarse).resolved_fraction(), share, epsilon = 1e-6);
}
