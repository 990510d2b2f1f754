//! How long the lower levels of detail of a tree take, on one core.

use std::hint::black_box;

use bevy_windwood::{
    lod::{CylinderLevel, LevelSettings, Scene, ViewAtlas, levels, simplify},
    tree::{
        Species, TreeModel,
        painting::{SpeciesTextures, paint},
    },
};
use criterion::{Criterion, criterion_group, criterion_main};

fn planted(text: &str) -> (Species, TreeModel, SpeciesTextures) {
    let species = Species::from_ron(text).expect("the shipped species is valid");
    let model = TreeModel::bake(&species, species.age.mature_years, 1);
    let textures = paint(&species);
    (species, model, textures)
}

/// All levels of a mature tree of each kind of crown.
fn all(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("levels");
    group.sample_size(10);
    for text in [
        include_str!("../assets/species/oak.species.ron"),
        include_str!("../assets/species/fir.species.ron"),
        include_str!("../assets/species/birch.species.ron"),
        include_str!("../assets/species/billows.species.ron"),
    ] {
        let (species, model, textures) = planted(text);
        let settings = LevelSettings::default();
        group.bench_function(&species.name, |bencher| {
            bencher.iter(|| levels(black_box(&species), &model, &textures, &settings));
        });
    }
    group.finish();
}

/// What the levels of an oak are made of.
fn parts(criterion: &mut Criterion) {
    let (species, model, textures) = planted(include_str!("../assets/species/oak.species.ron"));
    let settings = LevelSettings::default();
    let scene = Scene::new(&species, &model, &textures);
    let mut group = criterion.benchmark_group("oak_level");
    group.sample_size(10);
    group.bench_function("scene", |bencher| bencher.iter(|| Scene::new(black_box(&species), &model, &textures)));
    group.bench_function("cylinder", |bencher| {
        bencher.iter(|| CylinderLevel::bake(black_box(&scene), &species, &model, &settings.cylinder));
    });
    group.bench_function("views", |bencher| {
        bencher.iter(|| ViewAtlas::bake(black_box(std::slice::from_ref(&scene)), &settings.views));
    });
    group.bench_function("reduced", |bencher| {
        bencher.iter(|| simplify::reduce(black_box(&model), &settings.reductions[0]));
    });
    group.finish();
}

criterion_group!(benches, all, parts);
criterion_main!(benches);
