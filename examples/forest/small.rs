//! The small forest: oaks downhill, firs uphill, each with some of the other in groups, and a meadow below them.

use crate::support::landscape::Landscape;
use bevy::{math::DVec2, prelude::*};
use bevy_windwood::{
    prelude::*,
    scatter::{
        ForestPlan,
        counts::CountModel,
        plan::{Area, Shape, Stock},
    },
    terrain::Cover,
};
use noise::{NoiseFn, OpenSimplex};

/// Ground per tree, m^2.
const AREA_PER_TREE_M2: f32 = 62.0;
/// Distance between groups of a species, m.
const GROUP_M: f32 = 45.0;
/// Where the firs begin, of the way from the lower edge to the upper one: -1 to 1.
const FIRS_FROM: f32 = 0.15;

/// Distance between clumps of grass in the wood, m.
const CLUMP_M: f64 = 2.6;
/// Noise above which grass grows in the wood: half of the ground.
const SHADE: f64 = 0.0;

/// Half the side of the square that the trees cover, m.
pub fn half_side_m(trees: u32) -> f32 {
    0.5 * (trees.max(1) as f32 * AREA_PER_TREE_M2).sqrt()
}

/// Spawns about so many trees. The same seed gives the same trees.
pub fn spawn_trees(commands: &mut Commands, plans: &mut Assets<ForestPlan>, ground: &Landscape, trees: u32, seed: u64) {
    if trees == 0 {
        return;
    }
    let half_m = half_side_m(trees);
    // From below the wood one sees all of it as trees, and from farther away as impostors.
    let settings = ForestSettings {
        trees_to_m: 3.0 * half_m + 60.0,
        far_to_m: 12_000.0,
        cells_at_once: 16,
        trees_per_frame: 2000,
        ..default()
    };
    let plan = plans.add(plan(*ground.uphill(), half_m, seed));
    commands.spawn((Forest::new(plan), settings));
}

fn plan(uphill: Vec2, half_m: f32, seed: u64) -> ForestPlan {
    let line_m = FIRS_FROM * half_m;
    let areas = [
        area("oaks", part(half_m, -uphill, -line_m), [stock("oak", 5.0, 90.0), stock("fir", 1.0, 60.0)]),
        area("firs", part(half_m, uphill, line_m), [stock("fir", 5.0, 75.0), stock("oak", 1.0, 80.0)]),
    ];
    ForestPlan { seed, cell_m: 32.0, areas: areas.into_iter().flatten().collect(), ..default() }
}

fn area(name: &str, shape: Option<Shape>, stock: [Stock; 2]) -> Option<Area> {
    Some(Area {
        name: name.into(),
        shape: shape?,
        density_per_ha: 1e4 / AREA_PER_TREE_M2,
        // More regular than chance, as trees are that have grown up side by side.
        pattern: CountModel::Binomial { n: 3 },
        least_distance_m: 3.6,
        drift_m: GROUP_M,
        drift_purity: 0.85,
        stock: stock.into(),
        ..default()
    })
}

fn stock(species: &str, share: f32, age_years: f32) -> Stock {
    Stock { species: species.into(), share, age_years, age_spread_years: 0.12 * age_years, ..default() }
}

/// The part of the square that lies on one side of a line, at least so far from the middle along `direction`: Sutherland & Hodgman 1974.
fn part(half_m: f32, direction: Vec2, from_m: f32) -> Option<Shape> {
    let square = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|corner| half_m * Vec2::from_array(corner));
    let mut corners_m = Vec::new();
    for (number, &corner) in square.iter().enumerate() {
        let next = square[(number + 1) % square.len()];
        let (here, there) = (corner.dot(direction) - from_m, next.dot(direction) - from_m);
        if here >= 0.0 {
            corners_m.push(corner.to_array());
        }
        if here * there < 0.0 {
            corners_m.push(corner.lerp(next, here / (here - there)).to_array());
        }
    }
    (corners_m.len() > 2).then_some(Shape::Polygon { corners_m })
}

/// The height of the ground where grass grows, m: everywhere outside the wood, and in clumps within.
pub fn meadow(ground: &Landscape, trees: u32, seed: u64) -> impl Fn(DVec2) -> f64 + use<> {
    let (ground, half_m, clumps) = (ground.clone(), f64::from(half_side_m(trees)), OpenSimplex::new(seed as u32));
    move |at| {
        let is_in_wood = trees > 0 && at.abs().max_element() < half_m;
        let is_bare = is_in_wood && clumps.get((at / CLUMP_M).to_array()) < SHADE;
        if is_bare { f64::NAN } else { f64::from(ground.height_m(at.x as f32, at.y as f32)) }
    }
}

/// The floor of the wood, which is littered up to its edge.
pub struct Floor {
    half_m: f32,
}

impl Floor {
    /// That of a wood of so many trees.
    pub fn new(trees: u32) -> Self {
        Self { half_m: half_side_m(trees) }
    }
}

impl Cover for Floor {
    fn share(&self, place: DVec2) -> f32 {
        /// Width of the edge, m.
        const EDGE_M: f32 = 6.0;
        let inside_m = self.half_m - place.abs().max_element() as f32;
        0.8 * (inside_m / EDGE_M).clamp(0.0, 1.0)
    }
}
