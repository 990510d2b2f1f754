//! Bevy's own loader against the crate: a tree of the crate is exported, read back and compared, and both are drawn, at rest and in a wind.
//!
//! `cargo run -- FOLDER [SPECIES_FILE]` writes `round_trip.glb` and `round_trip.png` there.

mod headless;

use bevy::{
    asset::UnapprovedPathMode,
    gltf::{Gltf, GltfMesh},
    mesh::{VertexAttributeValues, skinning::SkinnedMesh},
    prelude::*,
};
use bevy_windwood::{
    export::{ExportSettings, ExportedTree, MotionSettings, tree_glb, write_atomically},
    prelude::*,
    sway::{SwaySettings, WindResponse},
    tree::{TreeModel, textures::species_textures},
    wind::{FieldSettings, WindField},
};
use std::{
    error::Error,
    path::{Path, PathBuf},
    sync::Arc,
};

const SIZE: (u32, u32) = (480, 560);
const WIND_M_S: f32 = 14.0;
/// Times in the loop at which both are drawn, s, before the loop's fade begins.
const TIMES_S: [f64; 2] = [2.0, 7.5];

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let folder = std::path::absolute(arguments.next().unwrap_or_else(|| "../../../out".into()))?;
    let default_file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../assets/species/oak.species.ron");
    let file = arguments.next().map_or(default_file, PathBuf::from);
    std::fs::create_dir_all(&folder)?;
    let species = Species { variants: 1, ..Species::from_ron(&std::fs::read_to_string(file)?)? };

    let assets = AssetPlugin { unapproved_path_mode: UnapprovedPathMode::Allow, ..default() };
    let mut app = headless::app(assets);
    app.add_plugins(WindwoodPlugins).insert_resource(Wind { speed: WIND_M_S, seed: 3, ..default() });
    let (tree, model) = grow(&mut app, &species);

    let glb = folder.join("round_trip.glb");
    let motion = MotionSettings { joints: 64, ..default() };
    export(&species, &model, &motion, &glb)?;
    let gltf: Handle<Gltf> = app.world().resource::<AssetServer>().load(glb);
    headless::update_until(&mut app, |world| world.resource::<AssetServer>().is_loaded_with_dependencies(&gltf))?;
    compare_meshes(app.world(), &gltf, &model);
    let read_back = spawn_read_back(&mut app, &gltf)?;

    let mut pictures = Vec::new();
    let camera = headless::spawn_studio(&mut app, SIZE, model.height_m());
    for time_s in TIMES_S {
        *app.world_mut().resource_mut::<WindClock>() = WindClock { time_s, previous_s: time_s };
        seek(app.world_mut(), time_s as f32);
        for (shown, hidden) in [(tree, read_back), (read_back, tree)] {
            app.world_mut().entity_mut(shown).insert(Visibility::Visible);
            app.world_mut().entity_mut(hidden).insert(Visibility::Hidden);
            pictures.push(headless::picture(&mut app, &camera, SIZE)?);
        }
        let difference = headless::difference(&pictures[pictures.len() - 2], &pictures[pictures.len() - 1]);
        println!("at {time_s} s: mean difference of the pictures {difference:.2} of 255");
        compare_joints(app.world_mut(), &model, time_s);
    }
    let path = folder.join("round_trip.png");
    headless::side_by_side(&pictures).save(&path)?;
    println!("{}: the crate's tree and the file, at {TIMES_S:?} s", path.display());
    Ok(())
}

/// The crate's tree, and its model once it is drawn.
fn grow(app: &mut App, species: &Species) -> (Entity, TreeModel) {
    let handle = app.world_mut().resource_mut::<Assets<Species>>().add(species.clone());
    let tree = app
        .world_mut()
        .spawn((
            Tree::new(handle).with_tint(0.0),
            Articulated { deepest_order: 255, leaves: false },
            Transform::default(),
        ))
        .id();
    app.world_mut().resource_mut::<Season>().year = ExportSettings::default().year;
    headless::update_until(app, |world| {
        world.get::<TreeMeshes>(tree).is_some() && world.resource::<ActiveSway>().is_ready()
    })
    .expect("it grows");
    let grown = app.world().get::<Grown>(tree).expect("it has grown").model.clone();
    let model = app.world().resource::<Assets<TreeModel>>().get(&grown).expect("it is there").clone();
    (tree, model)
}

fn export(species: &Species, model: &TreeModel, motion: &MotionSettings, path: &Path) -> Result<(), Box<dyn Error>> {
    let field = WindField::synthesise(&FieldSettings { speed: WIND_M_S, seed: 3, ..default() })?;
    let wind = WindResponse::new(Arc::new(field), &SwaySettings::default());
    let textures = species_textures(species);
    let age_years = species.age.mature_years;
    let tree = ExportedTree { species, textures: &textures, model, age_years, seed: 0 };
    let settings = ExportSettings { motion: *motion, ..default() };
    write_atomically(path, &tree_glb(&tree, &settings, Some(&wind))?)?;
    Ok(())
}

/// Positions and indices of the wood and the leaves, as the loader has them.
fn compare_meshes(world: &World, gltf: &Handle<Gltf>, model: &TreeModel) {
    let gltf = world.resource::<Assets<Gltf>>().get(gltf).expect("it is loaded");
    let mesh = world.resource::<Assets<GltfMesh>>().get(&gltf.meshes[0]).expect("it is loaded");
    let meshes = world.resource::<Assets<Mesh>>();
    let mut equal = Vec::new();
    for primitive in &mesh.primitives {
        let mesh = meshes.get(&primitive.mesh).expect("it is loaded");
        let Some(VertexAttributeValues::Float32x3(positions)) = mesh.attribute(Mesh::ATTRIBUTE_POSITION) else {
            panic!("positions are three floats")
        };
        let indices: Vec<u32> = mesh.indices().expect("it has indices").iter().map(|index| index as u32).collect();
        let corners: Vec<[f32; 3]> = indices.iter().map(|index| positions[*index as usize]).collect();
        equal.push(corners);
    }
    let corners = |positions: &[[f32; 3]], indices: &[u32]| -> Vec<[f32; 3]> {
        indices.iter().map(|index| positions[*index as usize]).collect()
    };
    let own =
        [corners(&model.wood.positions, &model.wood.indices), corners(&model.leaves.positions, &model.leaves.indices)];
    for (name, (read, own)) in ["wood", "leaves"].iter().zip(equal.iter().zip(&own)) {
        assert!(read == own, "the triangles of the {name} differ");
        println!("{name}: {} triangles are equal", own.len() / 3);
    }
}

/// Spawns what was read, and has its animation ready to be set to any time.
fn spawn_read_back(app: &mut App, gltf: &Handle<Gltf>) -> Result<Entity, Box<dyn Error>> {
    let (scene, clip) = {
        let gltf = app.world().resource::<Assets<Gltf>>().get(gltf).expect("it is loaded");
        (gltf.scenes[0].clone(), gltf.animations[0].clone())
    };
    let root = app.world_mut().spawn((WorldAssetRoot(scene), Transform::default(), Visibility::default())).id();
    headless::update_until(app, |world| world.query::<&SkinnedMesh>().iter(world).next().is_some())?;
    let (graph, node) = AnimationGraph::from_clip(clip);
    let graph = app.world_mut().resource_mut::<Assets<AnimationGraph>>().add(graph);
    let world = app.world_mut();
    let player = world.query_filtered::<Entity, With<AnimationPlayer>>().single(world)?;
    world.entity_mut(player).insert(AnimationGraphHandle(graph));
    world.get_mut::<AnimationPlayer>(player).expect("it is there").play(node).pause();
    Ok(root)
}

fn seek(world: &mut World, time_s: f32) {
    for mut player in world.query::<&mut AnimationPlayer>().iter_mut(world) {
        for (_, animation) in player.playing_animations_mut() {
            animation.seek_to(time_s);
        }
    }
}

/// The joints as the loader's animation has moved them against the crate's own beam entities.
fn compare_joints(world: &mut World, model: &TreeModel, time_s: f64) {
    let beams: Vec<(u32, Vec3)> = {
        let mut query = world.query::<(&Beam, &Transform)>();
        query.iter(world).map(|(beam, transform)| (beam.index, transform.translation)).collect()
    };
    let mut query = world.query::<(&Name, &GlobalTransform)>();
    let (mut worst_m, mut count, mut moved_m) = (0.0_f32, 0, 0.0_f32);
    for (name, transform) in query.iter(world) {
        let Some(index) = name.as_str().strip_prefix("beam ").and_then(|index| index.parse::<u32>().ok()) else {
            continue;
        };
        let Some((_, place)) = beams.iter().find(|(beam, _)| *beam == index) else { continue };
        // The entity is on the bowed path, the joint on the chord; at the tip both are one place.
        worst_m = worst_m.max(transform.translation().distance(*place));
        let rest = &model.beams[index as usize];
        moved_m = moved_m.max(place.distance(rest.base + rest.length_m * rest.direction));
        count += 1;
    }
    println!(
        "at {time_s} s: {count} joints, at most {worst_m:.5} m from the crate's; tips have moved up to {moved_m:.2} m"
    );
    assert!(count > 0 && worst_m < 0.005, "joints are not where the beams are");
}
