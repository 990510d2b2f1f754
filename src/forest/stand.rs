//! The stand that a plan grows, as the wind feels it: how high and dense it is about a place.
//!
//! It follows from the plan's expected densities and not from the single plants. So it needs no other cells, and a tree's own crown
//! counts as much as its neighbours'. What a game has felled and planted counts cell by cell, and bare trees stop the wind by their wood alone.

use super::stand_changes::CellBalances;
use crate::{
    ground::Ground,
    scatter::Planter,
    tree::{LeafSeason, growth::age::Age},
};
use bevy::math::{DVec2, FloatExt};
use std::sync::Arc;

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

/// The trees that are to be expected at a place, by ground area.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct ExpectedTrees {
    pub frontal_area_index: f32,
    /// Sums of frontal area times height, and times height squared, m and m^2.
    first_moment_m: f32,
    second_moment_m2: f32,
}

impl ExpectedTrees {
    fn add(&mut self, frontal_area_index: f32, height_m: f32) {
        self.frontal_area_index += frontal_area_index;
        self.first_moment_m += frontal_area_index * height_m;
        self.second_moment_m2 += frontal_area_index * height_m * height_m;
    }

    /// Of the trees, each weighed by its frontal area and its height, so that shrubs below do not make a wood low, m; 0 without trees.
    pub fn height_m(&self) -> f32 {
        if self.first_moment_m > 0.0 { self.second_moment_m2 / self.first_moment_m } else { 0.0 }
    }
}

impl Stand {
    /// Adds what stands at a place (x, z) of the forest. Where no species can be loaded nothing does, and the ground is not asked.
    pub fn add_trees_at(&self, at: DVec2, trees: &mut ExpectedTrees) {
        if self.species.iter().all(Option::is_none) {
            return;
        }
        let balance = self.balances.get(&self.planter.cell_at(at.as_vec2())).copied().unwrap_or_default();
        self.planter.expected_stock(at, &self.ground, |stock| {
            let Some(Some(species)) = self.species.get(usize::from(stock.species)) else { return };
            let (area_m2, height_m) = species.tree_at(stock.age_years);
            trees.add(balance.left * stock.density_per_ha / HECTARE_M2 * area_m2, height_m);
        });
        if balance.added_m2 > 0.0 {
            let cell_m2 = self.planter.cell_m().powi(2);
            trees.add(balance.added_m2 / cell_m2, balance.added_m3 / balance.added_m2);
        }
    }
}

/// A stand for tests.
#[cfg(test)]
pub(super) mod test_stand {
    use super::*;
    use crate::{
        ground::LevelGround,
        scatter::{
            ForestPlan,
            plan::{Area, Shape, Stock},
        },
        tree::phenology::Phenology,
    };

    /// A wood of 400 m by 400 m: 100 trees a hectare of 20 m height and 100 m^2.
    pub fn wood() -> Stand {
        let shape = Shape::Rectangle { min_m: [0.0, 0.0], max_m: [400.0, 400.0] };
        let age_years = Age::default().mature_years;
        let stock = vec![Stock { age_years, age_spread_years: 0.0, ..Stock::default() }];
        let area = Area { shape, density_per_ha: 100.0, stock, ..Area::default() };
        let planter = Planter::new(&ForestPlan { areas: vec![area], ..ForestPlan::default() }).expect("a valid plan");
        let (planter, ground) = (Arc::new(planter), Arc::new(LevelGround::default()));
        Stand { planter, ground, species: vec![Some(species())], balances: CellBalances::default() }
    }

    pub fn species() -> StandSpecies {
        StandSpecies {
            age: Age::default(),
            height_m: 20.0,
            frontal_area_m2: 100.0,
            bare_share: 0.2,
            leaves: LeafSeason::of(&Phenology::default()),
            leaf_share: 1.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{test_stand::species, *};

    #[test]
    fn a_year_has_few_stands() {
        let species = species();
        let years = (0..=1000).map(|step| species.in_season(step as f32 / 1000.0));
        let mut stands: Vec<StandSpecies> = years.collect();
        assert_eq!((stands[0].leaf_share, stands[550].leaf_share, stands[1000].leaf_share), (0.0, 1.0, 0.0));
        stands.dedup();
        assert!((10..=17).contains(&stands.len()), "{}", stands.len());
        let evergreen = StandSpecies { leaves: LeafSeason::EVERGREEN, ..species };
        assert_eq!(evergreen.in_season(0.0), evergreen);
    }

    #[test]
    fn shrubs_do_not_make_a_wood_low() {
        let mut trees = ExpectedTrees::default();
        assert_eq!(trees.height_m(), 0.0);
        trees.add(2.0, 20.0);
        assert_eq!(trees.height_m(), 20.0);
        trees.add(0.5, 1.0);
        assert!(trees.height_m() > 19.7 && trees.frontal_area_index == 2.5, "{trees:?}");
    }
}
