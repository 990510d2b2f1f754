//! Where trees stand, cell by cell, so that what touches a few trees does not ask all of them.

use crate::{
    sway::stands::uniform_scale,
    tree::{Grown, TreeModel},
};
use bevy::{ecs::entity::EntityHashMap, platform::collections::HashMap, prelude::*};

/// Side of a cell, m.
const CELL_M: f32 = 32.0;

/// The trees that have a model.
#[derive(Resource, Default)]
pub struct TreeIndex {
    cells: HashMap<IVec2, Vec<Entity>>,
    trees: EntityHashMap<IndexedTree>,
    /// No tree reaches farther from its foot, m.
    most_reach_m: f32,
}

/// A ball around a tree in any wind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct IndexedTree {
    foot: Vec3,
    pub centre: Vec3,
    pub radius_m: f32,
}

impl IndexedTree {
    fn new(model: &TreeModel, at: &GlobalTransform) -> Self {
        let middle = 0.5 * (model.bounds.min + model.bounds.max);
        let half_m = 0.5 * (model.bounds.max - model.bounds.min).length();
        Self { foot: at.translation(), centre: at.transform_point(middle), radius_m: half_m * uniform_scale(at) }
    }

    fn reach_m(&self) -> f32 {
        self.foot.distance(self.centre) + self.radius_m
    }
}

fn cell(place: Vec3) -> IVec2 {
    (place.xz() / CELL_M).floor().as_ivec2()
}

impl TreeIndex {
    fn insert(&mut self, entity: Entity, tree: IndexedTree) {
        self.most_reach_m = self.most_reach_m.max(tree.reach_m());
        let before = self.trees.insert(entity, tree).map(|before| cell(before.foot));
        if before != Some(cell(tree.foot)) {
            before.into_iter().for_each(|cell| self.leave(entity, cell));
            self.cells.entry(cell(tree.foot)).or_default().push(entity);
        }
    }

    fn remove(&mut self, entity: Entity) {
        if let Some(tree) = self.trees.remove(&entity) {
            self.leave(entity, cell(tree.foot));
        }
    }

    fn leave(&mut self, entity: Entity, cell: IVec2) {
        let Some(there) = self.cells.get_mut(&cell) else { return };
        there.retain(|other| *other != entity);
        if there.is_empty() {
            self.cells.remove(&cell);
        }
    }

    /// Every tree any part of which may be within `radius_m` of a place.
    pub(super) fn near(&self, place: Vec3, radius_m: f32) -> impl Iterator<Item = (Entity, &IndexedTree)> {
        let reach_m = radius_m + self.most_reach_m;
        let (low, high) = (cell(place - reach_m), cell(place + reach_m));
        // Where the circle has more cells than there are, these are gone through.
        let span = (high - low).as_i64vec2() + 1;
        let is_wide = span.x.saturating_mul(span.y) > self.cells.len() as i64;
        let all = is_wide.then(|| self.cells.values()).into_iter().flatten();
        let columns = if is_wide { low.x..low.x } else { low.x..high.x.saturating_add(1) };
        let some = columns
            .flat_map(move |x| (low.y..=high.y).map(move |y| IVec2::new(x, y)))
            .filter_map(|cell| self.cells.get(&cell));
        all.chain(some)
            .flatten()
            .filter_map(|entity| self.trees.get(entity).map(|tree| (*entity, tree)))
            .filter(move |(_, tree)| tree.centre.distance(place) <= radius_m + tree.radius_m)
    }
}

/// Notes trees that are new, have another model or have moved. It runs in frames in which something may touch trees, and then sees all
/// that has changed since it last ran.
pub(in crate::sway) fn index_trees(
    models: Res<Assets<TreeModel>>,
    mut index: ResMut<TreeIndex>,
    trees: Query<(Entity, &Grown, &GlobalTransform), Or<(Changed<Grown>, Changed<GlobalTransform>)>>,
) {
    for (entity, grown, at) in &trees {
        if let Some(model) = models.get(&grown.model) {
            index.insert(entity, IndexedTree::new(model, at));
        }
    }
}

/// Forgets a tree that has lost its model, or is gone.
pub(in crate::sway) fn forget_tree(removed: On<Remove<Grown>>, mut index: ResMut<TreeIndex>) {
    index.remove(removed.entity);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tree(foot: Vec3) -> IndexedTree {
        IndexedTree { foot, centre: foot + Vec3::Y * 5.0, radius_m: 6.0 }
    }

    #[test]
    fn trees_near_a_place_are_those_that_a_search_of_all_finds() {
        let mut index = TreeIndex::default();
        let entity = |number: u32| Entity::from_raw_u32(number).expect("it is a number");
        let place = |k: f32| Vec3::new(200.0 * (1.7 * k).sin(), 0.0, 200.0 * (2.3 * k).cos());
        let mut all: Vec<(Entity, IndexedTree)> = Vec::new();
        for number in 0..300 {
            index.insert(entity(number), tree(place(number as f32 + 0.5)));
        }
        for number in 0..300 {
            // Most move, some go.
            let there = tree(place(number as f32));
            index.insert(entity(number), there);
            if number % 7 == 0 {
                index.remove(entity(number));
            } else {
                all.push((entity(number), there));
            }
        }
        for radius_m in [0.0, 10.0, 150.0, 1e9] {
            for k in 0..20 {
                let place = place(k as f32 * 0.37);
                let mut found: Vec<Entity> = index.near(place, radius_m).map(|(entity, _)| entity).collect();
                found.sort_unstable();
                let is_near = |(_, tree): &&(Entity, IndexedTree)| tree.centre.distance(place) <= radius_m + 6.0;
                let mut expected: Vec<Entity> = all.iter().filter(is_near).map(|(entity, _)| *entity).collect();
                expected.sort_unstable();
                assert_eq!(found, expected);
            }
        }
        all.iter().for_each(|(entity, _)| index.remove(*entity));
        assert!(index.cells.is_empty() && index.trees.is_empty());
    }
}
