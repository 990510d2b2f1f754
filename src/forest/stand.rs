//! The stand that a plan grows, as the wind feels it: how high and dense it is about a place, and how far the place is open to each side.
//!
//! It follows from the plan's expected densities and not from the single plants. So it needs no other cells, and a tree's own crown
//! counts as much as its neighbours'. What a game has felled and planted counts cell by cell, and bare trees stop the wind by their wood alone.

use super::stand_changes::CellBalances;
use crate::{
    ground::Ground,
    scatter::Planter,
    tree::{LeafSeason, growth::age::Age},
    wind::{Canopy, EXPOSURE_DIRECTIONS, UpwindPath, exposure_direction},
};
use bevy::math::{DVec2, FloatExt};
use std::sync::Arc;

/// Steps in which one looks upwind, m, the nearest first: what is far away is felt less. Of what is farther than their sum, [`REACH_M`],
/// fifteen heights of a tall forest, little is left.
const STEPS_M: [f32; 9] = [8.0, 8.0, 16.0, 16.0, 32.0, 32.0, 64.0, 64.0, 80.0];
/// Trees farther than this, m, make no difference.
pub(super) const REACH_M: f32 = 320.0;
/// In so many steps a stand becomes green or bare: at each one its wind is worked out again.
const LEAF_STEPS: f32 = 8.0;
/// Square metres of a hectare.
const HECTARE_M2: f32 = 1e4;

/// What a stand's wind follows from, of a species.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct StandSpecies {
    pub age: Age,
    /// Height and frontal area of a mature tree in leaf, m and m^2.
    pub height_m: f32,
    pub frontal_area_m2: f32,
    /// Share of its drag that is left without leaves.
    pub bare_share: f32,
    pub leaves: LeafSeason,
    /// How much of its leaves it has now.
    pub leaf_share: f32,
}

/// The stand of a forest, anywhere.
pub(super) struct Stand {
    pub planter: Arc<Planter>,
    pub ground: Arc<dyn Ground>,
    /// In the order of the planter's; none for species that cannot be loaded.
    pub species: Vec<Option<StandSpecies>>,
    /// What is other than in the plan.
    pub balances: CellBalances,
}

impl StandSpecies {
    /// The same at a time of the year, to an eighth of its leaves.
    pub fn in_season(self, year: f32) -> Self {
        Self { leaf_share: (self.leaves.share(year) * LEAF_STEPS).round() / LEAF_STEPS, ..self }
    }

    /// Frontal area and height of a tree at an age, m^2 and m. The area is that of a crown in leaf with the same drag.
    pub fn tree_at(&self, age_years: f32) -> (f32, f32) {
        let size = self.age.stage(age_years).height;
        let area_m2 = self.frontal_area_m2 * self.bare_share.lerp(1.0, self.leaf_share);
        (area_m2 * size * size, self.height_m * size)
    }
}

/// The trees that are to be expected at a place.
#[derive(Clone, Copy, Debug, Default)]
struct Trees {
    frontal_area_index: f32,
    /// Of the trees, each weighed by its frontal area, m.
    height_m: f32,
}

impl Stand {
    /// The canopies of `side` x `side` places, row after row, from a first one (x, z) on and `spacing_m` apart.
    pub fn canopies(&self, first_m: DVec2, spacing_m: f32, side: u32) -> Vec<Canopy> {
        let place = |number: u32| DVec2::new(f64::from(number % side), f64::from(number / side));
        (0..side * side).map(|number| self.canopy(first_m + place(number) * f64::from(spacing_m))).collect()
    }

    fn canopy(&self, place: DVec2) -> Canopy {
        if self.species.iter().all(Option::is_none) {
            return Canopy::default();
        }
        let paths: [UpwindView; EXPOSURE_DIRECTIONS] =
            std::array::from_fn(|number| self.look_upwind(place, exposure_direction(number).as_dvec2()));
        let exposure = paths.map(|path| path.exposure);
        // In a clearing the air is that of the nearest stand.
        let here = self.trees_at(place);
        let nearest = paths.iter().min_by(|a, b| a.distance_m.total_cmp(&b.distance_m)).map(|path| path.nearest);
        let Trees { frontal_area_index, height_m } =
            if here.frontal_area_index > 0.0 { here } else { nearest.unwrap_or_default() };
        Canopy { height_m, frontal_area_index, exposure }
    }

    fn trees_at(&self, at: DVec2) -> Trees {
        let (mut index, mut moment) = (0.0, 0.0);
        self.planter.expected_stock(at, &self.ground, |stock| {
            let Some(Some(species)) = self.species.get(usize::from(stock.species)) else { return };
            let (area_m2, height_m) = species.tree_at(stock.age_years);
            let area = stock.density_per_ha / HECTARE_M2 * area_m2;
            index += area;
            moment += area * height_m;
        });
        if let Some(balance) = self.balances.get(&self.planter.cell_at(at.as_vec2())) {
            let cell_m2 = self.planter.cell_m().powi(2);
            index = balance.left * index + balance.added_m2 / cell_m2;
            moment = balance.left * moment + balance.added_m3 / cell_m2;
        }
        if index > 0.0 { Trees { frontal_area_index: index, height_m: moment / index } } else { Trees::default() }
    }

    /// What lies upwind of a place, with a wind that blows in a direction.
    fn look_upwind(&self, place: DVec2, direction: DVec2) -> UpwindView {
        let mut path = UpwindPath::from_open();
        let mut view = UpwindView { exposure: 1.0, distance_m: f32::INFINITY, nearest: Trees::default() };
        let mut far_m: f32 = STEPS_M.iter().sum();
        for step_m in STEPS_M.into_iter().rev() {
            let distance_m = far_m - 0.5 * step_m;
            far_m -= step_m;
            let trees = self.trees_at(place - direction * f64::from(distance_m));
            if trees.frontal_area_index > 0.0 {
                (view.distance_m, view.nearest) = (distance_m, trees);
            }
            // In the open the wind comes back behind the stand that was before.
            path.pass(step_m, view.nearest.height_m, trees.frontal_area_index);
        }
        UpwindView { exposure: path.exposure(), ..view }
    }
}

/// What lies upwind of a place.
#[derive(Clone, Copy)]
struct UpwindView {
    /// How open the place is.
    exposure: f32,
    /// How far the nearest trees are, m, and which.
    distance_m: f32,
    nearest: Trees,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        forest::stand_changes::CellBalance,
        ground::LevelGround,
        scatter::{
            ForestPlan,
            plan::{Area, Shape, Stock},
        },
        tree::phenology::Phenology,
    };

    /// A wood of 400 m by 400 m: 100 trees a hectare of 20 m height and 100 m^2.
    fn wood() -> Stand {
        let shape = Shape::Rectangle { min_m: [0.0, 0.0], max_m: [400.0, 400.0] };
        let age_years = Age::default().mature_years;
        let stock = vec![Stock { age_years, age_spread_years: 0.0, ..Stock::default() }];
        let area = Area { shape, density_per_ha: 100.0, stock, ..Area::default() };
        let planter = Planter::new(&ForestPlan { areas: vec![area], ..ForestPlan::default() }).expect("a valid plan");
        let (planter, ground) = (Arc::new(planter), Arc::new(LevelGround::default()));
        Stand { planter, ground, species: vec![Some(species())], balances: CellBalances::default() }
    }

    fn species() -> StandSpecies {
        let leaves = LeafSeason::of(&Phenology::default());
        StandSpecies {
            age: Age::default(),
            height_m: 20.0,
            frontal_area_m2: 100.0,
            bare_share: 0.2,
            leaves,
            leaf_share: 1.0,
        }
    }

    fn canopy(x: f64, z: f64) -> Canopy {
        wood().canopies(DVec2::new(x, z), 1.0, 1)[0]
    }

    #[test]
    fn a_stand_is_as_high_and_dense_as_its_plan() {
        let middle = canopy(200.0, 200.0);
        assert!((middle.height_m - 20.0).abs() < 0.01 && (middle.frontal_area_index - 1.0).abs() < 0.01, "{middle:?}");
        assert!(middle.exposure.iter().all(|exposure| *exposure < 0.02), "{middle:?}");
        assert_eq!(canopy(-5000.0, 0.0), Canopy::default());
    }

    #[test]
    fn the_first_rows_are_open_to_one_side_and_shelter_those_behind() {
        // Drag area of 0.025 for each metre: e^-1 after 40 m.
        let edge = canopy(1.0, 200.0);
        assert!(edge.exposure[0] > 0.8 && edge.exposure[4] < 0.02, "{edge:?}");
        let mut before = edge.exposure[0];
        for x in [20.0, 40.0, 80.0, 160.0] {
            let behind = canopy(x, 200.0).exposure[0];
            assert!((behind - (-x as f32 / 40.0).exp()).abs() < 0.2 && behind < before, "{x} m: {behind}");
            before = behind;
        }
    }

    /// By their closed forms: an index of 0.2, and e^-1 of the wind after 200 m in the place of 40.
    #[test]
    fn a_bare_wood_lets_the_wind_in() {
        let winter = Stand { species: vec![Some(species().in_season(0.0))], ..wood() };
        let at = |x: f64| winter.canopies(DVec2::new(x, 200.0), 1.0, 1)[0];
        assert!((at(200.0).frontal_area_index - 0.2).abs() < 1e-3 && (at(200.0).height_m - 20.0).abs() < 0.01);
        for x in [20.0, 80.0, 200.0] {
            let open = at(x).exposure[0];
            assert!((open - (-x as f32 / 200.0).exp()).abs() < 0.1, "{x} m: {open}");
        }
    }

    #[test]
    fn a_year_has_few_stands() {
        let years = (0..=1000).map(|step| species().in_season(step as f32 / 1000.0));
        let mut stands: Vec<StandSpecies> = years.collect();
        assert_eq!((stands[0].leaf_share, stands[550].leaf_share, stands[1000].leaf_share), (0.0, 1.0, 0.0));
        stands.dedup();
        assert!((10..=17).contains(&stands.len()), "{}", stands.len());
        let evergreen = StandSpecies { leaves: LeafSeason::EVERGREEN, ..species() };
        assert_eq!(evergreen.in_season(0.0), evergreen);
    }

    #[test]
    fn behind_a_wood_the_wind_comes_back() {
        let behind = |distance_m: f64| canopy(400.0 + distance_m, 200.0);
        assert!(behind(10.0).exposure[0] < 0.3);
        assert!(behind(250.0).exposure[0] > 0.85);
        assert!(behind(10.0).height_m > 19.0, "the air behind a wood is that of the wood");
    }

    #[test]
    fn canopies_of_a_grid_are_those_of_its_places() {
        let (first, spacing_m) = (DVec2::new(-32.0, 100.0), 32.0);
        let grid = wood().canopies(first, spacing_m, 4);
        assert_eq!(grid.len(), 16);
        for (number, canopy) in grid.iter().enumerate() {
            let place = first + DVec2::new((number % 4) as f64, (number / 4) as f64) * 32.0;
            assert_eq!(*canopy, wood().canopies(place, spacing_m, 1)[0], "{place}");
        }
    }

    #[test]
    fn steps_reach_as_far_as_trees_make_a_difference() {
        assert_eq!(STEPS_M.iter().sum::<f32>(), REACH_M);
    }

    /// Every second stem of the wood is gone: half the index. In its middle cell all are, and 20 such trees are planted there.
    #[test]
    fn what_is_felled_and_planted_counts() {
        let cells = (0..7).flat_map(|z| (0..7).map(move |x| bevy::math::IVec2::new(x, z)));
        let half = CellBalance { left: 0.5, ..CellBalance::default() };
        let mut stand = Stand { balances: cells.map(|cell| (cell, half)).collect(), ..wood() };
        let place = DVec2::splat(3.5 * 64.0);
        let thinned = stand.canopies(place, 1.0, 1)[0];
        assert!((thinned.frontal_area_index - 0.5).abs() < 0.01 && (thinned.height_m - 20.0).abs() < 0.01);
        assert!(thinned.exposure[0] > wood().canopies(place, 1.0, 1)[0].exposure[0]);
        let planted = CellBalance { left: 0.0, added_m2: 2000.0, added_m3: 40_000.0 };
        stand.balances.insert(bevy::math::IVec2::splat(3), planted);
        let replanted = stand.canopies(place, 1.0, 1)[0];
        assert!(
            (replanted.frontal_area_index - 2000.0 / 4096.0).abs() < 1e-3 && (replanted.height_m - 20.0).abs() < 0.01
        );
    }

    #[test]
    fn species_that_cannot_be_loaded_are_no_stand() {
        let stand = Stand { species: vec![None], ..wood() };
        assert_eq!(stand.canopies(DVec2::splat(200.0), 1.0, 1)[0], Canopy::default());
    }
}
