//! The stands about a place, as the wind and the light meet them: those of all forests, how high and dense they are together, and how far
//! the place is open to each side. Undergrowth that is a forest of its own stands in the shelter of the trees above it.

use super::stand::{ExpectedTrees, Stand};
use crate::wind::{Canopy, EXPOSURE_DIRECTIONS, UpwindPath, exposure_direction};
use bevy::math::DVec2;
use std::sync::Arc;

/// Steps in which one looks upwind, m, the nearest first: what is far away is felt less. Of what is farther than their sum, [`REACH_M`],
/// fifteen heights of a tall forest, little is left.
const STEPS_M: [f32; 9] = [8.0, 8.0, 16.0, 16.0, 32.0, 32.0, 64.0, 64.0, 80.0];
/// Trees farther than this, m, make no difference.
pub(super) const REACH_M: f32 = 320.0;
/// Forests that move by less than this against one another, m, stay where they are: so much the places of an app may be rounded whose
/// origin is moved.
const SAME_PLACE_M: f64 = 1.0;

/// The stand of a forest, and those of all others.
#[derive(Clone)]
pub(super) struct Stands {
    pub own: Arc<Stand>,
    pub others: Vec<OtherStand>,
}

/// The stand of another forest.
#[derive(Clone)]
pub(super) struct OtherStand {
    pub stand: Arc<Stand>,
    /// What is added to a place (x, z) of the own forest to have it in the other's frame, m.
    pub offset_m: DVec2,
}

impl OtherStand {
    /// Whether it is the same, at the same place.
    pub fn is_as(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.stand, &other.stand) && self.offset_m.distance(other.offset_m) < SAME_PLACE_M
    }
}

impl Stands {
    /// The canopies of `side` x `side` places, row after row, from a first one (x, z) on and `spacing_m` apart.
    pub fn canopies(&self, first_m: DVec2, spacing_m: f32, side: u32) -> Vec<Canopy> {
        let place = |number: u32| DVec2::new(f64::from(number % side), f64::from(number / side));
        (0..side * side).map(|number| self.canopy(first_m + place(number) * f64::from(spacing_m))).collect()
    }

    fn canopy(&self, place: DVec2) -> Canopy {
        let paths: [UpwindView; EXPOSURE_DIRECTIONS] =
            std::array::from_fn(|number| self.look_upwind(place, exposure_direction(number).as_dvec2()));
        let exposure = paths.map(|path| path.exposure);
        // In a clearing the air is that of the nearest stand.
        let here = self.trees_at(place);
        let nearest = paths.iter().min_by(|a, b| a.distance_m.total_cmp(&b.distance_m)).map(|path| path.nearest);
        let trees = if here.frontal_area_index > 0.0 { here } else { nearest.unwrap_or_default() };
        Canopy { height_m: trees.height_m(), frontal_area_index: trees.frontal_area_index, exposure }
    }

    fn trees_at(&self, at: DVec2) -> ExpectedTrees {
        let mut trees = ExpectedTrees::default();
        self.own.add_trees_at(at, &mut trees);
        self.others.iter().for_each(|other| other.stand.add_trees_at(at + other.offset_m, &mut trees));
        trees
    }

    /// What lies upwind of a place, with a wind that blows in a direction.
    fn look_upwind(&self, place: DVec2, direction: DVec2) -> UpwindView {
        let mut path = UpwindPath::from_open();
        let mut view = UpwindView { exposure: 1.0, distance_m: f32::INFINITY, nearest: ExpectedTrees::default() };
        let mut far_m: f32 = STEPS_M.iter().sum();
        for step_m in STEPS_M.into_iter().rev() {
            let distance_m = far_m - 0.5 * step_m;
            far_m -= step_m;
            let trees = self.trees_at(place - direction * f64::from(distance_m));
            if trees.frontal_area_index > 0.0 {
                (view.distance_m, view.nearest) = (distance_m, trees);
            }
            // In the open the wind comes back behind the stand that was before.
            path.pass(step_m, view.nearest.height_m(), trees.frontal_area_index);
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
    nearest: ExpectedTrees,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::forest::{
        stand::{
            StandSpecies,
            test_stand::{species, wood},
        },
        stand_changes::CellBalance,
    };

    fn alone(stand: Stand) -> Stands {
        Stands { own: Arc::new(stand), others: Vec::new() }
    }

    fn canopy(x: f64, z: f64) -> Canopy {
        alone(wood()).canopies(DVec2::new(x, z), 1.0, 1)[0]
    }

    /// Ferns of their own forest, whose frame lies 100 m off, under the wood.
    #[test]
    fn undergrowth_of_another_forest_is_sheltered_by_the_wood() {
        let ferns = || Stand {
            species: vec![Some(StandSpecies { height_m: 1.0, frontal_area_m2: 20.0, ..species() })],
            ..wood()
        };
        let wood = OtherStand { stand: Arc::new(wood()), offset_m: DVec2::new(-100.0, 0.0) };
        let place = DVec2::new(300.0, 200.0);
        let sheltered = Stands { own: Arc::new(ferns()), others: vec![wood] }.canopies(place, 1.0, 1)[0];
        assert!(sheltered.height_m > 19.0 && (sheltered.frontal_area_index - 1.2).abs() < 0.01, "{sheltered:?}");
        let free = alone(ferns()).canopies(place, 1.0, 1)[0];
        assert!((free.height_m - 1.0).abs() < 1e-3 && free.exposure[0] > sheltered.exposure[0], "{free:?}");
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
        let winter = alone(Stand { species: vec![Some(species().in_season(0.0))], ..wood() });
        let at = |x: f64| winter.canopies(DVec2::new(x, 200.0), 1.0, 1)[0];
        assert!((at(200.0).frontal_area_index - 0.2).abs() < 1e-3 && (at(200.0).height_m - 20.0).abs() < 0.01);
        for x in [20.0, 80.0, 200.0] {
            let open = at(x).exposure[0];
            assert!((open - (-x as f32 / 200.0).exp()).abs() < 0.1, "{x} m: {open}");
        }
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
        let grid = alone(wood()).canopies(first, spacing_m, 4);
        assert_eq!(grid.len(), 16);
        for (number, canopy) in grid.iter().enumerate() {
            let place = first + DVec2::new((number % 4) as f64, (number / 4) as f64) * 32.0;
            assert_eq!(*canopy, alone(wood()).canopies(place, spacing_m, 1)[0], "{place}");
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
        let halved = || Stand { balances: cells.clone().map(|cell| (cell, half)).collect(), ..wood() };
        let place = DVec2::splat(3.5 * 64.0);
        let thinned = alone(halved()).canopies(place, 1.0, 1)[0];
        assert!((thinned.frontal_area_index - 0.5).abs() < 0.01 && (thinned.height_m - 20.0).abs() < 0.01);
        assert!(thinned.exposure[0] > alone(wood()).canopies(place, 1.0, 1)[0].exposure[0]);
        let planted = CellBalance { left: 0.0, added_m2: 2000.0, added_m3: 40_000.0 };
        let mut stand = halved();
        stand.balances.insert(bevy::math::IVec2::splat(3), planted);
        let replanted = alone(stand).canopies(place, 1.0, 1)[0];
        assert!(
            (replanted.frontal_area_index - 2000.0 / 4096.0).abs() < 1e-3 && (replanted.height_m - 20.0).abs() < 0.01
        );
    }

    #[test]
    fn species_that_cannot_be_loaded_are_no_stand() {
        let stand = Stand { species: vec![None], ..wood() };
        assert_eq!(alone(stand).canopies(DVec2::splat(200.0), 1.0, 1)[0], Canopy::default());
    }
}
