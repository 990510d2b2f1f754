//! An exported tree is read by Bevy's own glTF loader and looks as the crate draws it, at rest and under one light. Needs a Vulkan driver.
//! Mesa's software one will do. `SPECIES_bevy.png` in cargo's folder for such files has both pictures side by side.

mod support;

use bevy::{
    animation::{AnimatedBy, AnimationTargetId},
    camera::{
        primitives::Aabb,
        visibility::{DynamicSkinnedMeshBounds, VisibilityClass},
    },
    gltf::{
        GltfExtras, GltfMaterialExtras, GltfMaterialName, GltfMeshExtras, GltfMeshName, GltfSceneExtras, GltfSceneName,
    },
    mesh::skinning::SkinnedMesh,
    prelude::*,
    transform::components::TransformTreeChanged,
    world_serialization::WorldInstanceReady,
};
use bevy_windwood::{
    export::{ExportSettings, ExportedTree, tree_glb},
    prelude::*,
    render::LevelStyle,
    sway::{SwaySettings, WindResponse},
    tree::{TreeModel, textures::species_textures},
    wind::{FieldSettings, WindField},
};
use image::{Rgba, RgbaImage, imageops};
use std::{
    path::Path,
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
    time::Duration,
};
use support::capture;

const SIZE: (u32, u32) = (210, 260);
/// Drawn at this multiple, and scaled down.
const SUPERSAMPLE: u32 = 3;
const SKY: Color = Color::srgb(0.62, 0.72, 0.85);
/// By how much a channel differs from the sky where there is tree, bytes.
const IS_TREE: u8 = 24;
/// The outlines share at least so much of what both cover, and mean colours differ by so many bytes at most. Level 2 of a tree in place of
/// the full one shares less.
const LEAST_OVERLAP: f32 = 0.85;
const MOST_COLOUR: f32 = 16.0;

#[test]
fn a_broadleaf_looks_the_same_in_bevy_s_loader() {
    check("oak");
}

#[test]
fn a_conifer_looks_the_same_in_bevy_s_loader() {
    check("scots_pine");
}

fn check(name: &str) {
    let folder = tempfile::tempdir().unwrap();
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("assets/species/{name}.species.ron"));
    let species = Species::from_ron(&std::fs::read_to_string(path).unwrap()).unwrap();
    let (own, model) = draw_own(&species);
    std::fs::write(folder.path().join("tree.glb"), exported(&species, &model)).unwrap();
    let loaded = draw_loaded(folder.path(), model.height_m());
    let mut sheet = RgbaImage::new(2 * SIZE.0, SIZE.1);
    imageops::replace(&mut sheet, &own, 0, 0);
    imageops::replace(&mut sheet, &loaded, i64::from(SIZE.0), 0);
    capture::save(&sheet, &Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}_bevy.png"))).unwrap();
    let Difference { overlap, colour } = difference(&own, &loaded);
    println!("{name}: outlines share {overlap:.3}, mean colours differ by {colour:.1} of 255");
    assert!(overlap >= LEAST_OVERLAP, "{name}: outlines share {overlap}");
    assert!(colour <= MOST_COLOUR, "{name}: mean colours differ by {colour} of 255");
}

/// How far two pictures are apart.
struct Difference {
    overlap: f32,
    colour: f32,
}

/// The file of a tree, with a skeleton and a loop of its sway. As long as nobody plays that, it stands as it rests.
fn exported(species: &Species, model: &TreeModel) -> Vec<u8> {
    let textures = species_textures(species);
    let age_years = species.age.mature_years;
    let tree = ExportedTree { species, textures: &textures, model, age_years, seed: 0 };
    let field = WindField::synthesise(&FieldSettings { speed: 8.0, ..default() }).unwrap();
    let wind = WindResponse::new(Arc::new(field), &SwaySettings::default());
    let settings = ExportSettings { year: Season::SUMMER.year, ..default() };
    tree_glb(&tree, &settings, Some(&wind)).unwrap()
}

/// The crate's own picture, and the model that it is of.
fn draw_own(species: &Species) -> (RgbaImage, TreeModel) {
    let mut app = support::headless_app(Duration::ZERO, None);
    app.insert_resource(Wind { speed: 0.0, ..default() })
        .insert_resource(LevelOfDetail { style: LevelStyle::Full, ..default() });
    capture::begin(&mut app).unwrap();
    let handle = app.world_mut().resource_mut::<Assets<Species>>().add(species.clone());
    let tree = Tree::new(handle).with_age(species.age.mature_years).with_tint(0.0);
    let tree = app.world_mut().spawn((tree, Transform::default())).id();
    let is_drawn = |world: &mut World| {
        world.get::<Grown>(tree).is_some()
            && world.get::<TreeMeshes>(tree).is_some()
            && world.resource::<ActiveSway>().is_ready()
    };
    assert!(support::update_until(&mut app, is_drawn), "the tree was not drawn in time");
    let world = app.world();
    let grown = world.get::<Grown>(tree).unwrap();
    let model = world.resource::<Assets<TreeModel>>().get(&grown.model).cloned().unwrap();
    (picture(&mut app, model.height_m()), model)
}

/// Bevy's picture of the file `tree.glb` of a folder.
fn draw_loaded(folder: &Path, height_m: f32) -> RgbaImage {
    let mut app = App::new();
    let assets = AssetPlugin { file_path: folder.display().to_string(), ..default() };
    app.add_plugins(capture::headless_engine(None).set(assets));
    register_types_of_scenes(&mut app);
    capture::begin(&mut app).unwrap();
    let is_there = Arc::new(AtomicBool::new(false));
    let told = is_there.clone();
    let scene = app.world().resource::<AssetServer>().load(GltfAssetLabel::Scene(0).from_asset("tree.glb"));
    app.world_mut()
        .spawn(WorldAssetRoot(scene))
        .observe(move |_: On<WorldInstanceReady>| told.store(true, Ordering::Relaxed));
    assert!(support::update_until(&mut app, |_| is_there.load(Ordering::Relaxed)), "the file was not read in time");
    let world = app.world_mut();
    assert!(world.query::<&SkinnedMesh>().iter(world).count() > 0, "its skeleton is not there");
    assert!(world.query::<&AnimationPlayer>().iter(world).count() > 0, "its animation is not there");
    picture(&mut app, height_m)
}

/// Bevy spawns scenes by reflection. Its feature `reflect_auto_register`, with which games register all types, is left out here: it
/// makes every build longer.
fn register_types_of_scenes(app: &mut App) {
    app.register_type::<Name>()
        .register_type::<ChildOf>()
        .register_type::<Children>()
        .register_type::<Transform>()
        .register_type::<GlobalTransform>()
        .register_type::<TransformTreeChanged>()
        .register_type::<Visibility>()
        .register_type::<InheritedVisibility>()
        .register_type::<ViewVisibility>()
        .register_type::<VisibilityClass>()
        .register_type::<Aabb>()
        .register_type::<DynamicSkinnedMeshBounds>()
        .register_type::<Mesh3d>()
        .register_type::<MeshMaterial3d<StandardMaterial>>()
        .register_type::<SkinnedMesh>()
        .register_type::<AnimationPlayer>()
        .register_type::<AnimationTargetId>()
        .register_type::<AnimatedBy>()
        .register_type::<GltfExtras>()
        .register_type::<GltfSceneExtras>()
        .register_type::<GltfSceneName>()
        .register_type::<GltfMeshExtras>()
        .register_type::<GltfMeshName>()
        .register_type::<GltfMaterialExtras>()
        .register_type::<GltfMaterialName>();
}

/// A picture of what stands at the origin, under a sun and an even sky.
fn picture(app: &mut App, height_m: f32) -> RgbaImage {
    let target = capture::target(app, (SUPERSAMPLE * SIZE.0, SUPERSAMPLE * SIZE.1));
    let middle = 0.5 * height_m * Vec3::Y;
    let eye = middle + Vec3::new(0.3, 0.1, 1.0).normalize() * 2.6 * height_m;
    let world = app.world_mut();
    world.insert_resource(ClearColor(SKY));
    world.spawn((
        DirectionalLight { illuminance: 9000.0, shadow_maps_enabled: false, ..default() },
        Transform::from_xyz(0.65, 0.75, 0.55).looking_at(Vec3::ZERO, Vec3::Y),
    ));
    let fov = 0.46;
    world.spawn((
        capture::camera(&target),
        AmbientLight { brightness: 900.0, ..default() },
        Projection::Perspective(PerspectiveProjection { fov, ..default() }),
        Transform::from_translation(eye).looking_at(middle, Vec3::Y),
    ));
    // Pipelines are compiled and textures uploaded before the frame that counts.
    (0..8).for_each(|_| capture::step(app));
    capture::capture(app, &target, SIZE).unwrap()
}

fn difference(own: &RgbaImage, loaded: &RgbaImage) -> Difference {
    let sky = *own.get_pixel(0, 0);
    let is_tree = |pixel: &Rgba<u8>| (0..3).any(|channel| pixel[channel].abs_diff(sky[channel]) > IS_TREE);
    let (mut both, mut any, mut count) = (0, 0, [0_u32; 2]);
    let mut sums = [[0.0_f32; 3]; 2];
    for (a, b) in own.pixels().zip(loaded.pixels()) {
        let is = [is_tree(a), is_tree(b)];
        both += u32::from(is[0] && is[1]);
        any += u32::from(is[0] || is[1]);
        for (which, pixel) in [a, b].into_iter().enumerate().filter(|(which, _)| is[*which]) {
            count[which] += 1;
            (0..3).for_each(|channel| sums[which][channel] += f32::from(pixel[channel]));
        }
    }
    let mean = |which: usize| sums[which].map(|sum| sum / count[which].max(1) as f32);
    let [here, there] = [mean(0), mean(1)];
    let colour = (0..3).map(|channel| (here[channel] - there[channel]).powi(2)).sum::<f32>().sqrt();
    Difference { overlap: both as f32 / any.max(1) as f32, colour }
}
