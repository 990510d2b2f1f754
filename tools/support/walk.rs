//! The walk of figure 9 of Setas et al.: flat ground, some number of trees, a random path through them, and two techniques
//! that can be switched on and off.

// Each program that includes this file uses a part of it.
#![allow(dead_code)]

use crate::support::capture;
use bevy::{camera::visibility::NoFrustumCulling, light::ShadowFilteringMethod, prelude::*};
use bevy_windwood::{
    forest::ForestCulling,
    prelude::*,
    scatter::{
        ForestPlan,
        plan::{Area, Shape, Stock},
    },
};
use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};
use std::time::Duration;

/// Ground per tree, as in a grid of 8 m, m^2.
const AREA_PER_TREE_M2: f32 = 64.0;
/// Side of a cell, m.
const CELL_M: f32 = 32.0;
/// With levels, trees are entities as far as this, m.
const TREES_TO_M: f32 = 120.0;
/// Time from one turn of the path to the next, s.
const LEG_S: f32 = 20.0;
/// Height of the camera, m.
const EYE_HEIGHT_M: f32 = 4.0;
/// Duration of the paper's walk, s.
pub const PATH_S: f32 = 180.0;

/// The techniques that are switched on.
#[derive(Resource, Clone, Copy, Debug, PartialEq, Eq)]
pub struct Technique {
    /// Draws only the cells of the voxel grid that are in view.
    pub voxels: bool,
    /// Draws trees at levels of detail.
    pub levels: bool,
    /// What the levels are.
    pub style: LevelStyle,
}

/// Side of the square that the trees stand in, m.
pub fn side_m(trees: u32) -> f32 {
    (trees as f32 * AREA_PER_TREE_M2).sqrt()
}

/// Spawns ground, forest and light. The technique is a resource and may change at any time.
pub fn build(app: &mut App, trees: u32, technique: Technique) {
    let half_m = 0.5 * side_m(trees);
    let stock =
        |species: &str, age_years| Stock { species: species.into(), age_years, age_spread_years: 10.0, ..default() };
    let area = Area {
        shape: Shape::Rectangle { min_m: [-half_m; 2], max_m: [half_m; 2] },
        density_per_ha: 1e4 / AREA_PER_TREE_M2,
        stock: vec![stock("fir", 80.0), stock("oak", 100.0)],
        ..default()
    };
    let plan = ForestPlan { seed: 9, cell_m: CELL_M, areas: vec![area], ..default() };
    let world = app.world_mut();
    let plan = world.resource_mut::<Assets<ForestPlan>>().add(plan);
    world.spawn((Forest::new(plan), settings(trees, technique)));
    let ground = world.resource_mut::<Assets<Mesh>>().add(Plane3d::default().mesh().size(4000.0, 4000.0));
    let green = StandardMaterial { base_color: Color::srgb(0.36, 0.42, 0.2), perceptual_roughness: 1.0, ..default() };
    let green = world.resource_mut::<Assets<StandardMaterial>>().add(green);
    world.spawn((Ground, Mesh3d(ground), MeshMaterial3d(green)));
    world.spawn((
        DirectionalLight { illuminance: 12_000.0, ..default() },
        Transform::default().looking_to(Vec3::new(-0.5, -0.7, -0.3), Vec3::Y),
    ));
    world.insert_resource(GlobalAmbientLight { brightness: 500.0, ..default() });
    world.insert_resource(ClearColor(Color::srgb(0.62, 0.75, 0.9)));
    world.insert_resource(TreeCount(trees));
    world.insert_resource(technique);
    // The sun is the only light, and software Vulkan is slower if the shader asks for others.
    world.insert_resource(TreeLighting::SunOnly);
    app.add_systems(Update, apply_technique).add_systems(PostUpdate, switch_mesh_culling);
}

#[derive(Component)]
struct Ground;

#[derive(Resource)]
struct TreeCount(u32);

impl Technique {
    fn has_impostors(self) -> bool {
        self.levels && self.style == LevelStyle::Thinned
    }
}

fn settings(trees: u32, technique: Technique) -> ForestSettings {
    let all_m = 1.5 * side_m(trees);
    let (trees_to_m, far_to_m) =
        if technique.has_impostors() { (TREES_TO_M, all_m.max(2.0 * TREES_TO_M)) } else { (all_m, 0.0) };
    ForestSettings { trees_to_m, far_to_m, cells_at_once: 64, trees_per_frame: 100_000, ..default() }
}

fn apply_technique(
    technique: Res<Technique>,
    trees: Res<TreeCount>,
    mut detail: ResMut<LevelOfDetail>,
    mut culling: ResMut<ForestCulling>,
    mut forests: Query<&mut ForestSettings>,
) {
    if !technique.is_changed() {
        return;
    }
    detail.style = if technique.levels { technique.style } else { LevelStyle::Full };
    detail.changes_per_frame = 1_000_000;
    // Pictures of the path may lie seconds apart: what one shows must not stay visible for the next.
    *culling = ForestCulling { enabled: technique.voxels, around_m: 0.0, lingering_frames: 0, ..default() };
    for mut forest in &mut forests {
        forest.set_if_neq(settings(trees.0, *technique));
    }
}

/// Switches off Bevy's own culling of meshes unless both techniques are on. The paper had none, and its techniques are
/// measured alone.
fn switch_mesh_culling(
    mut commands: Commands,
    technique: Res<Technique>,
    culled: Query<Entity, (With<Mesh3d>, Without<NoFrustumCulling>, Without<Ground>)>,
    unculled: Query<Entity, (With<Mesh3d>, With<NoFrustumCulling>)>,
) {
    if technique.voxels && technique.levels {
        unculled.iter().for_each(|mesh| {
            commands.entity(mesh).remove::<NoFrustumCulling>();
        });
    } else {
        culled.iter().for_each(|mesh| {
            commands.entity(mesh).insert(NoFrustumCulling);
        });
    }
}

/// The camera, which renders to a target or to the window.
pub fn camera(target: Option<&Handle<Image>>) -> impl Bundle + use<> {
    let lens = Projection::Perspective(PerspectiveProjection { far: 4000.0, ..default() });
    let target = target.map_or_else(bevy::camera::RenderTarget::default, |image| {
        bevy::camera::RenderTarget::Image(image.clone().into())
    });
    // No depth prepass: on software Vulkan the vertices of trees cost more than their pixels.
    (Camera3d::default(), Msaa::Off, ShadowFilteringMethod::Hardware2x2, target, lens)
}

/// Place and direction of the camera at a time, s.
pub fn place(trees: u32, time_s: f32) -> Transform {
    let at = |time_s: f32| {
        let leg = (time_s / LEG_S).floor();
        let turn = |number: f32| {
            let mut random = Xoshiro256PlusPlus::seed_from_u64(number.max(-1.0) as i64 as u64);
            let reach_m = 0.42 * side_m(trees);
            Vec2::new(random.random_range(-reach_m..reach_m), random.random_range(-reach_m..reach_m))
        };
        let points = [-1.0, 0.0, 1.0, 2.0].map(|step| turn(leg + step));
        catmull_rom(points, time_s / LEG_S - leg)
    };
    let (here, next) = (at(time_s), at(time_s + 0.5));
    let ahead = (next - here).normalize_or(Vec2::Y);
    let eye = Vec3::new(here.x, EYE_HEIGHT_M, here.y);
    Transform::from_translation(eye).looking_to(Vec3::new(ahead.x, 0.05, ahead.y), Vec3::Y)
}

/// The curve from the second to the third of four points.
fn catmull_rom([a, b, c, d]: [Vec2; 4], t: f32) -> Vec2 {
    0.5 * (2.0 * b + (c - a) * t + (2.0 * a - 5.0 * b + 4.0 * c - d) * t * t + (3.0 * (b - c) + d - a) * t * t * t)
}

/// Whether everything that is wanted from the place of the camera is drawn.
pub fn is_ready(world: &mut World) -> bool {
    world.resource::<ActiveSway>().is_ready() && capture::forests_are_drawn(world)
}

/// Updates until everything that is wanted from the place of the camera is drawn.
///
/// # Errors
/// If it is not after `updates`.
pub fn settle(app: &mut App, updates: usize) -> Result<(), String> {
    for update in 0..updates {
        app.update();
        if update > 1 && is_ready(app.world_mut()) {
            return Ok(());
        }
        std::thread::sleep(Duration::from_millis(2));
    }
    Err("the forest did not get ready; see the warnings above".into())
}

/// An app without a window, its camera and the target, ready for the walk: everything near the first place is drawn. While it
/// is waited for, a [`Viewpoint`] stands in for the camera, so that nothing is rendered.
///
/// # Errors
/// Where there is no graphics device, or the forest does not get ready.
pub fn headless(trees: u32, technique: Technique, size: (u32, u32)) -> Result<(App, Entity, Handle<Image>), String> {
    let mut app = App::new();
    app.add_plugins((capture::headless_engine(None), WindwoodPlugins));
    build(&mut app, trees, technique);
    capture::begin(&mut app)?;
    let start = place(trees, 0.0);
    let viewpoint = app.world_mut().spawn((Viewpoint, start)).id();
    settle(&mut app, 20_000)?;
    app.world_mut().despawn(viewpoint);
    let target = capture::target(&mut app, size);
    let camera = app.world_mut().spawn((camera(Some(&target)), start)).id();
    (0..4).for_each(|_| capture::step(&mut app));
    Ok((app, camera, target))
}
