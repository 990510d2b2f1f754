//! A tree as the crate draws it, and its exported file as Bevy's own glTF loader reads it, side by side, in a calm and under one light.
//!
//! `cargo run --manifest-path tools/export_checks/bevy_loader/Cargo.toml -- OUT_FOLDER [SPECIES...]` writes `SPECIES_bevy.png`, and fails
//! where outlines or colours are farther apart than the limits below.

#[path = "../../../../examples/support/capture.rs"]
#[expect(dead_code, reason = "a part of it is for the examples")]
mod capture;

use bevy::{prelude::*, world_serialization::WorldInstanceReady};
use bevy_windwood::{
    export::{ExportSettings, ExportedTree, tree_glb, write_atomically},
    prelude::*,
    render::LevelStyle,
    sway::{SwaySettings, WindResponse},
    tree::{Grown, TreeModel, textures::species_textures},
    wind::{FieldSettings, WindField},
};
use image::{RgbaImage, imageops};
use std::{
    path::{Path, PathBuf},
    process::ExitCode,
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
    time::{Duration, Instant},
};

const SIZE: (u32, u32) = (420, 520);
/// Drawn at this multiple, and scaled down.
const SUPERSAMPLE: u32 = 2;
const SKY: Color = Color::srgb(0.62, 0.72, 0.85);
/// By how much a channel differs from the sky where there is tree, bytes.
const IS_TREE: u8 = 24;
/// The outlines share at least so much of what both cover, and mean colours differ by so many bytes at most.
const LEAST_OVERLAP: f32 = 0.85;
const MOST_COLOUR: f32 = 16.0;
const TIMEOUT: Duration = Duration::from_secs(120);

fn main() -> ExitCode {
    let mut arguments = std::env::args().skip(1);
    let out = PathBuf::from(arguments.next().unwrap_or_else(|| "out".into()));
    let species: Vec<String> = arguments.collect();
    let species = if species.is_empty() { vec!["oak".into(), "birch".into(), "scots_pine".into()] } else { species };
    let mut has_failed = false;
    for name in species {
        match check(&name, &out) {
            Ok(Difference { overlap, colour }) => {
                let is_alike = overlap >= LEAST_OVERLAP && colour <= MOST_COLOUR;
                has_failed |= !is_alike;
                let verdict = if is_alike { "alike" } else { "NOT ALIKE" };
                println!("{name}: {verdict}; outlines share {overlap:.3}, mean colours differ by {colour:.1} of 255");
            }
            Err(error) => {
                has_failed = true;
                eprintln!("{name}: {error}");
            }
        }
    }
    if has_failed { ExitCode::FAILURE } else { ExitCode::SUCCESS }
}

/// How far two pictures are apart.
struct Difference {
    overlap: f32,
    colour: f32,
}

fn check(name: &str, out: &Path) -> Result<Difference, String> {
    std::fs::create_dir_all(out).map_err(|error| format!("{}: {error}", out.display()))?;
    let out = out.canonicalize().map_err(|error| format!("{}: {error}", out.display()))?;
    let species_path =
        Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../../assets/species/{name}.species.ron"));
    let text =
        std::fs::read_to_string(&species_path).map_err(|error| format!("{}: {error}", species_path.display()))?;
    let species = Species::from_ron(&text).map_err(|error| error.to_string())?;
    let (own, model) = draw_own(&species)?;
    let file = format!("{name}_bevy.glb");
    export(&species, &model, &out.join(&file))?;
    let loaded = draw_loaded(&out, &file, model.height_m())?;
    let mut sheet = RgbaImage::new(2 * SIZE.0, SIZE.1);
    imageops::replace(&mut sheet, &own, 0, 0);
    imageops::replace(&mut sheet, &loaded, i64::from(SIZE.0), 0);
    capture::save(&sheet, &out.join(format!("{name}_bevy.png")))?;
    Ok(difference(&own, &loaded))
}

/// The file of a tree, with a skeleton and a loop of its sway in a calm: it stands as it rests, and all that a moving one has is read.
fn export(species: &Species, model: &TreeModel, path: &Path) -> Result<(), String> {
    let textures = species_textures(species);
    let age_years = species.age.mature_years;
    let tree = ExportedTree { species, textures: &textures, model, age_years, seed: 0 };
    let field = WindField::synthesise(&FieldSettings { speed: 0.0, ..default() }).map_err(|error| error.to_string())?;
    let wind = WindResponse::new(Arc::new(field), &SwaySettings::default());
    let settings = ExportSettings { year: Season::SUMMER.year, ..default() };
    let glb = tree_glb(&tree, &settings, Some(&wind)).map_err(|error| error.to_string())?;
    write_atomically(path, &glb).map_err(|error| error.to_string())
}

/// The crate's own picture, and the model that it is of.
fn draw_own(species: &Species) -> Result<(RgbaImage, TreeModel), String> {
    let mut app = App::new();
    app.add_plugins((capture::headless_engine(None), WindwoodPlugins))
        .insert_resource(Wind { speed: 0.0, ..default() })
        .insert_resource(LevelOfDetail { style: LevelStyle::Full, ..default() });
    capture::begin(&mut app)?;
    let handle = app.world_mut().resource_mut::<Assets<Species>>().add(species.clone());
    let tree = Tree::new(handle).with_age(species.age.mature_years).with_tint(0.0);
    let tree = app.world_mut().spawn((tree, Transform::default())).id();
    let is_drawn = |world: &mut World| {
        world.get::<Grown>(tree).is_some()
            && world.get::<TreeMeshes>(tree).is_some()
            && world.resource::<ActiveSway>().is_ready()
    };
    wait(&mut app, is_drawn)?;
    let world = app.world();
    let grown = world.get::<Grown>(tree).ok_or("the tree has no model")?;
    let model = world.resource::<Assets<TreeModel>>().get(&grown.model).cloned().ok_or("the model is not there")?;
    let picture = picture(&mut app, model.height_m())?;
    Ok((picture, model))
}

/// Bevy's picture of a file.
fn draw_loaded(folder: &Path, file: &str, height_m: f32) -> Result<RgbaImage, String> {
    let mut app = App::new();
    let assets = AssetPlugin { file_path: folder.display().to_string(), ..default() };
    app.add_plugins(capture::headless_engine(None).set(assets));
    capture::begin(&mut app)?;
    let is_there = Arc::new(AtomicBool::new(false));
    let told = is_there.clone();
    let scene = app.world().resource::<AssetServer>().load(GltfAssetLabel::Scene(0).from_asset(file.to_owned()));
    app.world_mut()
        .spawn(WorldAssetRoot(scene))
        .observe(move |_: On<WorldInstanceReady>| told.store(true, Ordering::Relaxed));
    wait(&mut app, |_| is_there.load(Ordering::Relaxed))?;
    let world = app.world_mut();
    let skins = world.query::<&bevy::mesh::skinning::SkinnedMesh>().iter(world).count();
    let players = world.query::<&AnimationPlayer>().iter(world).count();
    println!("{file}: {skins} skinned meshes, {players} animation players");
    if skins == 0 || players == 0 {
        return Err("the skeleton or the animation was not read".into());
    }
    picture(&mut app, height_m)
}

fn wait(app: &mut App, mut is_there: impl FnMut(&mut World) -> bool) -> Result<(), String> {
    let start = Instant::now();
    while start.elapsed() < TIMEOUT {
        app.update();
        if is_there(app.world_mut()) {
            return Ok(());
        }
        std::thread::sleep(Duration::from_millis(2));
    }
    Err("it did not come".into())
}

/// A picture of what stands at the origin, under a sun and an even sky.
fn picture(app: &mut App, height_m: f32) -> Result<RgbaImage, String> {
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
    capture::capture(app, &target, SIZE)
}

fn difference(own: &RgbaImage, loaded: &RgbaImage) -> Difference {
    let sky = *own.get_pixel(0, 0);
    let is_tree = |pixel: &image::Rgba<u8>| (0..3).any(|channel| pixel[channel].abs_diff(sky[channel]) > IS_TREE);
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
