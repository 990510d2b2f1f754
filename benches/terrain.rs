//! The time to sample random ground, and to analyse a map.

use bevy::math::DVec2;
use bevy_windwood::{
    Ground,
    terrain::{
        CovarianceModel, ElevationGrid, Layers, TerrainSettings, TurningBands, TurningBandsSettings, Variogram,
        VariogramSettings,
        chunk::{ChunkKey, chunk_vertices},
        fit_model, fit_models,
        pyramid::{Eye, Pyramid},
    },
};
use criterion::{Criterion, criterion_group, criterion_main};
use std::{hint::black_box, sync::Arc};

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

/// A chunk of ground as the examples have it: a map's stand-in and hills, and a selection of the pyramid from a new place.
fn chunks(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("chunk");
    let hills = TurningBandsSettings { finest_wavelength_m: 10.0, scale_m: 50.0, seed: 2, ..Default::default() };
    let hills = TurningBands::new(&hills).expect("valid settings");
    let ground = Layers(vec![Arc::new(ground()), Arc::new(hills)]);
    let mut column = 0;
    group.bench_function("build", |bencher| {
        bencher.iter(|| {
            column = (column + 1) % 500;
            chunk_vertices(&ground, None, ChunkKey { level: 1, column, row: 3 }, 2.0)
        });
    });
    let shape = TerrainSettings { reach_m: 40_000.0, ..Default::default() }.shape();
    let mut pyramid = Pyramid::new(shape);
    let mut x = 0.0;
    group.bench_function("look_40_km", |bencher| {
        bencher.iter(|| {
            x += 1.0;
            pyramid.select(&[Eye { place: DVec2::new(x, 0.0), above_ground_m: 2.0 }]);
            while let Some(key) = pyramid.next_to_build() {
                pyramid.receive(key);
            }
            pyramid.dropped().for_each(drop);
            pyramid.drawn().len()
        });
    });
    group.finish();
}

criterion_group!(benches, field, estimation, chunks);
criterion_main!(benches);
