//! The cost of a query and of a step of the viewer in a forest of a million trees.

use bevy::math::{IVec2, Vec2, Vec3};
use bevy_windwood::{
    LevelGround,
    cells::{Cell, CellStore, CellStream, Orders, StreamSettings, Trunk, ViewerPose},
    scatter::{
        ForestPlan, Planter,
        plan::{Area, Shape},
    },
};
use criterion::{BatchSize, Criterion, criterion_group, criterion_main};
use std::hint::black_box;

/// 20 m/s at 60 frames a second.
const STEP_M: f32 = 20.0 / 60.0;
const TRUNKS: [Trunk; 1] = [Trunk { radius_m: 0.4, top_radius_m: 0.05, height_m: 20.0 }];

/// A square of woodland with so many trees, and its least and greatest cell.
fn forest(trees: f32, side_m: f32) -> (CellStore, [IVec2; 2]) {
    let shape = Shape::Rectangle { min_m: [-0.5 * side_m; 2], max_m: [0.5 * side_m; 2] };
    let area = Area { shape, density_per_ha: trees / (side_m * side_m) * 1e4, ..Area::default() };
    let planter = Planter::new(&ForestPlan { areas: vec![area], ..ForestPlan::default() }).expect("a valid plan");
    let mut store = CellStore::new(planter.cell_m()).expect("the plan's cells");
    let [first, last] = planter.cells().expect("something grows");
    let mut buffer = Vec::new();
    for row in first.y..=last.y {
        for column in first.x..=last.x {
            let cell = IVec2::new(column, row);
            store.insert(cell, Cell::plant(&planter, cell, &LevelGround(0.0), &mut buffer));
        }
    }
    println!("{} trees in {} cells, {:.1} bytes each", store.plants(), store.len(), per_tree(&store));
    (store, [first, last])
}

fn per_tree(store: &CellStore) -> f64 {
    store.bytes() as f64 / store.plants() as f64
}

fn queries(criterion: &mut Criterion) {
    let (store, _) = forest(1e6, 10_000.0);
    let mut step = 0_u32;
    let mut place = move || {
        step = step.wrapping_add(1);
        Vec2::new((step.wrapping_mul(7919) % 9001) as f32, (step.wrapping_mul(104_729) % 9001) as f32) - 4500.0
    };
    let mut group = criterion.benchmark_group("query");
    group.bench_function("nearest", |bencher| bencher.iter(|| store.nearest(black_box(place()), 10_000.0)));
    group.bench_function("within_30_m", |bencher| {
        bencher.iter(|| {
            let mut found = 0;
            store.within(black_box(place()), 30.0, |_| found += 1);
            found
        });
    });
    for (name, height_m) in [("ray_through_trunks", 1.5), ("ray_10_km_above", 30.0)] {
        group.bench_function(name, |bencher| {
            bencher.iter(|| {
                let (from, to) = (place(), place());
                let way = Vec3::new(to.x - from.x, 0.0, to.y - from.y);
                store.cast(Vec3::new(from.x, height_m, from.y), black_box(way), 10_000.0, &TRUNKS)
            });
        });
    }
    group.finish();
}

fn stream(criterion: &mut Criterion) {
    let (store, bounds) = forest(1e6, 10_000.0);
    let empty = CellStore::new(store.cell_m()).expect("the plan's cells");
    let settings = StreamSettings { most_ordered: 100_000, ..StreamSettings::default() };
    let at = |x_m: f32| [ViewerPose { eye_m: Vec3::new(x_m, 2.0, 0.0), forward: Vec3::X }];
    let new = |settings| CellStream::new(settings, store.cell_m(), Some(bounds)).expect("valid settings");
    let mut orders = Orders::default();
    let mut group = criterion.benchmark_group("stream");

    let near = StreamSettings { load_m: 3000.0, keep_m: 3300.0, ..settings };
    let mut walking = new(near);
    let mut x_m = 0.0;
    group.bench_function("walk", |bencher| {
        bencher.iter(|| {
            x_m = (x_m + STEP_M) % 1000.0;
            walking.step(&at(x_m), &store, &mut orders);
        });
    });
    group.bench_function("first_step_of_25000_cells", |bencher| {
        let step = |mut stream: CellStream| stream.step(&at(0.0), &empty, &mut orders);
        bencher.iter_batched(|| new(settings), step, BatchSize::SmallInput);
    });
    let side_m = store.cell_m();
    let wide = StreamSettings { load_m: 500.0 * side_m, keep_m: 510.0 * side_m, ..settings };
    let all = [IVec2::splat(-600), IVec2::splat(600)];
    group.bench_function("first_step_of_790000_cells", |bencher| {
        let step = |mut stream: CellStream| stream.step(&at(0.0), &empty, &mut orders);
        let new = || CellStream::new(wide, side_m, Some(all)).expect("valid settings");
        bencher.iter_batched(new, step, BatchSize::SmallInput);
    });
    let mut waiting = new(settings);
    waiting.step(&at(0.0), &empty, &mut orders);
    println!("{} cells wait", waiting.waiting());
    group.bench_function("next_step_of_25000_cells", |bencher| {
        let step = |mut stream: CellStream| {
            stream.step(&at(0.0), &empty, &mut orders);
            stream
        };
        bencher.iter_batched(|| waiting.clone(), step, BatchSize::SmallInput);
    });
    group.finish();
}

criterion_group!(benches, queries, stream);
criterion_main!(benches);
