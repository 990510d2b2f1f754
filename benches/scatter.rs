//! The time to plant a forest, and to find the law of a pattern.

#[path = "../tools/support/forest_plans.rs"]
mod forest_plans;

use bevy::math::IVec2;
use bevy_windwood::{
    LevelGround,
    scatter::{
        ForestPlan, Planter,
        counts::{CountKind, Frequencies, by_likelihood, characterise},
        plan::{Area, Shape},
    },
};
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use forest_plans::{shipped, shipped_with_many_areas};
use std::hint::black_box;

/// A million trees in 6,241 cells.
fn forest(criterion: &mut Criterion) {
    let shape = Shape::Rectangle { min_m: [-2500.0; 2], max_m: [2500.0; 2] };
    let area = Area { shape, density_per_ha: 400.0, least_distance_m: 1.0, ..Area::default() };
    let planter = Planter::new(&ForestPlan { areas: vec![area], ..ForestPlan::default() }).expect("a valid plan");
    let [first, last] = planter.cells().expect("something grows");
    let mut group = criterion.benchmark_group("plant");
    group.sample_size(10).throughput(Throughput::Elements(1_000_000));
    let mut planted = Vec::new();
    group.bench_function("million", |bencher| {
        bencher.iter(|| {
            let mut points = 0;
            for row in first.y..=last.y {
                for column in first.x..=last.x {
                    planter.plant(IVec2::new(column, row), &LevelGround(0.0), &mut planted);
                    points += planted.len();
                }
            }
            points
        });
    });
    group.finish();
}

/// The same cell, alone and in a landscape of others.
fn cell(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("plant_cell");
    for (name, plan) in [("small_forest", shipped()), ("huge_forest", shipped_with_many_areas())] {
        let planter = Planter::new(&plan).expect("a valid plan");
        let mut planted = Vec::new();
        group.bench_function(name, |bencher| {
            bencher.iter(|| planter.plant(black_box(IVec2::new(1, 1)), &LevelGround(0.0), &mut planted));
        });
    }
    group.finish();
}

fn fits(criterion: &mut Criterion) {
    let redwoods = Frequencies::new(vec![101, 44, 27, 12, 5, 4, 2, 0, 0, 1]).expect("a table of counts");
    let mut group = criterion.benchmark_group("fit");
    for kind in CountKind::ALL {
        group.bench_function(format!("{kind:?}"), |bencher| bencher.iter(|| by_likelihood(kind, black_box(&redwoods))));
    }
    group.bench_function("characterise", |bencher| bencher.iter(|| characterise(black_box(&redwoods))));
    group.finish();
}

criterion_group!(benches, forest, cell, fits);
criterion_main!(benches);
