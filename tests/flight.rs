//! Long flights through a forest, jumps of the camera, and frustum culling of cells; without rendering.

use bevy::{
    camera::CameraPlugin,
    light::{CascadeShadowConfig, CascadeShadowConfigBuilder},
    mesh::MeshPlugin,
    prelude::*,
};
use bevy_windwood::{
    forest::{ForestCell, ForestCells, ForestCulling, ForestRenderPlugin},
    prelude::*,
    scatter::{
        ForestPlan,
        plan::{Area, Shape, Stock},
    },
    tree::TreeModel,
};
use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};
use std::{
    collections::{BTreeMap, BTreeSet},
    time::Duration,
};

const CELL_M: f32 = 32.0;
const TREES_PER_FRAME: u32 = 50;
/// Frames after which every cell that is out of view is hidden.
const FRAMES_TO_HIDE: usize = 70;
const SHADOWS_TO_M: f32 = 150.0;

/// A large forest on level ground, and a camera over its middle.
fn forest_app(trees_to_m: f32, far_to_m: f32) -> (App, Entity) {
    let mut app = App::new();
    app.add_plugins((MinimalPlugins, TransformPlugin, AssetPlugin::default(), MeshPlugin, CameraPlugin));
    app.add_plugins((WindwoodMinimalPlugins, ForestRenderPlugin));
    app.finish();
    app.cleanup();
    let stock = |species: &str| Stock { species: species.into(), age_spread_years: 2.0, ..default() };
    let area = Area {
        shape: Shape::Rectangle { min_m: [-4000.0; 2], max_m: [4000.0; 2] },
        density_per_ha: 100.0,
        stock: vec![stock("fir"), stock("oak")],
        ..default()
    };
    let plan = ForestPlan { cell_m: CELL_M, areas: vec![area], ..default() };
    let plan = app.world_mut().resource_mut::<Assets<ForestPlan>>().add(plan);
    let settings = ForestSettings { trees_to_m, far_to_m, trees_per_frame: TREES_PER_FRAME, ..default() };
    app.world_mut().spawn((Forest::new(plan), settings));
    let camera = app.world_mut().spawn((Camera3d::default(), Transform::from_xyz(0.0, 10.0, 0.0))).id();
    wait_for_trees(&mut app);
    (app, camera)
}

fn move_to(app: &mut App, camera: Entity, at: Transform) {
    *app.world_mut().get_mut::<Transform>(camera).unwrap() = at;
}

/// A frame with time for background tasks.
fn frame(app: &mut App) {
    app.update();
    std::thread::sleep(Duration::from_millis(1));
}

fn wait_for_trees(app: &mut App) {
    (0..3).for_each(|_| frame(app));
    for _ in 0..20_000 {
        frame(app);
        let world = app.world_mut();
        let complete = world.query::<&ForestCells>().iter(world).all(ForestCells::is_complete);
        let without_model = world.query_filtered::<(), (With<Tree>, Without<Grown>)>().iter(world).count();
        if complete && without_model == 0 && world.query::<&Tree>().iter(world).next().is_some() {
            return;
        }
    }
    panic!("the forest was not complete in time");
}

/// Numbers of entities, of bytes in the cell store, and of assets.
fn memory(app: &mut App) -> [usize; 5] {
    let world = app.world_mut();
    let entities = world.query::<Entity>().iter(world).count();
    let bytes = world.query::<&ForestCells>().iter(world).map(|forest| forest.store().bytes()).sum();
    let models = world.resource::<Assets<TreeModel>>().len();
    let [species, plans] = [world.resource::<Assets<Species>>().len(), world.resource::<Assets<ForestPlan>>().len()];
    [entities, bytes, models, species, plans]
}

fn greatest(one: [usize; 5], other: [usize; 5]) -> [usize; 5] {
    std::array::from_fn(|number| one[number].max(other[number]))
}

#[test]
fn memory_stays_flat_in_ten_minutes_of_flight() {
    let (mut app, camera) = forest_app(100.0, 300.0);
    let mut random = Xoshiro256PlusPlus::seed_from_u64(10);
    let mut at = Transform::from_xyz(0.0, 10.0, 0.0);
    // 20 m/s at eight frames per second, and a jump every minute.
    let frames_per_minute = 480;
    let mut minute = |app: &mut App| {
        let [x, z] = [0; 2].map(|_| random.random_range(-2500.0..2500.0));
        at.translation = Vec3::new(x, 10.0, z);
        let mut most = [0; 5];
        for _ in 0..frames_per_minute {
            at.rotate_y(random.random_range(-0.1..0.1));
            at.translation += at.forward() * 2.5;
            move_to(app, camera, at);
            frame(app);
            most = greatest(most, memory(app));
        }
        most
    };
    let mut half = || (0..5).map(|_| minute(&mut app)).fold([0; 5], greatest);
    let (first, second) = (half(), half());
    println!("the most of entities, bytes, models, species, plans: {first:?}, then {second:?}");
    assert!(first[0] > 500 && first[1] > 10_000 && first[2] > 1, "{first:?}");
    for (first, second) in first.into_iter().zip(second) {
        assert!(second as f64 <= 1.1 * first as f64, "{second} after {first}");
    }
}

#[test]
fn jump_of_three_kilometres_keeps_the_budgets_per_frame() {
    let (mut app, camera) = forest_app(150.0, 150.0);
    let of = |app: &mut App| {
        let world = app.world_mut();
        let cells: BTreeSet<Entity> = world.query_filtered::<Entity, With<ForestCell>>().iter(world).collect();
        let trees: BTreeSet<Entity> = world.query_filtered::<Entity, With<Tree>>().iter(world).collect();
        (cells, trees)
    };
    let first = of(&mut app);
    let mut before = first.clone();
    move_to(&mut app, camera, Transform::from_xyz(3000.0, 10.0, 0.0));
    let (mut most_despawned, mut most_spawned) = (0, 0);
    for _ in 0..600 {
        frame(&mut app);
        let now = of(&mut app);
        most_despawned = most_despawned.max(before.0.difference(&now.0).count());
        most_spawned = most_spawned.max(now.1.difference(&before.1).count());
        before = now;
    }
    wait_for_trees(&mut app);
    let last = of(&mut app);
    assert!(
        first.0.is_disjoint(&last.0) && first.1.is_disjoint(&last.1),
        "cells and trees of the first place are gone"
    );
    // Four cells of 32 m have the area of one of 64 m, the default.
    assert_eq!(most_despawned, 4, "cells despawned in one frame");
    assert_eq!(most_spawned, TREES_PER_FRAME as usize, "trees spawned in one frame");
}

/// A cell, whether it is visible, and points of the bounds of its trees.
struct CellState {
    centre_m: Vec3,
    visible: bool,
    points_m: Vec<Vec3>,
}

/// All cells, with corners and centre of the bounds of each tree.
fn cell_states(app: &mut App) -> Vec<CellState> {
    let world = app.world_mut();
    let mut cells: BTreeMap<Entity, CellState> = world
        .query::<(Entity, &ForestCell, &Visibility)>()
        .iter(world)
        .map(|(entity, cell, visibility)| {
            let centre = (cell.0.as_vec2() + 0.5) * CELL_M;
            let visible = *visibility != Visibility::Hidden;
            (entity, CellState { centre_m: Vec3::new(centre.x, 0.0, centre.y), visible, points_m: Vec::new() })
        })
        .collect();
    let mut trees = world.query::<(&Grown, &Transform, &ChildOf)>();
    let models = world.resource::<Assets<TreeModel>>();
    for (grown, at, cell) in trees.iter(world) {
        let bounds = models.get(&grown.model).unwrap().bounds;
        let corner = |number: u32| {
            let upper = BVec3::new(number & 1 > 0, number & 2 > 0, number & 4 > 0);
            Vec3::select(upper, bounds.max, bounds.min)
        };
        let points = (0..8).map(corner).chain([0.5 * (bounds.min + bounds.max)]);
        cells.get_mut(&cell.parent()).unwrap().points_m.extend(points.map(|point| at.transform_point(point)));
    }
    cells.into_values().collect()
}

/// The view of a camera, by its projection alone.
struct View {
    at: Transform,
    clip_from_world: Mat4,
}

impl View {
    /// Moves the camera and runs a frame.
    fn of(app: &mut App, camera: Entity, at: Transform) -> Self {
        move_to(app, camera, at);
        app.update();
        let clip_from_view = app.world().get::<Projection>(camera).unwrap().get_clip_from_view();
        Self { at, clip_from_world: clip_from_view * at.to_matrix().inverse() }
    }

    fn sees(&self, point_m: Vec3) -> bool {
        let clip = self.clip_from_world * point_m.extend(1.0);
        clip.w > 0.0 && clip.x.abs() <= clip.w && clip.y.abs() <= clip.w && (0.0..=clip.w).contains(&clip.z)
    }

    fn sees_any(&self, cell: &CellState) -> bool {
        cell.points_m.iter().any(|point| self.sees(*point))
    }

    /// Whether a shadow of the cell on the level ground is in view.
    fn sees_shadow(&self, cell: &CellState, light: Vec3) -> bool {
        let shadow = |point: &Vec3| point + light * (point.y.max(0.0) / -light.y);
        let seen = |shadow: Vec3| self.sees(shadow) && shadow.distance(self.at.translation) <= SHADOWS_TO_M;
        cell.points_m.iter().map(shadow).any(seen)
    }

    fn is_far(&self, cell: &CellState) -> bool {
        cell.centre_m.distance(self.at.translation) > ForestCulling::default().around_m + CELL_M
    }

    /// Whether a cell and its trees are far behind the camera.
    fn is_behind(&self, cell: &CellState) -> bool {
        self.is_far(cell) && self.at.forward().dot(cell.centre_m - self.at.translation) < -2.0 * CELL_M
    }
}

fn random_view(random: &mut Xoshiro256PlusPlus, turn_rad: f32) -> Transform {
    let [x, z] = [0; 2].map(|_| random.random_range(-40.0..40.0));
    let turn = Quat::from_euler(EulerRot::YXZ, turn_rad, random.random_range(-0.5..0.3), 0.0);
    Transform::from_xyz(x, random.random_range(1.0..40.0), z).with_rotation(turn)
}

#[test]
fn cells_in_view_are_visible_and_most_behind_the_camera_are_hidden() {
    let (mut app, camera) = forest_app(200.0, 200.0);
    let mut random = Xoshiro256PlusPlus::seed_from_u64(11);
    let (mut seen, mut behind, mut hidden_behind) = (0, 0, 0);
    for _ in 0..24 {
        let turn_rad = random.random_range(0.0..std::f32::consts::TAU);
        let lens = PerspectiveProjection { fov: random.random_range(0.3..1.3), aspect_ratio: 1.7, ..default() };
        *app.world_mut().get_mut::<Projection>(camera).unwrap() = lens.into();
        let view = View::of(&mut app, camera, random_view(&mut random, turn_rad));
        for frames in [0, 7, FRAMES_TO_HIDE] {
            (0..frames).for_each(|_| app.update());
            let cells = cell_states(&mut app);
            let in_view: Vec<_> = cells.iter().filter(|cell| view.sees_any(cell)).collect();
            seen += in_view.len();
            let missing = in_view.iter().filter(|cell| !cell.visible).count();
            assert_eq!(missing, 0, "cells in view of {:?} that are hidden after {frames} frames", view.at);
        }
        let cells = cell_states(&mut app);
        let cells_behind = || cells.iter().filter(|cell| view.is_behind(cell));
        behind += cells_behind().count();
        hidden_behind += cells_behind().filter(|cell| !cell.visible).count();
    }
    println!("{seen} cells in view; {hidden_behind} hidden of {behind} behind");
    assert!(seen > 300 && behind > 300, "{seen} seen, {behind} behind");
    assert!(hidden_behind * 10 >= behind * 9, "{hidden_behind} hidden of {behind} behind");
}

#[test]
fn cells_with_a_shadow_in_view_are_visible_while_there_are_shadows() {
    let (mut app, camera) = forest_app(200.0, 200.0);
    let light = Transform::default().looking_to(Vec3::new(0.0, -0.14, -1.0), Vec3::Y);
    let cascades: CascadeShadowConfig =
        CascadeShadowConfigBuilder { maximum_distance: SHADOWS_TO_M, ..default() }.into();
    let sun = DirectionalLight { shadow_maps_enabled: true, ..default() };
    let sun = app.world_mut().spawn((sun, cascades, light)).id();
    let mut random = Xoshiro256PlusPlus::seed_from_u64(12);
    let (mut only_shadows, mut hidden_without) = (0, 0);
    for _ in 0..12 {
        let turn_rad = random.random_range(-0.6..0.6);
        let view = View::of(&mut app, camera, random_view(&mut random, turn_rad));
        for frames in [0, FRAMES_TO_HIDE] {
            (0..frames).for_each(|_| app.update());
            let cells = cell_states(&mut app);
            let shadowing: Vec<_> = cells.iter().filter(|cell| view.sees_shadow(cell, *light.forward())).collect();
            only_shadows += shadowing.iter().filter(|cell| view.is_far(cell) && !view.sees_any(cell)).count();
            let missing = shadowing.iter().filter(|cell| !cell.visible).count();
            assert_eq!(missing, 0, "hidden cells with a shadow in view of {:?}", view.at);
        }
        app.world_mut().get_mut::<DirectionalLight>(sun).unwrap().shadow_maps_enabled = false;
        (0..FRAMES_TO_HIDE).for_each(|_| app.update());
        let cells = cell_states(&mut app);
        let hidden = cells.iter().filter(|cell| !cell.visible && view.sees_shadow(cell, *light.forward()));
        hidden_without += hidden.count();
        app.world_mut().get_mut::<DirectionalLight>(sun).unwrap().shadow_maps_enabled = true;
    }
    println!("{only_shadows} cells with only shadows in view; {hidden_without} hidden without shadows");
    assert!(only_shadows > 20 && hidden_without > 10, "{only_shadows} only shadows, {hidden_without} hidden");
}
