//! The time to bake the lower levels of detail of a tree, on one core.

use std::hint::black_box;

use bevy_windwood::{
    lod::{EnvelopeLevel, ImpostorAtlas, LodBakeSettings, Scene, crossed_polygons, decimate},
    tree::{
        Species, TreeModel,
        textures::{SpeciesTextures, species_textures},
    },
};
use criterion::{Criterion, criterion_group, criterion_main};

fn grown(text: &str) -> (Species, TreeModel, SpeciesTextures) {
    let species = Species::from_ron(text).expect("the shipped species is valid");
    let model = TreeModel::bake(&species, species.age.mature_years, 1);
    let textures = species_textures(&species);
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
        let (species, model, textures) = grown(text);
        let settings = LodBakeSettings::default();
        group.bench_function(&species.name, |bencher| {
            bencher.iter(|| {
                let scene = Scene::new(black_box(&species), &model, &textures);
                let envelope = EnvelopeLevel::bake(&scene, &species, &model, &settings.envelope);
                let polygons = crossed_polygons(&scene, &model, envelope.as_ref());
                let impostors = ImpostorAtlas::bake(std::slice::from_ref(&scene), &settings.impostor);
                let decimated: Vec<_> = settings.decimations.iter().map(|one| decimate(&model, one)).collect();
                (envelope, polygons, impostors, decimated)
            });
        });
    }
    group.finish();
}

/// The parts of the levels of an oak.
fn parts(criterion: &mut Criterion) {
    let (species, model, textures) = grown(include_str!("../assets/species/oak.species.ron"));
    let settings = LodBakeSettings::default();
    let scene = Scene::new(&species, &model, &textures);
    let mut group = criterion.benchmark_group("oak_level");
    group.sample_size(10);
    group.bench_function("scene", |bencher| bencher.iter(|| Scene::new(black_box(&species), &model, &textures)));
    group.bench_function("envelope", |bencher| {
        bencher.iter(|| EnvelopeLevel::bake(black_box(&scene), &species, &model, &settings.envelope));
    });
    group.bench_function("impostors", |bencher| {
        bencher.iter(|| ImpostorAtlas::bake(black_box(std::slice::from_ref(&scene)), &settings.impostor));
    });
    group.bench_function("decimated", |bencher| {
        bencher.iter(|| decimate(black_box(&model), &settings.decimations[0]));
    });
    group.finish();
}

criterion_group!(benches, all, parts);
criterion_main!(benches);
