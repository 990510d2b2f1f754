//! What a frame, a question and a step of the viewer cost in forests of ten thousand trees to a million.

use bevy::{
    math::{IVec2, Vec2, Vec3, proj::perspective_infinite_reverse},
    prelude::Transform,
    shape::ViewFrustum,
};
use bevy_windwood::{
    cells::{Cell, CellLevels, CellStore, CellStream, Orders, StreamSettings, Sun, TreeExtent, Trunk, View, Viewpoint},
    lod::{Lens, LevelDistances},
    scatter::{
        ForestPlan, LevelGround, Planter,
        plan::{Area, Shape},
    },
};
use criterion::{BatchSize, BenchmarkId, Criterion, criterion_group, criterion_main};
use std::hint::black_box;

/// 20 m/s at 60 frames a second.
const STEP_M: f32 = 20.0 / 60.0;
const EXTENT: TreeExtent = TreeExtent { height_m: 25.0, reach_m: 7.0 };
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

/// A camera that goes round the middle of the forest and turns about.
fn view(frame: u32, distance_m: f32) -> View {
    let angle = frame as f32 * STEP_M / 1000.0;
    let eye_m = Vec3::new(1000.0 * angle.cos(), 2.0, 1000.0 * angle.sin());
    let forward = Vec3::new((5.0 * angle).sin(), -0.05, (5.0 * angle).cos());
    let clip_from_world = perspective_infinite_reverse(0.785, 16.0 / 9.0, 0.1)
        * Transform::from_translation(eye_m).looking_to(forward, Vec3::Y).to_matrix().inverse();
    let planes = ViewFrustum::from_clip_from_world(&clip_from_world).half_spaces.map(|space| space.normal_d());
    let sun = Sun { direction: Vec3::new(1.0, -0.8, 0.4), shadow_distance_m: 300.0, lowest_m: 0.0, longest_m: 500.0 };
    View { planes, eye_m, distance_m, sun: Some(sun) }
}

fn frames(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("frame");
    let lens = Lens { fov_rad: 0.785, picture_px: 1080.0 };
    let switches = LevelDistances::default().switches(25.0, lens);
    for (name, trees, side_m, distance_m) in [
        ("trees_1e4", 1e4, 10_000.0, 10_000.0),
        ("trees_1e5", 1e5, 10_000.0, 10_000.0),
        ("trees_1e6", 1e6, 10_000.0, 10_000.0),
        ("world_10_km_seen_3_km", 1e6, 10_000.0, 3000.0),
        ("world_20_km_seen_3_km", 4e6, 20_000.0, 3000.0),
    ] {
        let (store, _) = forest(trees, side_m);
        let (mut seen, mut levels, mut known, mut frame) = (Vec::new(), Vec::new(), CellLevels::default(), 0);
        group.bench_function(BenchmarkId::new("see_and_choose", name), |bencher| {
            bencher.iter(|| {
                frame += 1;
                store.see(&view(frame, distance_m), EXTENT, &mut seen);
                known.choose(&seen, &switches, &mut levels);
                seen.len()
            });
        });
        println!("{} cells seen", seen.len());
    }
    group.finish();
}

fn questions(criterion: &mut Criterion) {
    let (store, _) = forest(1e6, 10_000.0);
    let mut step = 0_u32;
    let mut place = move || {
        step = step.wrapping_add(1);
        Vec2::new((step.wrapping_mul(7919) % 9001) as f32, (step.wrapping_mul(104_729) % 9001) as f32) - 4500.0
    };
    let mut group = criterion.benchmark_group("question");
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
    let at = |x_m: f32| [Viewpoint { eye_m: Vec3::new(x_m, 2.0, 0.0), forward: Vec3::X }];
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

criterion_group!(benches, frames, questions, stream);
criterion_main!(benches);
