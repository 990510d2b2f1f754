//! What grows under the trees of the small forest and at its edge: a forest of its own, which is there only as far as such small plants are
//! seen.

use crate::{small, support::landscape::Landscape};
use bevy::prelude::*;
use bevy_windwood::{
    forest::ForestGround,
    prelude::*,
    scatter::{
        ForestPlan,
        counts::CountModel,
        plan::{Area, Shape, Stock},
    },
};

/// Width of the belt of shrubs about the wood, m.
const BELT_M: f32 = 7.0;
/// Plants are entities up to the first distance, and impostors up to the second, m.
const SEEN_TO_M: [f32; 2] = [40.0, 110.0];

/// Spawns the undergrowth of a wood of so many trees.
pub fn spawn_undergrowth(
    commands: &mut Commands,
    plans: &mut Assets<ForestPlan>,
    landscape: &Landscape,
    trees: u32,
    seed: u64,
) {
    let [trees_to_m, far_to_m] = SEEN_TO_M;
    let settings = ForestSettings { trees_to_m, far_to_m, cells_at_once: 16, trees_per_frame: 2000, ..default() };
    commands.spawn((Forest::new(plans.add(plan(trees, seed))), settings, ForestGround(landscape.ground.clone())));
}

fn plan(trees: u32, seed: u64) -> ForestPlan {
    let half_m = small::half_side_m(trees);
    let floor = Area {
        name: "floor".into(),
        shape: Shape::Rectangle { min_m: [-half_m; 2], max_m: [half_m; 2] },
        density_per_ha: 3600.0,
        // In dense groups, with bare ground between.
        pattern: CountModel::NegativeBinomial { k: 0.35 },
        least_distance_m: 0.5,
        drift_m: 9.0,
        drift_purity: 0.9,
        stock: vec![
            stock("bracken", 6.0, 4.0),
            stock("bilberry", 4.0, 8.0),
            stock("bramble", 1.5, 5.0),
            stock("rowan_sapling", 0.2, 8.0),
        ],
        ..default()
    };
    let outer_m = half_m + BELT_M;
    let belts = [
        [[-outer_m, -outer_m], [outer_m, -half_m]],
        [[-outer_m, half_m], [outer_m, outer_m]],
        [[-outer_m, -half_m], [-half_m, half_m]],
        [[half_m, -half_m], [outer_m, half_m]],
    ];
    let belt = belts.map(|[min_m, max_m]| Area {
        name: "edge".into(),
        shape: Shape::Rectangle { min_m, max_m },
        density_per_ha: 500.0,
        pattern: CountModel::NegativeBinomial { k: 0.6 },
        least_distance_m: 1.2,
        drift_m: 14.0,
        drift_purity: 0.8,
        stock: vec![stock("hawthorn", 1.0, 25.0), stock("bramble", 1.5, 5.0), stock("bracken", 3.0, 4.0)],
        ..default()
    });
    ForestPlan { seed, cell_m: 16.0, areas: std::iter::once(floor).chain(belt).collect(), ..default() }
}

fn stock(species: &str, share: f32, age_years: f32) -> Stock {
    Stock { species: species.into(), share, age_years, age_spread_years: 0.3 * age_years, ..default() }
}
