//! How a tree stands in the world, and the wind there.

use super::response::WindResponse;
use crate::dynamics::{
    stand_wind::{LOW_SHARE, StandWind, WindAtTree},
    table_place::TablePlace,
};
use bevy::prelude::*;

/// Where a tree stands. One without a parent is where its `Transform` says; for a child the best that is known is the place of the last
/// propagation.
pub(super) fn stands_at(transform: &Transform, global: &GlobalTransform, is_child: bool) -> GlobalTransform {
    if is_child { *global } else { GlobalTransform::from(*transform) }
}

/// The uniform scale nearest to that of a tree, without its sign.
pub(crate) fn uniform_scale(stands: &GlobalTransform) -> f32 {
    stands.affine().matrix3.determinant().abs().cbrt()
}

/// The rotation of a tree, after a mirror image along x if it is mirrored.
pub(crate) fn world_from_local(stands: &GlobalTransform) -> Mat3 {
    let (scale, rotation, _) = stands.to_scale_rotation_translation();
    Mat3::from_quat(rotation) * Mat3::from_diagonal(Vec3::new(scale.x.signum(), 1.0, 1.0))
}

/// The wind of a table at a tree of that height in a stand, m/s in world axes.
pub(super) fn wind_at_tree(
    response: &WindResponse,
    stand: &StandWind,
    place: &TablePlace,
    height_m: f32,
) -> WindAtTree {
    let velocity = response.table.velocity(place);
    let wind_at = |height_m: f32| response.field.frame().to_world(stand.velocity(height_m, velocity));
    WindAtTree { high: wind_at(height_m), low: wind_at(LOW_SHARE * height_m) }
}
