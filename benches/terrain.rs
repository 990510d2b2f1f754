//! How long random ground takes to read, and a map to analyse.

use bevy::math::DVec2;
use bevy_windwood::terrain::{
    CovarianceModel, ElevationGrid, Heightfield, TurningBands, TurningBandsSettings, Variogram, VariogramSettings,
    fit_model, fit_models,
};
use criterion::{Criterion, criterion_group, criterion_main};
use std::hint::black_box;

/// 16 lines x 100 harmonics.
fn ground() -> TurningBands {
    TurningBands::new(&TurningBandsSettings::default()).expect("the default settings are valid")
}

fn field(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("turning_bands");
    group.bench_function("new", |bencher| {
        bencher.iter(|| TurningBands::new(black_box(&TurningBandsSettings::default())));
    });
    let ground = ground();
    let mut step = 0_u32;
    // Neighbours of a mesh first, then places all over the land.
    let mut near = move || {
        step = step.wrapping_add(1);
        DVec2::new(f64::from(step % 256), f64::from(step / 256 % 256))
    };
    let mut far = move || {
        step = step.wrapping_add(1);
        DVec2::new(f64::from(step.wrapping_mul(7919) % 65_521), f64::from(step.wrapping_mul(104_729) % 65_521))
    };
    group.bench_function("height_near", |bencher| bencher.iter(|| ground.height_m(black_box(near()))));
    group.bench_function("height_scattered", |bencher| bencher.iter(|| ground.height_m(black_box(far()))));
    group.bench_function("gradient", |bencher| bencher.iter(|| ground.gradient(black_box(far()))));
    group.bench_function("exact_height", |bencher| bencher.iter(|| ground.exact_height_m(black_box(far()))));
    group.finish();
}

fn estimation(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("estimation");
    group.sample_size(10);
    let map = ElevationGrid::sample(&ground(), DVec2::ZERO, 1024, 1024, DVec2::splat(4.0)).expect("a valid grid");
    let settings = VariogramSettings::default();
    group.bench_function("variogram_1024", |bencher| bencher.iter(|| Variogram::estimate(black_box(&map), &settings)));
    let variogram = Variogram::estimate(&map, &settings).expect("the map is rough");
    group.bench_function("fit_one", |bencher| {
        bencher.iter(|| fit_model(black_box(&variogram), CovarianceModel::Bessel));
    });
    group
        .bench_function("fit_all", |bencher| bencher.iter(|| fit_models(black_box(&variogram), &CovarianceModel::ALL)));
    group.finish();
}

criterion_group!(benches, field, estimation);
criterion_main!(benches);
