//! The same seed gives the same forest, skeletons and poses: in one thread and in many, and as it was when these numbers were noted.
//!
//! - What stands where (stems of a plan) is made of arithmetic that IEEE 754 fixes, and of functions of the crate `libm`, which are made
//!   of such: its bits are the same on every machine. (A normal variate beyond 3.65 deviations, one in 4000, takes the platform's `ln`.)
//! - Skeletons and poses also use the platform's `sin`, `cos`, `exp` and `ln`, as Bevy's mathematics does, and the wind Fourier transforms
//!   that use what the processor has. Between platforms, and between processors with FMA and without, these differ in the last digits, and
//!   so do they: their bits are pinned for Linux on x86-64 with FMA, where this was noted.

use bevy::{
    app::TaskPoolOptions, app::TaskPoolPlugin, ecs::system::RunSystemOnce, prelude::*, time::TimeUpdateStrategy,
};
use bevy_windwood::{
    LevelGround,
    forest::{ForestCells, StemId},
    prelude::*,
    scatter::{
        ForestPlan, Planter,
        plan::{Area, Shape, Stock},
    },
    sway::TreePose,
    tree::individual::grow,
};
use std::{fs, path::Path, process::Command, time::Duration};

/// FNV-1a, 64 bits (Fowler, Noll & Vo 1991).
#[derive(Clone, Copy)]
struct Hash(u64);

impl Hash {
    fn new() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }

    fn bits(&mut self, word: u32) {
        for byte in word.to_le_bytes() {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }

    fn number(&mut self, value: f32) {
        // Zero has one sign here.
        self.bits((value + 0.0).to_bits());
    }

    fn place(&mut self, place: Vec3) {
        place.to_array().into_iter().for_each(|value| self.number(value));
    }
}

fn asset(path: &str) -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("assets").join(path)).expect("a file of the assets")
}

fn stems_of_the_mixed_forest() -> (usize, u64) {
    let plan = ForestPlan::from_ron(&asset("forests/mixed.forest.ron")).expect("a valid plan");
    let planter = Planter::new(&plan).expect("a valid plan");
    let (mut hash, mut count, mut plants) = (Hash::new(), 0, Vec::new());
    let [first, last] = planter.cells().expect("something grows");
    for (z, x) in (first.y..=last.y).flat_map(|z| (first.x..=last.x).map(move |x| (z, x))) {
        planter.plant(IVec2::new(x, z), &LevelGround(0.0), &mut plants);
        for plant in &plants {
            count += 1;
            hash.place(plant.position);
            [plant.turn_rad, plant.plan_size, plant.vigour, plant.age_years, plant.season_days, plant.tint]
                .into_iter()
                .for_each(|value| hash.number(value));
            hash.bits(u32::from(plant.species));
            hash.bits(plant.seed);
        }
    }
    (count, hash.0)
}

#[test]
fn the_plan_of_the_mixed_forest_has_the_stems_that_it_always_had() {
    let (count, hash) = stems_of_the_mixed_forest();
    println!("{count} stems, {hash:#018x}");
    assert_eq!((count, hash), STEMS);
}

fn skeleton(name: &str) -> (usize, u64) {
    let species = Species::from_ron(&asset(&format!("species/{name}.species.ron"))).expect("a valid species");
    let skeleton = grow(&species, species.age.mature_years, 42);
    let mut hash = Hash::new();
    for beam in &skeleton.beams {
        hash.bits(beam.parent.map_or(u32::MAX, |parent| parent));
        [beam.base, beam.direction, beam.bow].into_iter().for_each(|place| hash.place(place));
        [beam.length_m, beam.base_radius_m, beam.tip_radius_m].into_iter().for_each(|value| hash.number(value));
    }
    for cluster in &skeleton.clusters {
        hash.bits(cluster.beam);
        [cluster.anchor, cluster.axis].into_iter().for_each(|place| hash.place(place));
        hash.number(cluster.size_m);
    }
    (skeleton.beams.len() + skeleton.clusters.len(), hash.0)
}

/// Whether this machine is of the kind on which bits were noted.
fn is_pinned() -> bool {
    #[cfg(all(target_os = "linux", target_arch = "x86_64"))]
    return std::arch::is_x86_feature_detected!("fma") && std::arch::is_x86_feature_detected!("avx2");
    #[cfg(not(all(target_os = "linux", target_arch = "x86_64")))]
    return false;
}

/// One species of each growth model.
#[test]
fn skeletons_of_every_growth_model_are_what_they_always_were() {
    let found = SKELETONS.map(|(name, ..)| (name, skeleton(name)));
    found.iter().for_each(|(name, (parts, hash))| println!("(\"{name}\", {parts}, {hash:#018x}),"));
    assert_eq!(found.map(|(name, (parts, _))| (name, parts)), SKELETONS.map(|(name, parts, _)| (name, parts)));
    if is_pinned() {
        assert_eq!(found.map(|(name, (parts, hash))| (name, parts, hash)), SKELETONS);
    }
}

/// A forest in the wind about a viewer, with so many threads in each of Bevy's pools: its trees, and the poses of the nearest.
fn forest_in_the_wind(threads: usize) -> (usize, u64) {
    let mut app = App::new();
    let pools = TaskPoolPlugin { task_pool_options: TaskPoolOptions::with_num_threads(threads) };
    app.add_plugins((
        MinimalPlugins.set(pools),
        TransformPlugin,
        AssetPlugin { file_path: format!("{}/assets", env!("CARGO_MANIFEST_DIR")), ..default() },
        WindwoodMinimalPlugins,
    ));
    app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::ZERO));
    app.finish();
    app.cleanup();
    let stock = |species: &str| Stock { species: species.into(), age_years: 12.0, age_spread_years: 3.0, ..default() };
    let area = Area {
        shape: Shape::Rectangle { min_m: [-60.0; 2], max_m: [60.0; 2] },
        density_per_ha: 90.0,
        stock: vec![stock("birch"), stock("fir")],
        ..default()
    };
    let plan = ForestPlan { seed: 3, cell_m: 32.0, areas: vec![area], ..default() };
    let plan = app.world_mut().resource_mut::<Assets<ForestPlan>>().add(plan);
    let settings = ForestSettings { trees_to_m: 50.0, articulated_to_m: 200.0, ..default() };
    app.world_mut().spawn((Forest::new(plan), settings));
    app.world_mut().spawn((Viewpoint, Transform::from_xyz(3.0, 2.0, -5.0)));
    let is_ready = |world: &mut World| {
        let complete = world.query::<&ForestCells>().iter(world).all(ForestCells::is_complete);
        let trees = world.query_filtered::<(), With<Tree>>().iter(world).count();
        let posed = world.query::<(&TreePose, &InCanopy)>().iter(world).count();
        complete && trees > 20 && posed == trees && world.resource::<ActiveSway>().is_settled()
    };
    let ready = (0..60_000).any(|_| {
        app.update();
        std::thread::sleep(Duration::from_millis(1));
        is_ready(app.world_mut())
    });
    assert!(ready, "the forest did not come about");
    // The canopies may still change while stands are worked out.
    (0..200).for_each(|_| app.update());
    app.world_mut().resource_mut::<WindClock>().time_s = 12_345.678;
    app.update();
    app.world_mut().run_system_once(hash_of_trees).expect("a system that runs")
}

fn hash_of_trees(trees: Query<(&StemId, &Transform, &InCanopy, &TreePose)>) -> (usize, u64) {
    let mut trees: Vec<_> = trees.iter().collect();
    trees.sort_by_key(|(id, ..)| **id);
    let mut hash = Hash::new();
    for (_, at, InCanopy(canopy), pose) in &trees {
        hash.place(at.translation);
        hash.number(at.scale.x);
        canopy.exposure.into_iter().for_each(|exposure| hash.number(exposure));
        for beam in pose.beams() {
            hash.place(beam.tip_angle.into());
            hash.place(beam.translation.into());
        }
    }
    (trees.len(), hash.0)
}

const THREADS: &str = "WINDWOOD_TEST_THREADS";

/// Run by the test below, in a process of its own: Bevy's pools belong to a process.
#[test]
fn poses_by_so_many_threads() {
    let Some(threads) = std::env::var(THREADS).ok().and_then(|threads| threads.parse().ok()) else { return };
    let (trees, hash) = forest_in_the_wind(threads);
    println!("POSES {trees} {hash:#018x}");
}

#[test]
fn forest_and_poses_are_the_same_in_one_thread_and_in_many() {
    let run = |threads: &str| {
        let own = std::env::current_exe().expect("this test's program");
        let arguments = ["--exact", "poses_by_so_many_threads", "--nocapture"];
        let output = Command::new(own).args(arguments).env(THREADS, threads).output().expect("it runs");
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        let found = text.lines().find_map(|line| Some(line.split_once("POSES ")?.1.to_string()));
        found.unwrap_or_else(|| panic!("no poses: {text}{}", String::from_utf8_lossy(&output.stderr)))
    };
    let (one, many) = (run("1"), run("8"));
    println!("{one}");
    assert_eq!(one, many);
    if is_pinned() {
        assert_eq!(one, POSES);
    }
}

/// Number, and hash of their bits.
const STEMS: (usize, u64) = (8367, 0x7109_6107_0fb3_3bd9);
/// Species, number of beams and clusters, and hash of their bits.
const SKELETONS: [(&str, usize, u64); 6] = [
    ("oak", 4479, 0x8117_0874_91b2_716d),
    ("zaharia_oak", 1961, 0xed93_bd43_4bee_517a),
    ("zaharia_fir", 2445, 0x66a1_9a1c_55b2_e773),
    ("aono_kunii", 2287, 0x0e5f_0208_e134_ac32),
    ("impression_summer", 3055, 0x92cf_5e7c_374e_4dcd),
    ("billows", 58, 0xfbd7_6704_4853_3220),
];
/// Number of trees, and hash of their places and poses.
const POSES: &str = "122 0xe8890389ee2975ad";
