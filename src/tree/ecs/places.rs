//! Where trees stand.

use crate::tree::{
    components::Grown,
    model::TreeModel,
    place_grid::{PlaceGrid, Standing},
};
use bevy::prelude::*;

/// The trees that have a model, by place: as transforms were propagated last. Written in
/// [`WindwoodSystems::Query`](crate::WindwoodSystems::Query), by what has changed alone.
#[derive(Resource, Default)]
pub struct TreePlaces {
    grid: PlaceGrid<Entity>,
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

    /// The trees any part of which may be within a radius, m, of a place: each with the middle and the radius of a ball that holds it in any
    /// wind.
    pub(crate) fn near(&self, place: Vec3, radius_m: f32) -> impl Iterator<Item = (Entity, Vec3, f32)> {
        self.grid.near(place, radius_m).map(|(tree, standing)| (tree, standing.centre, standing.radius_m))
    }

    /// Visits the trees that a ray may meet: see [`PlaceGrid::along`].
    pub(crate) fn along(
        &self,
        origin: Vec3,
        direction: Vec3,
        longest_m: f32,
        mut visit: impl FnMut(Entity, f32) -> bool,
    ) {
        self.grid.along(origin, direction, longest_m, |tree, _, enters_m| visit(tree, enters_m));
    }
}

/// Follows trees that come, move or become others.
pub(crate) fn track_trees(
    mut places: ResMut<TreePlaces>,
    models: Res<Assets<TreeModel>>,
    changed: Query<(Entity, &Grown, &GlobalTransform), Or<(Changed<Grown>, Changed<GlobalTransform>)>>,
) {
    let places = places.bypass_change_detection();
    for (tree, grown, at) in &changed {
        let Some(model) = models.get(&grown.model) else { continue };
        let (middle, half) = (model.bounds.min.midpoint(model.bounds.max), 0.5 * (model.bounds.max - model.bounds.min));
        let axes = at.affine().matrix3.to_cols_array_2d().map(|axis| Vec3::from(axis).length());
        let radius_m = half.length() * axes[0].max(axes[1]).max(axes[2]);
        places.grid.insert(tree, Standing::new(at.translation(), at.transform_point(middle), radius_m));
    }
}

/// Forgets a tree that has lost its model, or is gone.
pub(in crate::tree) fn forget_tree(removed: On<Remove<Grown>>, mut places: ResMut<TreePlaces>) {
    places.bypass_change_detection().grid.remove(removed.entity);
}
