//! The small forest, tree by tree: firs uphill, oaks downhill, in groups, and a meadow below them.

use crate::support::landscape::Landscape;
use bevy::{math::DVec2, prelude::*};
use bevy_windwood::{prelude::*, terrain::Cover};
use noise::{NoiseFn, OpenSimplex};
use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};

/// Ground per tree, m^2.
const AREA_PER_TREE_M2: f32 = 62.0;
/// Least distance between stems, m.
const LEAST_DISTANCE_M: f32 = 4.2;
/// Distance between groups of a species, m.
const GROUP_M: f32 = 70.0;

/// Place of a tree.
pub struct Place {
    pub transform: Transform,
    pub is_fir: bool,
}

/// Half the side of the square that the trees cover, m.
pub fn half_side_m(trees: u32) -> f32 {
    0.5 * (trees.max(1) as f32 * AREA_PER_TREE_M2).sqrt()
}

/// Chooses places for `trees` trees by dart throwing. The same seed gives the same places.
pub fn places(ground: &Landscape, trees: u32, seed: u64) -> Vec<Place> {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
    let groups = OpenSimplex::new(seed as u32);
    let uphill = ground.uphill();
    let half = half_side_m(trees);
    let mut grid = StemGrid::new(half);
    let mut places = Vec::with_capacity(trees as usize);
    // A dart too near to another stem is thrown again. The last four per tree may land anywhere, so that the loop ends.
    let mut darts = 40 * trees;
    while places.len() < trees as usize && darts > 0 {
        darts -= 1;
        let at = Vec2::new(random.random_range(-half..half), random.random_range(-half..half));
        let crowded = darts > 4 * trees && !grid.is_free(at);
        if crowded {
            continue;
        }
        grid.take(at);
        let group = groups.get([at.x, at.y].map(|c| f64::from(c / GROUP_M))) as f32;
        let is_fir = 0.8 * at.dot(*uphill) / half + 1.6 * group + random.random_range(-0.25..0.25) > -0.1;
        let scale = if is_fir { random.random_range(0.6..1.15) } else { random.random_range(0.7..1.1) };
        places.push(Place {
            transform: Transform::from_xyz(at.x, ground.height_m(at.x, at.y), at.y)
                .with_rotation(Quat::from_rotation_y(random.random_range(0.0..std::f32::consts::TAU)))
                .with_scale(Vec3::splat(scale)),
            is_fir,
        });
    }
    places
}

/// Spawns the trees.
pub fn spawn_trees(commands: &mut Commands, assets: &AssetServer, places: &[Place]) {
    let (oak, fir) = (assets.load("species/oak.species.ron"), assets.load("species/fir.species.ron"));
    for place in places {
        let species = if place.is_fir { fir.clone() } else { oak.clone() };
        commands.spawn((Tree::new(species), place.transform));
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

/// A grid of cells that hold at most one stem each, to find neighbours quickly.
struct StemGrid {
    cells: Vec<Option<Vec2>>,
    side: usize,
    half: f32,
}

impl StemGrid {
    fn new(half: f32) -> Self {
        let side = (2.0 * half / Self::CELL_M).ceil() as usize + 1;
        Self { cells: vec![None; side * side], side, half }
    }

    /// Side of a cell. Its diagonal is the least distance of stems, so that no two share a cell.
    const CELL_M: f32 = LEAST_DISTANCE_M * std::f32::consts::FRAC_1_SQRT_2;

    fn cell(&self, at: Vec2) -> (usize, usize) {
        let index = |c: f32| (((c + self.half) / Self::CELL_M) as usize).min(self.side - 1);
        (index(at.x), index(at.y))
    }

    fn is_free(&self, at: Vec2) -> bool {
        let (column, row) = self.cell(at);
        let around = |index: usize| index.saturating_sub(2)..(index + 3).min(self.side);
        around(row)
            .flat_map(|row| around(column).map(move |column| (row, column)))
            .filter_map(|(row, column)| self.cells[row * self.side + column])
            .all(|stem| stem.distance(at) >= LEAST_DISTANCE_M)
    }

    fn take(&mut self, at: Vec2) {
        let (column, row) = self.cell(at);
        self.cells[row * self.side + column] = Some(at);
    }
}
