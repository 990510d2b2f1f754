//! Who stands near a place, and along a ray: things with a foot on the map, in square cells.
//!
//! A thing is kept in the cell of its foot. What reaches farther is found by widening the search by the greatest reach there is.

use bevy::{
    math::{IVec2, Vec2, Vec2Swizzles, Vec3, Vec3Swizzles},
    platform::collections::HashMap,
};
use std::{collections::BTreeMap, hash::Hash, iter::from_fn};

/// Side of a cell, m.
const CELL_M: f32 = 32.0;
/// No ray is followed farther on the map, m.
const LONGEST_M: f32 = 1e5;

/// Where a thing stands, and how far it reaches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Standing {
    /// Its foot, m.
    pub foot: Vec3,
    /// The middle and the radius of a ball that holds it, m.
    pub centre: Vec3,
    pub radius_m: f32,
    /// Nothing of it is farther from its foot, m.
    reach_m: f32,
}

impl Standing {
    /// A thing with a foot that a ball holds.
    pub fn new(foot: Vec3, centre: Vec3, radius_m: f32) -> Self {
        Self { foot, centre, radius_m, reach_m: foot.distance(centre) + radius_m }
    }
}

/// Things by place. Nothing that is asked of it depends on the order in which they came.
#[derive(Clone, Debug)]
pub struct PlaceGrid<K> {
    /// By row and column (z, x).
    cells: BTreeMap<(i32, i32), Vec<(K, Standing)>>,
    places: HashMap<K, IVec2>,
    /// The greatest reach so far, m.
    reach_m: f32,
    /// The least and the greatest cell so far.
    bounds: [IVec2; 2],
}

impl<K> Default for PlaceGrid<K> {
    fn default() -> Self {
        let bounds = [IVec2::MAX, IVec2::MIN];
        Self { cells: BTreeMap::new(), places: HashMap::default(), reach_m: 0.0, bounds }
    }
}

fn cell_of(place: Vec2) -> IVec2 {
    (place / CELL_M).floor().as_ivec2()
}

impl<K: Copy + Eq + Hash + Ord> PlaceGrid<K> {
    /// Number of things.
    pub fn len(&self) -> usize {
        self.places.len()
    }

    /// Puts a thing where it stands now. One that stands nowhere, or reaches no one knows how far, is taken out.
    pub fn insert(&mut self, key: K, standing: Standing) {
        self.remove(key);
        if !(standing.foot.is_finite() && (0.0..LONGEST_M).contains(&standing.reach_m)) {
            return;
        }
        let cell = cell_of(standing.foot.xz());
        let there = self.cells.entry((cell.y, cell.x)).or_default();
        // In the order of their keys, whoever came first.
        let place = there.partition_point(|(other, _)| *other < key);
        there.insert(place, (key, standing));
        self.places.insert(key, cell);
        self.reach_m = self.reach_m.max(standing.reach_m);
        self.bounds = [self.bounds[0].min(cell), self.bounds[1].max(cell)];
    }

    /// Takes a thing out.
    pub fn remove(&mut self, key: K) {
        let Some(cell) = self.places.remove(&key) else { return };
        let cell = (cell.y, cell.x);
        let Some(there) = self.cells.get_mut(&cell) else { return };
        there.retain(|(other, _)| *other != key);
        if there.is_empty() {
            self.cells.remove(&cell);
        }
    }

    /// What stands in the cells between two, row by row. It takes as long as there are such cells, however far the two are apart.
    fn between(&self, low: IVec2, high: IVec2) -> impl Iterator<Item = &(K, Standing)> {
        let mut next = Some((low.y, low.x));
        let cells = from_fn(move || {
            loop {
                let ((row, column), there) = self.cells.range(next?..).next()?;
                if *row > high.y {
                    return None;
                }
                if *column < low.x {
                    next = Some((*row, low.x));
                } else if *column > high.x {
                    next = row.checked_add(1).map(|row| (row, low.x));
                } else {
                    next = column.checked_add(1).map(|column| (*row, column));
                    return Some(there);
                }
            }
        });
        cells.flatten()
    }

    /// Visits the things whose feet are within a radius, m, of a place (x, z), with their distance on the map, m: cell by cell, row by row.
    pub fn within(&self, place: Vec2, radius_m: f32, mut visit: impl FnMut(K, &Standing, f32)) {
        if !(place.is_finite() && (0.0..LONGEST_M).contains(&radius_m)) {
            return;
        }
        for (key, standing) in self.between(cell_of(place - radius_m), cell_of(place + radius_m)) {
            let distance_m = standing.foot.xz().distance(place);
            if distance_m <= radius_m {
                visit(*key, standing, distance_m);
            }
        }
    }

    /// The things whose balls are within a radius, m, of a place in space.
    pub fn near(&self, place: Vec3, radius_m: f32) -> impl Iterator<Item = (K, &Standing)> {
        let reach_m = radius_m + self.reach_m;
        let near = self.between(cell_of(place.xz() - reach_m), cell_of(place.xz() + reach_m));
        near.filter(move |(_, it)| it.centre.distance(place) <= radius_m + it.radius_m).map(|(key, it)| (*key, it))
    }

    /// Visits the things that a ray passes within their reach on the map, each once, until `visit` answers no. The last argument of
    /// `visit` is a distance along the ray, m: neither this thing nor any to come is met before.
    pub fn along(
        &self,
        origin: Vec3,
        direction: Vec3,
        longest_m: f32,
        mut visit: impl FnMut(K, &Standing, f32) -> bool,
    ) {
        let longest_m = longest_m.min(LONGEST_M);
        if !(origin.is_finite() && direction.is_normalized() && longest_m >= 0.0) || self.places.is_empty() {
            return;
        }
        let (from, way) = (origin.xz(), direction.xz());
        let along_x = way.x.abs() >= way.y.abs();
        let turned = |place: Vec2| if along_x { place } else { place.yx() };
        let (from_turned, way_turned) = (turned(from), turned(way));
        let number = |place_m: f32| (place_m / CELL_M).floor() as i32;
        let end = from_turned + longest_m * way_turned;
        let [least, greatest] = self.bounds.map(|cell| if along_x { cell } else { cell.yx() });
        let first = number(from_turned.x.min(end.x) - self.reach_m).max(least.x);
        let last = number(from_turned.x.max(end.x) + self.reach_m).min(greatest.x);
        for step in 0..=last.saturating_sub(first) {
            let slab = if way_turned.x >= 0.0 { first + step } else { last - step };
            // The part of the ray on which it may meet what stands in the slab.
            let (low_m, high_m) = (slab as f32 * CELL_M - self.reach_m, (slab + 1) as f32 * CELL_M + self.reach_m);
            let [enters_m, leaves_m] = part_between(from_turned.x, way_turned.x, longest_m, [low_m, high_m]);
            if enters_m > leaves_m {
                continue;
            }
            let across = [enters_m, leaves_m].map(|t_m| from_turned.y + t_m * way_turned.y);
            let low = number(across[0].min(across[1]) - self.reach_m).max(least.y);
            let high = number(across[0].max(across[1]) + self.reach_m).min(greatest.y);
            for other in low..=high {
                let cell = if along_x { IVec2::new(slab, other) } else { IVec2::new(other, slab) };
                for (key, standing) in self.cells.get(&(cell.y, cell.x)).into_iter().flatten() {
                    if is_passed(standing, from, way, longest_m) && !visit(*key, standing, enters_m) {
                        return;
                    }
                }
            }
        }
    }
}

/// The part of a ray on which a coordinate lies between two values.
fn part_between(from: f32, way: f32, longest_m: f32, [low, high]: [f32; 2]) -> [f32; 2] {
    if way == 0.0 {
        return if (low..=high).contains(&from) { [0.0, longest_m] } else { [1.0, 0.0] };
    }
    let (one, other) = ((low - from) / way, (high - from) / way);
    [one.min(other).max(0.0), one.max(other).min(longest_m)]
}

/// Whether a stretch on the map comes within the reach of a thing.
fn is_passed(standing: &Standing, from: Vec2, way: Vec2, longest_m: f32) -> bool {
    let to_foot = standing.foot.xz() - from;
    let square = way.length_squared();
    let t_m = if square > 0.0 { (to_foot.dot(way) / square).clamp(0.0, longest_m) } else { 0.0 };
    (to_foot - t_m * way).length_squared() <= standing.reach_m * standing.reach_m
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};

    fn random_grid(count: u32, half_m: f32, random: &mut Xoshiro256PlusPlus) -> (PlaceGrid<u32>, Vec<Standing>) {
        let mut grid = PlaceGrid::default();
        let mut all = Vec::new();
        for key in 0..count {
            let mut spread = || random.random_range(-half_m..half_m);
            let foot = Vec3::new(spread(), 0.1 * spread(), spread());
            let standing = Standing::new(foot, foot, random.random_range(0.5..25.0));
            grid.insert(key, standing);
            all.push(standing);
        }
        (grid, all)
    }

    #[test]
    fn what_is_near_and_what_a_ray_passes_equals_a_search_of_all() {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(4);
        let (mut grid, all) = random_grid(600, 300.0, &mut random);
        // Some go, and some come again elsewhere.
        (0..100).for_each(|key| grid.remove(key));
        (0..50).for_each(|key| grid.insert(key, all[key as usize]));
        let there = |key: u32| !(50..100).contains(&key);
        assert_eq!(grid.len(), 550);
        let mut passed_in_all = 0;
        for _ in 0..300 {
            let place = Vec2::new(random.random_range(-350.0..350.0), random.random_range(-350.0..350.0));
            let radius_m = random.random_range(0.0..120.0);
            let mut fast = Vec::new();
            grid.within(place, radius_m, |key, _, _| fast.push(key));
            fast.sort_unstable();
            let slow = (0..600).filter(|key| there(*key) && all[*key as usize].foot.xz().distance(place) <= radius_m);
            assert_eq!(fast, slow.collect::<Vec<u32>>());

            let direction = Vec3::from_array(std::array::from_fn(|_| random.random_range(-1.0..1.0))).normalize();
            let (origin, longest_m) = (place.extend(3.0).xzy(), random.random_range(0.0..500.0));
            let mut fast = Vec::new();
            let mut nearest_to_come_m = 0.0;
            grid.along(origin, direction, longest_m, |key, _, enters_m| {
                assert!(enters_m >= nearest_to_come_m, "slabs come in order");
                nearest_to_come_m = enters_m;
                fast.push(key);
                true
            });
            let steps = 4000;
            let passed = |standing: &Standing| {
                (0..=steps).any(|step| {
                    let at = origin + longest_m * step as f32 / steps as f32 * direction;
                    at.xz().distance(standing.foot.xz()) <= standing.reach_m - 0.02
                })
            };
            for key in (0..600).filter(|key| there(*key) && passed(&all[*key as usize])) {
                assert!(fast.contains(&key), "{key} was missed");
            }
            fast.sort_unstable();
            let count = fast.len();
            fast.dedup();
            assert_eq!(fast.len(), count, "each once");
            passed_in_all += count;
        }
        assert!(passed_in_all > 1000, "{passed_in_all}");
    }

    #[test]
    fn odd_places_and_rays_find_nothing() {
        let mut grid = PlaceGrid::default();
        grid.insert(1, Standing::new(Vec3::ZERO, Vec3::ZERO, 3.0));
        grid.insert(2, Standing::new(Vec3::NAN, Vec3::ZERO, 3.0));
        grid.insert(3, Standing::new(Vec3::ZERO, Vec3::ZERO, f32::INFINITY));
        assert_eq!(grid.len(), 1);
        for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            grid.within(Vec2::splat(bad), 10.0, |_, _, _| panic!("nobody is there"));
            grid.within(Vec2::ZERO, bad, |_, _, _| panic!("no radius"));
            assert_eq!(grid.near(Vec3::splat(bad), 10.0).count(), 0);
            grid.along(Vec3::splat(bad), Vec3::X, 10.0, |_, _, _| panic!("no ray"));
            grid.along(Vec3::ZERO, Vec3::splat(bad), 10.0, |_, _, _| panic!("no ray"));
        }
        let mut found = Vec::new();
        grid.along(Vec3::new(-1e4, 0.0, 0.0), Vec3::X, f32::INFINITY, |key, _, _| {
            found.push(key);
            true
        });
        assert_eq!(found, [1]);
        grid.along(Vec3::new(1.0, 50.0, 0.0), Vec3::NEG_Y, 100.0, |key, _, _| {
            found.push(key);
            true
        });
        assert_eq!(found, [1, 1], "straight down");
    }

    /// Things that move, come and go are found where they are, however wide the search.
    #[test]
    fn balls_near_a_place_are_those_that_a_search_of_all_finds() {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(5);
        let mut grid = PlaceGrid::default();
        let mut all: Vec<(u32, Standing)> = Vec::new();
        for round in 0..2 {
            for key in 0..300_u32 {
                let foot = Vec3::from_array(std::array::from_fn(|_| random.random_range(-200.0..200.0)));
                let standing = Standing::new(foot, foot + Vec3::Y * 5.0, random.random_range(1.0..9.0));
                grid.insert(key, standing);
                match (round, key % 7) {
                    (1, 0) => grid.remove(key),
                    (1, _) => all.push((key, standing)),
                    _ => {}
                }
            }
        }
        for radius_m in [0.0, 10.0, 150.0, 1e9, f32::MAX] {
            for _ in 0..20 {
                let place = Vec3::from_array(std::array::from_fn(|_| random.random_range(-250.0..250.0)));
                let mut found: Vec<u32> = grid.near(place, radius_m).map(|(key, _)| key).collect();
                found.sort_unstable();
                let is_near = |(_, it): &&(u32, Standing)| it.centre.distance(place) <= radius_m + it.radius_m;
                let expected: Vec<u32> = all.iter().filter(is_near).map(|(key, _)| *key).collect();
                assert_eq!(found, expected);
            }
        }
        all.iter().for_each(|(key, _)| grid.remove(*key));
        assert!(grid.cells.is_empty() && grid.len() == 0);
    }
}
