//! Gives trees about the viewers their colliders.

use crate::{
    query::components::{TreeColliderSettings, TreeColliders},
    setting::valid_or_last,
    tree::{Grown, TreeModel, TreePlaces},
    viewpoint::Viewpoints,
};
use bevy::prelude::*;

/// Trees keep their colliders until every viewer is farther by this factor than where they get them.
const HYSTERESIS: f32 = 1.15;

/// Gives colliders to trees that viewers come near to, takes them from those that they leave, and renews those of trees that have become
/// others.
pub(in crate::query) fn give_colliders(
    mut commands: Commands,
    settings: Res<TreeColliderSettings>,
    mut valid: Local<Option<TreeColliderSettings>>,
    viewpoints: Viewpoints,
    places: Res<TreePlaces>,
    models: Res<Assets<TreeModel>>,
    trees: Query<&Grown, Without<TreeColliders>>,
    given: Query<(Entity, Ref<Grown>, &GlobalTransform), With<TreeColliders>>,
) {
    let is_other = settings.is_changed() && valid.is_some();
    if settings.is_changed() || valid.is_none() {
        let validate = TreeColliderSettings::validate;
        *valid = Some(valid_or_last("tree colliders", &*settings, validate, valid.as_ref()));
    }
    let TreeColliderSettings { to_m, least_radius_m, trees_per_frame } = valid.unwrap_or_default();
    if to_m <= 0.0 && given.is_empty() {
        return;
    }
    let eyes: Vec<Vec2> = viewpoints.iter().map(Vec3::xz).collect();
    let mut give = |tree: Entity, grown: &Grown| {
        let Some(model) = models.get(&grown.model) else { return };
        let capsules = model.body.capsules(&model.body.at_rest(), least_radius_m);
        if let Ok(mut tree) = commands.get_entity(tree) {
            tree.try_insert(TreeColliders { capsules });
        }
    };
    let mut far = Vec::new();
    for (tree, grown, at) in &given {
        let place = at.translation().xz();
        if !eyes.iter().any(|eye| eye.distance(place) < HYSTERESIS * to_m) {
            far.push(tree);
        } else if grown.is_changed() || is_other {
            give(tree, &grown);
        }
    }
    let mut left = trees_per_frame;
    for eye in eyes {
        places.within(eye, to_m, |tree, distance_m| {
            if let Ok(grown) = trees.get(tree)
                && distance_m < to_m
                && left > 0
            {
                left -= 1;
                give(tree, grown);
            }
        });
    }
    for tree in far {
        if let Ok(mut tree) = commands.get_entity(tree) {
            tree.try_remove::<TreeColliders>();
        }
    }
}
