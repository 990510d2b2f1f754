//! The large forest: a plan for up to millions of trees over kilometres of ground, and a hamlet of plain boxes on a meadow
//! in its middle, as in figure 10 of Setas et al.

use crate::{options::Options, support::landscape::Landscape};
use bevy::{light::NotShadowCaster, math::DVec2, prelude::*};
use bevy_windwood::{
    forest::PlanCover,
    prelude::*,
    scatter::{
        ForestPlan, Planter,
        counts::CountModel,
        plan::{Area, GroundLimits, KeepOut, Shape, Stock},
    },
    terrain::Cover,
};
use std::sync::Arc;

/// Trees of a cell, about. A cell is streamed and culled as one, so it needs some.
const TREES_PER_CELL: f32 = 40.0;
/// Radius of the meadow around the hamlet, m.
const MEADOW_M: f32 = 62.0;
/// Houses: place and sides on the map, height of the walls, m, and rotation, degrees.
const HOUSES: [([f32; 2], [f32; 2], f32, f32); 5] = [
    ([-6.0, -14.0], [11.0, 7.0], 4.2, 12.0),
    ([14.0, -22.0], [9.0, 6.5], 3.6, -25.0),
    ([-24.0, -26.0], [12.0, 7.5], 5.0, 40.0),
    ([30.0, -4.0], [8.0, 6.0], 3.4, 75.0),
    ([4.0, -38.0], [14.0, 8.0], 5.4, -8.0),
];
/// Side of a patch of grass, m.
const PATCH_M: f32 = 14.0;

/// The plan of the forest.
pub fn plan(options: &Options, extent_m: f32) -> ForestPlan {
    let half_m = 0.5 * extent_m;
    let per_m2 = options.trees.max(1) as f32 / (extent_m * extent_m);
    let stock = |species: &str, share, age_years| Stock {
        species: species.into(),
        share,
        age_years,
        age_spread_years: 0.25 * age_years,
        ..default()
    };
    let area = Area {
        name: "forest".into(),
        shape: Shape::Rectangle { min_m: [-half_m; 2], max_m: [half_m; 2] },
        density_per_ha: 1e4 * per_m2,
        pattern: CountModel::NegativeBinomial { k: 2.0 },
        least_distance_m: if per_m2 > 0.02 { 1.0 } else { 2.0 },
        drift_m: 140.0,
        drift_purity: 0.8,
        ground: GroundLimits { steepest_deg: 50.0, ..default() },
        stock: vec![
            stock("fir", 3.0, 75.0),
            stock("norway_spruce", 3.0, 80.0),
            stock("oak", 2.0, 95.0),
            stock("birch", 1.0, 45.0),
        ],
        ..default()
    };
    let houses = HOUSES.iter().map(|&(centre_m, size_m, _, turn_deg)| KeepOut::House { centre_m, size_m, turn_deg });
    let meadow = KeepOut::Disc { centre_m: [0.0; 2], radius_m: MEADOW_M };
    let cell_m = (TREES_PER_CELL / per_m2).sqrt().clamp(32.0, 512.0);
    ForestPlan {
        seed: options.scene.wind.seed,
        cell_m,
        areas: vec![area],
        keep_out: houses.chain([meadow]).collect(),
        ..default()
    }
}

/// The forest as a colour of the ground, for where no tree is drawn.
pub fn cover(plan: &ForestPlan, landscape: &Landscape) -> Option<Arc<dyn Cover>> {
    let planter = Planter::new(plan).inspect_err(|error| error!("the plan: {error}")).ok()?;
    Some(Arc::new(PlanCover::new(planter, landscape.ground.clone())))
}

/// How far trees are entities, and how far they are drawn.
pub fn settings(options: &Options, extent_m: f32) -> ForestSettings {
    let settings = options.distances.settings(options.scene.image.headless);
    ForestSettings { far_to_m: settings.far_to_m.min(1.5 * extent_m), ..settings }
}

/// A view over the hamlet into the forest.
pub fn camera_transform(landscape: &Landscape) -> Transform {
    let above = |x: f32, z: f32, height_m: f32| Vec3::new(x, landscape.height_m(x, z) + height_m, z);
    Transform::from_translation(above(10.0, 40.0, 7.5)).looking_at(above(0.0, -60.0, 6.0), Vec3::Y)
}

/// Spawns houses of plain boxes, and grass around the camera.
pub fn spawn_hamlet(
    commands: &mut Commands,
    meshes: &mut Assets<Mesh>,
    materials: &mut Assets<StandardMaterial>,
    landscape: &Landscape,
) {
    let matt = |base_color| StandardMaterial { base_color, perceptual_roughness: 0.95, reflectance: 0.1, ..default() };
    let walls = materials.add(matt(Color::srgb(0.86, 0.82, 0.74)));
    let roofs = materials.add(matt(Color::srgb(0.48, 0.2, 0.14)));
    let gable = Triangle2d::new(Vec2::new(-0.5, 0.0), Vec2::new(0.5, 0.0), Vec2::new(0.0, 0.5));
    let roof = meshes.add(Extrusion::new(gable, 1.0));
    let cube = meshes.add(Cuboid::default());
    for ([x, z], [long_m, wide_m], walls_m, turn_deg) in HOUSES {
        let foot_m = landscape.height_m(x, z);
        // Plans rotate from x to z, Bevy from z to x.
        let turn = Quat::from_rotation_y(-turn_deg.to_radians());
        // On a slope the walls reach into the ground.
        let sunk_m = 1.5;
        let body = Transform::from_xyz(x, foot_m + 0.5 * (walls_m - sunk_m), z)
            .with_rotation(turn)
            .with_scale(Vec3::new(long_m, walls_m + sunk_m, wide_m));
        commands.spawn((Mesh3d(cube.clone()), MeshMaterial3d(walls.clone()), body));
        // The ridge runs along the longer side. The eaves stand out by half a metre.
        let along = turn * Quat::from_rotation_y(std::f32::consts::FRAC_PI_2);
        let top = Transform::from_xyz(x, foot_m + walls_m, z).with_rotation(along).with_scale(Vec3::new(
            wide_m + 1.0,
            wide_m + 1.0,
            long_m + 1.0,
        ));
        commands.spawn((Mesh3d(roof.clone()), MeshMaterial3d(roofs.clone()), top));
    }
    let eye = camera_transform(landscape).translation.xz();
    let blades = Tuft { blades: 10, longest_m: 0.42, narrowest_m: 0.006, widest_m: 0.014, ..default() };
    for (column, row) in (-1..=1_i32).flat_map(|column| (-2..=0_i32).map(move |row| (column, row))) {
        let middle = eye + PATCH_M * Vec2::new(column as f32, row as f32 - 0.3);
        let sward = Sward {
            width_m: PATCH_M,
            depth_m: PATCH_M,
            tufts_per_m2: 14.0,
            tuft: blades.clone(),
            seed: (10 * column + row).unsigned_abs().into(),
            ..default()
        };
        let landscape = landscape.clone();
        let height_m = move |at: DVec2| {
            let at = at.as_vec2() + middle;
            f64::from(landscape.height_m(at.x, at.y))
        };
        commands.spawn((
            GrassPatch { sward, ..default() },
            GrassGround(Arc::new(height_m)),
            Transform::from_xyz(middle.x, 0.0, middle.y),
            NotShadowCaster,
        ));
    }
}
