//! Where trees stand.

use crate::{
    query::grid::{PlaceGrid, Standing},
    tree::{Grown, TreeModel},
};
use bevy::prelude::*;

/// The trees that have a model, by place: as transforms were propagated last.
#[derive(Resource, Default)]
pub struct TreePlaces {
    pub(in crate::query) grid: PlaceGrid<Entity>,
}

impl TreePlaces {
    /// Number of trees.
    #[must_use]
    pub fn len(&self) -> usize {
        self.grid.len()
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Visits the trees whose feet are within a radius, m, of a place (x, z), with their distance on the map, m.
    pub fn within(&self, place: Vec2, radius_m: f32, mut visit: impl FnMut(Entity, f32)) {
        self.grid.within(place, radius_m, |tree, _, distance_m| visit(tree, distance_m));
    }
}

/// Follows trees that come, go, move or become others.
pub(in crate::query) fn track_trees(
    mut places: ResMut<TreePlaces>,
    models: Res<Assets<TreeModel>>,
    changed: Query<(Entity, &Grown, &GlobalTransform), Or<(Changed<Grown>, Changed<GlobalTransform>)>>,
    grown: Query<(), With<Grown>>,
    mut gone: RemovedComponents<Grown>,
) {
    let places = places.bypass_change_detection();
    for tree in gone.read().filter(|tree| !grown.contains(*tree)) {
        places.grid.remove(tree);
    }
    for (tree, grown, at) in &changed {
        let Some(model) = models.get(&grown.model) else { continue };
        let (min, max) = (model.bounds.min, model.bounds.max);
        // Of the box's corners, wherever the tree is turned to: one that lies reaches as far as it was high.
        let local_m = min.abs().max(max.abs()).length();
        let scale = at.affine().matrix3.to_cols_array_2d().map(|axis| Vec3::from(axis).length());
        let reach_m = local_m * scale[0].max(scale[1]).max(scale[2]);
        places.grid.insert(tree, Standing { foot: at.translation(), reach_m });
    }
}
