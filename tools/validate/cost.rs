//! What a frame costs, pass by pass: vertices and fragments shaded, triangles, milliseconds. The counts are the device's own pipeline
//! statistics, which software Vulkan has too.
//!
//! Bevy counts nothing in its shadow passes, but their time.

use crate::{
    grid::{self, Stand},
    memory,
    report::Report,
    support::capture,
};
use bevy::{
    diagnostic::{Diagnostic, DiagnosticsStore},
    mesh::MeshTag,
    prelude::*,
    render::{
        RenderApp,
        diagnostic::RenderDiagnosticsPlugin,
        mesh::{RenderMesh, RenderMeshBufferInfo},
        render_asset::RenderAssets,
    },
    time::TimeUpdateStrategy,
};
use bevy_windwood::{prelude::*, render::TreePart};
use std::{
    collections::BTreeMap,
    path::Path,
    time::{Duration, Instant},
};

const SIZE: (u32, u32) = (960, 540);
/// Frames before those that count: levels and impostors settle, and the recorder fills.
const WARM_UP_FRAMES: u32 = 4;
/// Frames that count.
const FRAMES: u32 = 3;

/// Scenes, and the keys of their numbers: fragments and vertices shaded in all passes that are counted, a frame and one without shadows.
const SCENES: [(&str, Stand, [&str; 4]); 4] = [
    (
        "one oak",
        Stand { trees: 1, species: "oak", age_years: 90.0 },
        ["oak_fragments", "oak_vertices", "oak_frame_ms", "oak_unshadowed_ms"],
    ),
    (
        "one spruce",
        Stand { trees: 1, species: "norway_spruce", age_years: 80.0 },
        ["spruce_fragments", "spruce_vertices", "spruce_frame_ms", "spruce_unshadowed_ms"],
    ),
    (
        "1,000 oaks",
        Stand { trees: 1_000, species: "oak", age_years: 90.0 },
        ["fragments_1k", "vertices_1k", "frame_ms_1k", "unshadowed_ms_1k"],
    ),
    (
        "100,000 oaks",
        Stand { trees: 100_000, species: "oak", age_years: 90.0 },
        ["fragments_100k", "vertices_100k", "frame_ms_100k", "unshadowed_ms_100k"],
    ),
];

/// What the passes of a frame did: by pass and quantity.
type Passes = BTreeMap<(String, String), f64>;

/// Measures scenes of up to that many trees, and writes a picture of each. Trees cast the shadows of their impostors from so many of their
/// heights on, where that is given.
pub fn run(most_trees: u32, shadow_impostors_from_heights: Option<f32>, folder: &Path) -> Report {
    let mut report = Report::default();
    for (name, stand, keys) in SCENES.into_iter().filter(|(_, stand, _)| stand.trees <= most_trees) {
        match measure(
            &stand,
            shadow_impostors_from_heights,
            &folder.join(format!("cost_{}_{}.png", stand.species, stand.trees)),
        ) {
            Ok(cost) => record(&mut report, name, &cost, keys),
            Err(error) => {
                eprintln!("{name}: {error}");
                keys.into_iter().for_each(|key| report.at_most(key, f64::NAN, 0.0, "could not be measured"));
            }
        }
    }
    memory::run(&mut report);
    report
}

struct Cost {
    frame_ms: f64,
    unshadowed_ms: f64,
    passes: Passes,
    levels: Levels,
}

/// Meshes, vertices and triangles of trees that are entities and not hidden, in view or not: by level and part.
type Levels = BTreeMap<(u32, &'static str), [u64; 3]>;

fn levels(app: &mut App) -> Levels {
    let world = app.world_mut();
    let mut drawn = world.query::<(&MeshTag, &TreePart, &Mesh3d, &InheritedVisibility)>();
    let mut meshes: Vec<(u32, TreePart, AssetId<Mesh>)> = Vec::new();
    for (tag, part, mesh, _) in drawn.iter(world).filter(|(.., visibility)| visibility.get()) {
        meshes.push((tag.value >> 16 & 3, *part, mesh.id()));
    }
    let there = app.sub_app(RenderApp).world().resource::<RenderAssets<RenderMesh>>();
    let mut levels = Levels::new();
    for (level, part, mesh) in meshes {
        let Some(mesh) = there.get(mesh) else { continue };
        let triangles = match &mesh.buffer_info {
            RenderMeshBufferInfo::Indexed { count, .. } => count / 3,
            RenderMeshBufferInfo::NonIndexed => mesh.vertex_count / 3,
        };
        let part = if part == TreePart::Wood { "wood" } else { "leaves" };
        let sums = levels.entry((level, part)).or_default();
        let counts = [1, u64::from(mesh.vertex_count), u64::from(triangles)];
        sums.iter_mut().zip(counts).for_each(|(sum, count)| *sum += count);
    }
    levels
}

fn measure(stand: &Stand, shadow_impostors_from_heights: Option<f32>, picture: &Path) -> Result<Cost, String> {
    let mut app = App::new();
    app.add_plugins((capture::headless_engine(None), WindwoodPlugins, RenderDiagnosticsPlugin));
    capture::begin(&mut app)?;
    if let Some(heights) = shadow_impostors_from_heights {
        app.world_mut().resource_mut::<LevelOfDetail>().shadow_impostors_from_heights = heights;
    }
    let camera = if stand.trees == 1 { spawn_tree(&mut app, stand)? } else { grid::spawn_forest(&mut app, stand)? };
    let target = capture::target(&mut app, SIZE);
    app.world_mut().entity_mut(camera).insert(capture::camera(&target));
    app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs_f64(1.0 / 60.0)));
    let frame_ms = frames_ms(&mut app);
    let (passes, levels) = (passes(&mut app), levels(&mut app));
    capture::save(&capture::capture(&mut app, &target, SIZE)?, picture)?;
    let world = app.world_mut();
    world.query::<&mut DirectionalLight>().iter_mut(world).for_each(|mut sun| sun.shadow_maps_enabled = false);
    let unshadowed_ms = frames_ms(&mut app);
    Ok(Cost { frame_ms, unshadowed_ms, passes, levels })
}

/// One tree that fills the picture. Returns a [`Viewpoint`] that becomes the camera.
fn spawn_tree(app: &mut App, stand: &Stand) -> Result<Entity, String> {
    let world = app.world_mut();
    grid::spawn_ground_and_sun(world);
    let species = world.resource::<AssetServer>().load(format!("species/{}.species.ron", stand.species));
    world.spawn((Tree::new(species).with_age(stand.age_years).with_seed(1), Transform::default()));
    let place = Transform::from_xyz(0.0, 5.0, 24.0).looking_at(Vec3::Y * 9.0, Vec3::Y);
    let viewpoint = world.spawn((Viewpoint, place)).id();
    grid::wait_until_drawn(app)?;
    Ok(viewpoint)
}

/// Time of a frame, ms.
fn frames_ms(app: &mut App) -> f64 {
    (0..WARM_UP_FRAMES).for_each(|_| capture::step(app));
    let start = Instant::now();
    (0..FRAMES).for_each(|_| capture::step(app));
    start.elapsed().as_secs_f64() * 1e3 / f64::from(FRAMES)
}

/// The last values of all passes.
fn passes(app: &mut App) -> Passes {
    let store = app.world().resource::<DiagnosticsStore>();
    let of = |diagnostic: &Diagnostic| {
        let path = diagnostic.path().as_str().strip_prefix("render/")?;
        let (pass, quantity) = path.rsplit_once('/')?;
        Some(((pass.to_owned(), quantity.to_owned()), diagnostic.value()?))
    };
    store.iter().filter_map(of).collect()
}

fn record(report: &mut Report, name: &str, cost: &Cost, keys: [&'static str; 4]) {
    let pixels = f64::from(SIZE.0 * SIZE.1);
    println!(
        "  {name}: {:.0} ms, without shadows {:.0} ms, at {}x{}",
        cost.frame_ms, cost.unshadowed_ms, SIZE.0, SIZE.1
    );
    println!(
        "    {:<44} {:>12} {:>12} {:>12} {:>9} {:>9}",
        "pass", "vertices", "triangles", "fragments", "a pixel", "ms"
    );
    let mut names: Vec<&str> = cost.passes.keys().map(|(pass, _)| pass.as_str()).collect();
    names.dedup();
    let value = |pass: &str, quantity: &str| cost.passes.get(&(pass.to_owned(), quantity.to_owned())).copied();
    for pass in &names {
        let show = |quantity: &str| value(pass, quantity).map_or_else(String::new, |value| format!("{value:.0}"));
        let fragments = value(pass, "fragment_shader_invocations");
        let milliseconds = value(pass, "elapsed_gpu").map_or_else(String::new, |value| format!("{value:.1}"));
        println!(
            "    {pass:<44} {:>12} {:>12} {:>12} {:>9} {milliseconds:>9}",
            show("vertex_shader_invocations"),
            show("clipper_primitives_out"),
            show("fragment_shader_invocations"),
            fragments.map_or_else(String::new, |fragments| format!("{:.2}", fragments / pixels)),
        );
    }
    for ((level, part), [meshes, vertices, triangles]) in &cost.levels {
        println!("    level {level}, {part}: {meshes} meshes, {vertices} vertices, {triangles} triangles");
    }
    let sum = |quantity: &str| names.iter().filter_map(|pass| value(pass, quantity)).sum::<f64>();
    report.record(keys[0], sum("fragment_shader_invocations"), "fragments shaded in all passes but shadows");
    report.record(keys[1], sum("vertex_shader_invocations"), "vertices shaded in all passes but shadows");
    report.record(keys[2], cost.frame_ms, "a frame");
    report.record(keys[3], cost.unshadowed_ms, "a frame without shadows");
}
