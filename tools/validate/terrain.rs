//! Random ground against its covariance models, and the round trip: generate, estimate, fit.
//!
//! The covariance is measured from elevations alone. The closed forms of the models are written again here, so that the check
//! does not depend on the code it checks.

use crate::report::Report;
use bevy::math::DVec2;
use bevy_windwood::{
    Ground,
    terrain::{
        Anisotropy, CovarianceModel, Elevation, ElevationGrid, ElevationSettings, TurningBands, TurningBandsSettings,
        Variogram, VariogramSettings, fit_model, fit_models,
    },
};
use std::{thread, time::Instant};

/// Realisations of each model.
const FIELDS: u64 = 60;
/// Places on a side of the square over which a field's covariance is measured.
const SIDE: u32 = 40;
/// Distance of these places in ranges. It is large, so that they are nearly independent.
const PLACE_SPACING: f64 = 2.37;
/// A practical range, m. The round trip's maps have cells of 1 m.
const RANGE_M: f64 = 16.0;
/// Lags in practical ranges, and their directions.
const LAGS: [f64; 11] = [0.0, 0.0625, 0.125, 0.25, 0.375, 0.5, 0.75, 1.0, 1.25, 1.625, 2.0];
const DIRECTIONS_DEG: [f64; 4] = [0.0, 48.0, 90.0, 153.0];
/// Standard errors of a measured covariance that count as Monte Carlo error.
const STANDARD_ERRORS: f64 = 2.0;

/// Points on a side of the maps of the round trip: 64 ranges.
const MAP_SIDE: u32 = 1024;
const DIMENSIONS: [f64; 4] = [2.15, 2.3, 2.5, 2.7];

pub fn run() -> Report {
    let mut report = Report::default();
    let isotropic = covariance_errors(Anisotropy::default());
    let anisotropic = covariance_errors(Anisotropy { ratio: 2.0, azimuth_deg: 35.0 });
    let covariance = isotropic.beyond_chance.max(anisotropic.beyond_chance);
    report.at_most(
        "covariance_worst_error",
        covariance,
        0.03,
        "of the variance, to two ranges, beyond 2 standard errors",
    );
    report.record("covariance_worst_raw_error", isotropic.raw.max(anisotropic.raw), "of the variance, chance included");
    report.at_most("variance_worst_error", isotropic.variance.max(anisotropic.variance), 0.02, "relative, all models");

    let trips = round_trips();
    report.at_most("roundtrip_worst_error", trips.parameters, 0.1, "range and sill, relative, worst of all models");
    report.at_most(
        "fractal_dimension_worst_error",
        trips.dimension,
        0.05,
        "of a fractal surface, dimensions 2.15 to 2.7",
    );

    let lookup = lookup_errors();
    report.at_most("lookup_error", lookup.relative, 1e-3, "rms, fast against exact, over the deviation, all models");
    report.at_most("lookup_error_to_predicted", lookup.to_predicted, 1.1, "over the prediction of lookup_error_m()");
    report.record("lookup_time_us", lookup.fast_us, "one point of a mesh, 16 lines x 100 harmonics, worst model");
    report.record("exact_time_us", lookup.exact_us, "the same by the sums of harmonics");

    record_real_ground(&mut report);
    report.record("fields", FIELDS as f64, "realisations of each model");
    report
}

/// Covariance over variance at x scales, after Mantoglou & Wilson. The Bessel family and the fractal are computed from their
/// spectra.
fn correlation(model: CovarianceModel, x: f64) -> f64 {
    match model {
        CovarianceModel::Exponential => (-x).exp(),
        CovarianceModel::DoubleExponential => (-x * x).exp(),
        CovarianceModel::HoleExponential => (1.0 - 0.5 * x) * (-x).exp(),
        CovarianceModel::Spherical => (1.0 - x.min(1.0)).powi(2) * (1.0 + 0.5 * x.min(1.0)),
        CovarianceModel::Bessel => by_spectrum(x, 0.0, |w| 2.0 * w / (1.0 + w * w).powi(2)),
        CovarianceModel::WhittleA => by_spectrum(x, 0.0, |w| 4.0 * w.powi(3) / (1.0 + w * w).powi(3)),
        CovarianceModel::WhittleB => by_spectrum(x, 0.0, |w| 6.0 * w.powi(5) / (1.0 + w * w).powi(4)),
        CovarianceModel::Fractal { dimension } => {
            by_spectrum(x, 1.0, |w| (6.0 - 2.0 * dimension) * w.powf(2.0 * dimension - 7.0))
        }
    }
}

/// int f(w) J0(w x) dw from `lowest`, by the midpoint rule in w = lowest + sinh(v), with J0 as the mean of
/// cos(w x cos a) over directions a.
fn by_spectrum(x: f64, lowest: f64, density: impl Fn(f64) -> f64) -> f64 {
    const STEPS: u32 = 1500;
    const HIGHEST: f64 = 9.0;
    let step = HIGHEST / f64::from(STEPS);
    let term = |index: u32| {
        let v = (f64::from(index) + 0.5) * step;
        let w = lowest + v.sinh();
        let j0 = if w * x < 60.0 { j0_by_directions(w * x) } else { 0.0 };
        density(w) * j0 * v.cosh() * step
    };
    (0..STEPS).map(term).sum()
}

fn j0_by_directions(z: f64) -> f64 {
    const DIRECTIONS: u32 = 48;
    let angle = |index: u32| (f64::from(index) + 0.5) * std::f64::consts::PI / f64::from(DIRECTIONS);
    (0..DIRECTIONS).map(|index| (z * angle(index).cos()).cos()).sum::<f64>() / f64::from(DIRECTIONS)
}

/// A field with a deviation of 1 m.
fn settings(model: CovarianceModel, seed: u64) -> TurningBandsSettings {
    let scale_m = RANGE_M / model.practical_range();
    TurningBandsSettings { model, scale_m, deviation_m: 1.0, finest_wavelength_m: 0.1, seed, ..Default::default() }
}

#[derive(Default)]
struct CovarianceErrors {
    raw: f64,
    beyond_chance: f64,
    variance: f64,
}

fn covariance_errors(anisotropy: Anisotropy) -> CovarianceErrors {
    let mut worst = CovarianceErrors::default();
    let along = |direction_deg: f64| LAGS.map(|lag| lag * RANGE_M * DVec2::from_angle(direction_deg.to_radians()));
    let lags: Vec<DVec2> = DIRECTIONS_DEG.into_iter().flat_map(along).collect();
    for model in CovarianceModel::ALL {
        let fields = in_parallel(FIELDS, |seed| {
            let settings = TurningBandsSettings { anisotropy, ..settings(model, seed) };
            field_covariances(&settings, &lags)
        });
        for (index, lag) in lags.iter().enumerate() {
            let values: Vec<f64> = fields.iter().map(|field| field[index]).collect();
            let (mean, error) = mean_and_error(&values);
            let expected = correlation(model, stretched(anisotropy, *lag) * model.practical_range() / RANGE_M);
            let raw = (mean - expected).abs();
            worst.raw = worst.raw.max(raw);
            worst.beyond_chance = worst.beyond_chance.max(raw - STANDARD_ERRORS * error);
            if *lag == DVec2::ZERO {
                worst.variance = worst.variance.max(raw);
            }
        }
    }
    worst
}

/// Length of a lag whose part across the axis is stretched by the ratio.
fn stretched(anisotropy: Anisotropy, lag: DVec2) -> f64 {
    let (sin, cos) = anisotropy.azimuth_deg.to_radians().sin_cos();
    (lag.x * cos + lag.y * sin).hypot(anisotropy.ratio * (lag.y * cos - lag.x * sin))
}

/// Mean products of one field about its known mean of 0.
fn field_covariances(settings: &TurningBandsSettings, lags: &[DVec2]) -> Vec<f64> {
    let field = TurningBands::new(settings).expect("the settings are valid");
    let place = |index: u32| PLACE_SPACING * RANGE_M * DVec2::new(f64::from(index % SIDE), f64::from(index / SIDE));
    let places: Vec<(DVec2, f64)> = (0..SIDE * SIDE).map(place).map(|place| (place, field.height_m(place))).collect();
    let product = |&lag: &DVec2| {
        let sum: f64 = places.iter().map(|&(place, height_m)| height_m * field.height_m(place + lag)).sum();
        sum / places.len() as f64
    };
    lags.iter().map(product).collect()
}

fn mean_and_error(values: &[f64]) -> (f64, f64) {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let variance = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / (count - 1.0);
    (mean, (variance / count).sqrt())
}

struct RoundTrips {
    parameters: f64,
    dimension: f64,
}

fn round_trips() -> RoundTrips {
    let estimate = |settings: &TurningBandsSettings| {
        let ground = TurningBands::new(settings).expect("the settings are valid");
        let first = DVec2::new(-7e4, 3e5);
        let grid = ElevationGrid::sample(&ground, first, MAP_SIDE, MAP_SIDE, DVec2::ONE).expect("a valid grid");
        let variogram_settings = VariogramSettings { longest_lag: 0.125, ..Default::default() };
        let variogram = Variogram::estimate(&grid, &variogram_settings).expect("the map is rough");
        fit_model(&variogram, settings.model).expect("there are classes enough")
    };
    let relative = |seed: u64| {
        let model = CovarianceModel::ALL[seed as usize];
        let fit = estimate(&settings(model, seed));
        let range = (fit.practical_range_m() / RANGE_M - 1.0).abs();
        range.max((fit.deviation_m.powi(2) - 1.0).abs())
    };
    let dimension = |seed: u64| {
        let dimension = DIMENSIONS[seed as usize];
        let fit = estimate(&settings(CovarianceModel::Fractal { dimension }, seed));
        match fit.model {
            CovarianceModel::Fractal { dimension: found } => (found - dimension).abs(),
            _ => f64::NAN,
        }
    };
    let worst = |errors: Vec<f64>| errors.into_iter().fold(0.0, f64::max);
    RoundTrips {
        parameters: worst(in_parallel(CovarianceModel::ALL.len() as u64, relative)),
        dimension: worst(in_parallel(DIMENSIONS.len() as u64, dimension)),
    }
}

#[derive(Default)]
struct LookupErrors {
    relative: f64,
    to_predicted: f64,
    fast_us: f64,
    exact_us: f64,
}

fn lookup_errors() -> LookupErrors {
    const POINTS: u32 = 20_000;
    let mut worst = LookupErrors::default();
    let places: Vec<DVec2> =
        (0..POINTS).map(f64::from).map(|index| DVec2::new(index * 7.31 - 9e4, index * index * 0.173 % 3e5)).collect();
    for model in CovarianceModel::ALL {
        // The default field, of each model.
        let settings = TurningBandsSettings { model, ..Default::default() };
        let field = TurningBands::new(&settings).expect("the settings are valid");
        let fast: Vec<f64> = places.iter().map(|&place| field.height_m(place)).collect();
        let start = Instant::now();
        let sum: f64 =
            (0..POINTS).map(|index| field.height_m(DVec2::new((index % 200).into(), (index / 200).into()))).sum();
        let fast_us = start.elapsed().as_secs_f64() * 1e6 / f64::from(POINTS);
        std::hint::black_box(sum);
        let start = Instant::now();
        let squares = places.iter().zip(&fast).map(|(&place, fast)| (field.exact_height_m(place) - fast).powi(2));
        let error_m = (squares.sum::<f64>() / f64::from(POINTS)).sqrt();
        worst.exact_us = worst.exact_us.max(start.elapsed().as_secs_f64() * 1e6 / f64::from(POINTS));
        worst.fast_us = worst.fast_us.max(fast_us);
        worst.relative = worst.relative.max(error_m / settings.deviation_m);
        // Where the spline is nearly exact, single precision adds an error of 1e-6.
        let predicted_m = field.lookup_error_m() + 1e-6 * settings.deviation_m;
        worst.to_predicted = worst.to_predicted.max(error_m / predicted_m);
    }
    worst
}

/// Records which model fits the shipped map best.
fn record_real_ground(report: &mut Report) {
    let bytes = include_bytes!("../../assets/terrain/rmnp-dem-16bit.png");
    let map =
        Elevation::read("", bytes, &ElevationSettings::with_cells(233.0, 234.0)).expect("the shipped map is valid");
    let variogram = Variogram::estimate(&map.grid, &VariogramSettings::default()).expect("mountains are not level");
    let fits = fit_models(&variogram, &CovarianceModel::ALL).expect("there are classes enough");
    report.record("real_ground_best_residual", fits[0].residual, fits[0].model.name());
    report.record("real_ground_worst_residual", fits[7].residual, fits[7].model.name());
    for fit in fits {
        match fit.model {
            CovarianceModel::Exponential => report.record("real_ground_exponential_scale_m", fit.scale_m, ""),
            CovarianceModel::Fractal { dimension } => report.record("real_ground_dimension", dimension, "by the fit"),
            _ => {}
        }
    }
}

/// Results of `work` for 0 to `count`, in order, computed on all threads of the machine.
fn in_parallel<T: Send>(count: u64, work: impl Fn(u64) -> T + Sync) -> Vec<T> {
    let threads = thread::available_parallelism().map_or(1, |threads| threads.get() as u64).min(count);
    let mut results: Vec<(u64, T)> = thread::scope(|scope| {
        let work = &work;
        let of_thread = |thread: u64| {
            scope.spawn(move || (thread..count).step_by(threads as usize).map(|n| (n, work(n))).collect::<Vec<_>>())
        };
        let handles: Vec<_> = (0..threads).map(of_thread).collect();
        handles.into_iter().flat_map(|handle| handle.join().expect("no thread fails")).collect()
    });
    results.sort_by_key(|(n, _)| *n);
    results.into_iter().map(|(_, result)| result).collect()
}
