//! The time to grow a tree, to mesh it, and to make its textures.

use std::hint::black_box;

use bevy::math::Vec3;
use bevy_windwood::tree::{
    Species, TreeModel, bark::bark_textures, body::BodyRay, individual::grow, leaf::leaf_textures,
};
use criterion::{Criterion, Throughput, criterion_group, criterion_main};

fn oak() -> Species {
    Species::from_ron(include_str!("../assets/species/oak.species.ron")).expect("the shipped oak is valid")
}

fn growth(criterion: &mut Criterion) {
    let oak = oak();
    criterion.bench_function("grow/oak", |bencher| bencher.iter(|| grow(black_box(&oak), oak.age.mature_years, 1)));
}

/// Bakes as many oaks as make 50,000 vertices: skeleton, mechanics, meshes and bounds.
fn bake(criterion: &mut Criterion) {
    let oak = oak();
    let vertices = |seed| {
        let model = TreeModel::bake(&oak, oak.age.mature_years, seed);
        model.wood.positions.len() + model.leaves.positions.len()
    };
    let mut total = 0;
    let seeds: Vec<u64> = (1..)
        .take_while(|&seed| {
            let wanted = total < 50_000;
            total += if wanted { vertices(seed) } else { 0 };
            wanted
        })
        .collect();
    let mut group = criterion.benchmark_group("bake");
    group.throughput(Throughput::Elements(total as u64));
    group.bench_function("oak_50k_vertices", |bencher| {
        bencher.iter(|| seeds.iter().map(|&seed| black_box(vertices(seed))).sum::<usize>());
    });
    group.finish();
}

/// Bakes one mature tree of every shipped species; the throughput is in vertices.
fn species(criterion: &mut Criterion) {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/species");
    let mut files: Vec<_> =
        std::fs::read_dir(folder).expect("it is shipped").flatten().map(|file| file.path()).collect();
    files.sort();
    let mut group = criterion.benchmark_group("bake_species");
    group.sample_size(20);
    for file in files {
        let text = std::fs::read_to_string(&file).expect("it is readable");
        let species = Species::from_ron(&text).expect("it is valid");
        let bake = || TreeModel::bake(black_box(&species), species.age.mature_years, 1);
        let model = bake();
        group.throughput(Throughput::Elements((model.wood.positions.len() + model.leaves.positions.len()) as u64));
        group.bench_function(&species.name, |bencher| bencher.iter(bake));
    }
    group.finish();
}

fn textures(criterion: &mut Criterion) {
    let oak = oak();
    let mut group = criterion.benchmark_group("texture");
    group.sample_size(20);
    group.bench_function("bark", |bencher| bencher.iter(|| bark_textures(black_box(&oak.wood.bark), 1)));
    group.bench_function("leaf", |bencher| bencher.iter(|| leaf_textures(black_box(&oak.foliage), &oak.wood.green, 1)));
    group.finish();
}

/// Rays through a mature oak.
fn body(criterion: &mut Criterion) {
    let oak = oak();
    let model = TreeModel::bake(&oak, oak.age.mature_years, 1);
    let (body, posed) = (&model.body, model.body.at_rest());
    let mut step = 0_u32;
    let mut ray = || {
        step = step.wrapping_add(1);
        let share = |of: u32| (step.wrapping_mul(of) % 1000) as f32 / 1000.0 - 0.5;
        let target = Vec3::new(6.0 * share(7919), model.height_m() * (0.5 + 0.8 * share(104_729)), 6.0 * share(15_485));
        let direction = Vec3::new(share(31), 0.4 * share(17), 1.0).normalize();
        BodyRay { origin: target - 12.0 * direction, direction, part_m: [0.0, 24.0] }
    };
    let mut group = criterion.benchmark_group("body");
    group.bench_function("hit", |bencher| bencher.iter(|| body.hit(&posed, black_box(&ray()))));
    group.bench_function("transmittance", |bencher| {
        bencher.iter(|| body.transmittance(&posed, black_box(&ray()), 1.0));
    });
    group.bench_function("pose", |bencher| {
        let poses = vec![bevy_windwood::dynamics::BeamPose::REST; body.limbs.beams().len()];
        bencher.iter(|| body.posed(black_box(&poses)));
    });
    group.finish();
}

criterion_group!(benches, growth, bake, species, textures, body);
criterion_main!(benches);
