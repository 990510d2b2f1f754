//! The time to synthesise a wind field, and to sample it.

use bevy::{
    math::Vec3,
    tasks::{ComputeTaskPool, TaskPool},
};
use bevy_windwood::wind::{FieldResolution, FieldSettings, WindField};
use criterion::{Criterion, criterion_group, criterion_main};
use std::hint::black_box;

fn synthesis(criterion: &mut Criterion) {
    ComputeTaskPool::get_or_init(TaskPool::default);
    let mut group = criterion.benchmark_group("synthesis");
    group.sample_size(10);
    let cubes = FieldResolution { time_samples: 512, columns: 32, levels: 32, ..Default::default() };
    for (name, resolution) in [("512x32x32", cubes), ("default", FieldResolution::default())] {
        let settings = FieldSettings { resolution, ..Default::default() };
        group.bench_function(name, |bencher| bencher.iter(|| WindField::synthesise(black_box(&settings))));
    }
    group.finish();
}

fn sample(criterion: &mut Criterion) {
    let field = WindField::synthesise(&FieldSettings::default()).expect("the default settings are valid");
    let mut place = 0_u32;
    criterion.bench_function("sample", |bencher| {
        bencher.iter(|| {
            place = place.wrapping_add(1);
            let [x, z] = [37, 91].map(|stride| (place.wrapping_mul(stride) % 1021) as f32);
            field.sample(black_box(Vec3::new(x, 0.03 * z, z)), f64::from(place) * 0.01)
        });
    });
    let mut out = Vec::new();
    criterion.bench_function("column_velocities", |bencher| {
        bencher.iter(|| field.column_velocities(black_box(3), 9.0, &mut out));
    });
}

criterion_group!(benches, synthesis, sample);
criterion_main!(benches);
