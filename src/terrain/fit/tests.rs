use super::*;
use crate::{
    ground::Ground,
    terrain::{Elevation, ElevationGrid, ElevationSettings, TurningBands, VariogramSettings},
};
use approx::assert_relative_eq;

const CELL_M: f64 = 5.0;

/// A map of `side` x `side` cells of ground made by `settings`.
fn map(settings: &TurningBandsSettings, side: u32) -> ElevationGrid {
    let ground = TurningBands::new(settings).unwrap();
    ElevationGrid::sample(&ground, DVec2::new(-3e4, 1e4), side, side, DVec2::splat(CELL_M)).unwrap()
}

fn settings(model: CovarianceModel, seed: u64) -> TurningBandsSettings {
    // 16 cells to a range: 30 ranges and more to a map of 512.
    let scale_m = 16.0 * CELL_M / model.practical_range();
    TurningBandsSettings {
        model,
        scale_m,
        deviation_m: 30.0,
        // A sample of a map is a point of ground that has finer waves than its cells.
        finest_wavelength_m: 0.25 * CELL_M,
        lines: 64,
        seed,
        ..Default::default()
    }
}

fn variogram(grid: &ElevationGrid, sectors: u32) -> Variogram {
    Variogram::estimate(grid, &VariogramSettings { longest_lag: 0.2, sectors, ..Default::default() }).unwrap()
}

#[test]
fn the_parameters_of_made_ground_are_recovered() {
    for model in CovarianceModel::ALL {
        let settings = settings(model, 3);
        let fit = fit_model(&variogram(&map(&settings, 512), 1), model).unwrap();
        assert_relative_eq!(fit.practical_range_m(), 16.0 * CELL_M, max_relative = 0.1);
        assert_relative_eq!(fit.deviation_m.powi(2), 900.0, max_relative = 0.1);
    }
}

#[test]
fn the_model_that_made_the_ground_is_among_the_best() {
    for model in [CovarianceModel::Exponential, CovarianceModel::DoubleExponential, CovarianceModel::HoleExponential] {
        let fits = fit_models(&variogram(&map(&settings(model, 1), 512), 1), &CovarianceModel::ALL).unwrap();
        assert_eq!(fits.len(), 8);
        assert!(fits.is_sorted_by(|a, b| a.residual <= b.residual));
        let rank = fits.iter().position(|fit| fit.model == model).unwrap();
        assert!(rank < 2, "{model:?} is {rank} of {fits:?}");
    }
}

#[test]
fn the_dimension_of_a_fractal_is_recovered() {
    for dimension in [2.15, 2.4, 2.7] {
        let model = CovarianceModel::Fractal { dimension };
        let settings = TurningBandsSettings { harmonics: 400, ..settings(model, 5) };
        let fit = fit_model(&variogram(&map(&settings, 512), 1), model).unwrap();
        let CovarianceModel::Fractal { dimension: found } = fit.model else { panic!("a fractal stays one") };
        assert_relative_eq!(found, dimension, epsilon = 0.05);
    }
}

#[test]
fn anisotropy_is_recovered_with_its_direction() {
    let anisotropy = Anisotropy { ratio: 2.5, azimuth_deg: 30.0 };
    let settings = TurningBandsSettings { anisotropy, ..settings(CovarianceModel::Exponential, 8) };
    let fit = fit_model(&variogram(&map(&settings, 512), 8), CovarianceModel::Exponential).unwrap();
    assert_relative_eq!(fit.anisotropy.ratio, 2.5, max_relative = 0.15);
    assert_relative_eq!(fit.anisotropy.azimuth_deg, 30.0, epsilon = 5.0);
    assert_relative_eq!(fit.scale_m, settings.scale_m, max_relative = 0.15);
}

#[test]
fn fits_do_not_depend_on_units() {
    let grid = map(&settings(CovarianceModel::Bessel, 2), 128);
    let heights_km = grid.heights_m().iter().map(|height| height * 1e-3).collect();
    let small = ElevationGrid::new(128, 128, DVec2::splat(CELL_M * 1e-3), heights_km).unwrap();
    let [in_m, in_km] = [&grid, &small].map(|grid| fit_model(&variogram(grid, 1), CovarianceModel::Bessel).unwrap());
    assert_relative_eq!(in_m.scale_m, in_km.scale_m * 1e3, max_relative = 1e-3);
    assert_relative_eq!(in_m.deviation_m, in_km.deviation_m * 1e3, max_relative = 1e-3);
}

#[test]
fn real_ground_is_fitted_and_reproduced() {
    let bytes = include_bytes!("../../../assets/terrain/rmnp-dem-16bit.png");
    let real = Elevation::read("", bytes, &ElevationSettings::with_cells(233.0, 234.0)).unwrap().grid;
    let variogram = Variogram::estimate(&real, &VariogramSettings::default()).unwrap();
    let fits = fit_models(&variogram, &CovarianceModel::ALL).unwrap();
    let best = fits[0];
    // No model has valleys cut by water; a sixth of the semivariance is what they may miss.
    assert!(best.residual < 0.16, "{best:?}");
    assert!(fits[7].residual > 2.0 * best.residual, "{fits:?}");
    // Kilometres: neither the cell nor what a fit of metres stops at.
    assert!(fits.iter().all(|fit| (1e3..3e4).contains(&fit.scale_m)), "{fits:?}");

    let ground = TurningBands::new(&best.settings(60.0, 1)).unwrap();
    let semivariance = |lag_m: f64| {
        let places =
            (0..4000_u32).map(|index| DVec2::new(f64::from(index) * 913.0, f64::from(index * 37 % 911) * 777.0));
        let square = |place: DVec2| (ground.height_m(place + lag_m * DVec2::X) - ground.height_m(place)).powi(2);
        places.map(square).sum::<f64>() / 8000.0
    };
    for class in variogram.classes().iter().filter(|class| class.distance_m < 8e3).step_by(4) {
        let made = semivariance(class.distance_m);
        // One realisation, 16 lines: a fifth of the sill is four of its standard errors.
        assert_relative_eq!(made, class.semivariance_m2, epsilon = 0.2 * best.deviation_m.powi(2));
    }
}

#[test]
fn a_variogram_of_too_few_classes_is_refused() {
    let grid = ElevationGrid::new(2, 2, DVec2::ONE, vec![1.0, 2.0, 5.0, 3.0]).unwrap();
    let variogram = Variogram::estimate(&grid, &VariogramSettings::default()).unwrap();
    let error = fit_model(&variogram, CovarianceModel::Exponential).unwrap_err().to_string();
    assert!(error.starts_with("`classes of the variogram` is 1"), "{error}");
}
