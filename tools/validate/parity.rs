//! Vertices posed on the GPU against the same on the CPU.
//!
//! A whole oak in a storm stands rotated, scaled and far from the origin. The render plugin poses it on the GPU. A compute
//! shader then moves every vertex with the shader module that draws it, and the positions are read back. The CPU poses the
//! same tree with `TreePoser` from the same tables. Then a car runs into the tree and a fan blows on it: what that adds is compared, too,
//! with the pose that an `Articulated` tree has.

use crate::{
    report::Report,
    support::{
        self, ReadBack,
        probe::{self, Bound, ProbeSource},
    },
};
use bevy::{prelude::*, time::TimeUpdateStrategy};
use bevy_windwood::{dynamics::BeamPose, prelude::*, render::SwayBuffers, sway::TreePose, tree::TreeModel};
use std::time::Duration;

/// Place, rotation and scale of the tree: any will do.
const TREE_TRANSFORM: Transform = Transform {
    translation: Vec3::new(413.0, 21.0, -178.0),
    rotation: Quat::from_xyzw(0.0, 0.479_425_55, 0.0, 0.877_582_55),
    scale: Vec3::splat(0.83),
};
const STORM_M_S: f32 = 28.0;
const TIMES_S: [f64; 2] = [61.3, 1000.1];
/// In the open, and in the first rows of a stand.
const CANOPIES: [Canopy; 2] = [
    Canopy { height_m: 0.0, frontal_area_index: 0.0, exposure: [1.0; 8] },
    Canopy { height_m: 14.0, frontal_area_index: 0.8, exposure: [0.4, 0.1, 0.9, 0.0, 0.2, 0.5, 1.0, 0.3] },
];

const CARRY_SHADER: &str = "
import bevy_windwood::render::shaders::{beam::carry, frame::Frame, instances::{BeamPose, BeamRow, TreeRow}};
@group(0) @binding(0) var<storage, read> points: array<vec4<f32>>;
@group(0) @binding(1) var<storage, read_write> carried: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read> poses: array<BeamPose>;
@group(0) @binding(3) var<storage, read> beams: array<BeamRow>;
@group(0) @binding(4) var<storage, read> trees: array<TreeRow>;
@group(0) @binding(5) var<storage, read> frame: Frame;
// A vertex is two rows of `points`: place at rest and beam; place on the beam.
@compute @workgroup_size(64)
fn carry_points(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&carried) {
        return;
    }
    let point = points[2u * id.x];
    let beam = u32(point.w + 0.5);
    let pose = poses[frame.poses_now + trees[0].first_pose + beam];
    let motion = carry(beams[trees[0].first_beam + beam], pose, points[2u * id.x + 1u].x, point.xyz);
    carried[id.x] = vec4(motion.position, 1.0);
}
";

/// Poses a tree on both and compares every vertex.
pub fn run() -> Report {
    let mut report = Report::default();
    match worst_differences() {
        Ok(Differences { worst, largest, touched, largest_touch }) => {
            report.at_most("cpu_gpu_worst", worst, 1e-3, "largest distance between the two, in tree heights");
            report.record("largest_deflection", largest, "largest way that the storm moves a vertex, in tree heights");
            report.at_most(
                "cpu_gpu_touched_worst",
                touched,
                1e-3,
                "the same of a tree that was struck and is blown at",
            );
            report.at_least(
                "largest_touch",
                largest_touch,
                0.02,
                "largest way by which that moves a vertex, in tree heights",
            );
        }
        Err(error) => {
            eprintln!("parity: {error}");
            report.at_most("cpu_gpu_worst", f64::NAN, 1e-3, "could not be measured");
        }
    }
    report
}

/// In tree heights.
struct Differences {
    worst: f64,
    largest: f64,
    touched: f64,
    largest_touch: f64,
}

fn worst_differences() -> Result<Differences, String> {
    let mut app = headless_app();
    let tree = app.world().resource::<AssetServer>().load("species/oak.species.ron");
    let tree = app.world_mut().spawn((Tree::new(tree).with_seed(1), TREE_TRANSFORM)).id();
    let ready =
        |world: &mut World| world.resource::<ActiveSway>().is_ready() && world.get::<TreeMeshes>(tree).is_some();
    if !support::update_until(&mut app, ready) {
        return Err("the tree did not get ready".into());
    }
    let model = app.world().get::<Grown>(tree).map(|grown| grown.model.clone()).ok_or("the tree has no model")?;
    let model = app.world().resource::<Assets<TreeModel>>().get(&model).cloned().ok_or("the model is gone")?;
    let vertices = bound_points(&model);
    let read = install_probe(&mut app, &vertices);

    let (mut worst, mut largest) = (0.0_f64, 0.0_f64);
    for (canopy, time_s) in CANOPIES.iter().flat_map(|canopy| TIMES_S.map(|time_s| (canopy, time_s))) {
        app.world_mut().entity_mut(tree).insert(InCanopy(*canopy));
        *app.world_mut().resource_mut::<WindClock>() = WindClock { time_s, previous_s: time_s };
        let posed = support::cpu_poses(app.world().resource::<ActiveSway>(), &model, &TREE_TRANSFORM, canopy, time_s);
        let carried = read_back(&mut app, &read, vertices.len())?;
        for (vertex, there) in vertices.iter().zip(carried) {
            let (here, _) = posed[vertex.beam].carry(&model.beams[vertex.beam], vertex.s, vertex.at);
            worst = worst.max(f64::from(here.distance(there)));
            largest = largest.max(f64::from(here.distance(vertex.at)));
        }
    }
    let height_m = f64::from(model.height_m());
    let (touched, largest_touch) = compare_touched(&mut app, tree, (&model, &vertices), &read)?;
    Ok(Differences {
        worst: worst / height_m,
        largest: largest / height_m,
        touched: touched / height_m,
        largest_touch: largest_touch / height_m,
    })
}

/// The largest distance between GPU and CPU, and by how much the tree is moved out of where the wind alone has it, m.
fn compare_touched(
    app: &mut App,
    tree: Entity,
    (model, vertices): (&TreeModel, &[BoundPoint]),
    read: &ReadBack,
) -> Result<(f64, f64), String> {
    let at = TREE_TRANSFORM.translation;
    let world = app.world_mut();
    world.entity_mut(tree).insert(Articulated { deepest_order: 0, leaves: false });
    let fan = SourceKind::Cone { speed_m_s: 40.0, nozzle_radius_m: 2.0, half_angle_deg: 12.0 };
    let behind = Transform::from_translation(at + Vec3::new(9.0, 6.0, 9.0)).looking_at(at + Vec3::Y * 6.0, Vec3::Y);
    world.spawn((WindSource::new(fan), behind));
    world.write_message(TreeImpulse { tree, place: at + Vec3::Y * 3.0, impulse_n_s: Vec3::new(2e4, 0.0, 0.0) });
    app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_millis(50)));
    for _ in 0..12 {
        support::render_frame(app)?;
    }
    // What a frame has moved is kept while the clock stands.
    app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::ZERO));
    let carried = read_back(app, read, vertices.len())?;
    let posed = app.world().get::<TreePose>(tree).ok_or("the tree is not posed on the CPU")?.beams().to_vec();
    let time_s = app.world().resource::<WindClock>().time_s;
    let canopy = &CANOPIES[CANOPIES.len() - 1];
    let alone = support::cpu_poses(app.world().resource::<ActiveSway>(), model, &TREE_TRANSFORM, canopy, time_s);
    let (mut worst, mut largest) = (0.0_f64, 0.0_f64);
    for (vertex, there) in vertices.iter().zip(carried) {
        let place = |poses: &[BeamPose]| poses[vertex.beam].carry(&model.beams[vertex.beam], vertex.s, vertex.at).0;
        worst = worst.max(f64::from(place(&posed).distance(there)));
        largest = largest.max(f64::from(place(&alone).distance(there)));
    }
    Ok((worst, largest))
}

fn headless_app() -> App {
    let mut app = support::headless_app(Duration::ZERO, None);
    app.insert_resource(Wind { speed: STORM_M_S, seed: 3, ..default() }).add_plugins(probe::plugin);
    app.finish();
    app.cleanup();
    app
}

/// A vertex at rest and its beam.
struct BoundPoint {
    at: Vec3,
    beam: usize,
    s: f32,
}

/// All vertices of the wood, and the anchors of the leaves.
fn bound_points(model: &TreeModel) -> Vec<BoundPoint> {
    let point = |at: Vec3, sway: &[f32; 4]| BoundPoint { at, beam: sway[0] as usize, s: sway[1] };
    let wood = model.wood.positions.iter().zip(&model.wood.sway).map(|(at, sway)| point(Vec3::from_array(*at), sway));
    let leaves = model.leaves.anchor.iter().zip(&model.leaves.sway);
    wood.chain(leaves.map(|(at, sway)| point(Vec3::from_slice(at), sway))).collect()
}

fn install_probe(app: &mut App, vertices: &[BoundPoint]) -> ReadBack {
    let rows = vertices.iter().flat_map(|v| [v.at.extend(v.beam as f32), Vec4::new(v.s, 0.0, 0.0, 0.0)]).collect();
    let world = app.world_mut();
    let SwayBuffers { poses, beams, trees, frame, .. } = world.resource::<SwayBuffers>().clone();
    let tables = (2..).zip([poses, beams, trees, frame].map(Bound::Table));
    let shader = ProbeSource { entry_point: "carry_points", wesl: CARRY_SHADER };
    probe::install(world, shader, rows, [vertices.len(), 1], tables)
}

/// Renders frames until what is read back is surely of the current time.
fn read_back(app: &mut App, read: &ReadBack, count: usize) -> Result<Vec<Vec3>, String> {
    const SETTLE_FRAMES: usize = 6;
    for _ in 0..SETTLE_FRAMES {
        support::render_frame(app)?;
    }
    let rows = probe::rows(read).ok_or("nothing was read back")?;
    if rows.len() == count && rows.iter().all(|row| row.w == 1.0) {
        Ok(rows.into_iter().map(Vec4::truncate).collect())
    } else {
        Err("the GPU did not write every vertex".into())
    }
}
