//! Forests know of one another: their trees shelter each other.

use super::{cells::ForestCells, stand::Stand, stands::OtherStand};
use bevy::{math::DVec2, prelude::*};
use std::sync::Arc;

/// Tells each forest of the stands of all others, when one of them is another or has moved.
pub(super) fn share_stands(
    mut known: Local<Vec<(Entity, Arc<Stand>, DVec2)>>,
    mut forests: Query<(Entity, &GlobalTransform, &mut ForestCells)>,
) {
    known.clear();
    let stand_of = |(entity, transform, forest): (Entity, &GlobalTransform, &ForestCells)| {
        let stand = forest.stand.get()?.own.clone();
        Some((entity, stand, transform.translation().xz().as_dvec2()))
    };
    known.extend(forests.iter().filter_map(stand_of));
    for (entity, transform, mut forest) in &mut forests {
        let Some(stands) = forest.stand.get() else { continue };
        let at = transform.translation().xz().as_dvec2();
        let others = || {
            let others = known.iter().filter(|(other, ..)| *other != entity);
            others.map(|(_, stand, origin)| OtherStand { stand: stand.clone(), offset_m: at - *origin })
        };
        // All of these are known but its own.
        let is_as_before =
            stands.others.len() + 1 == known.len() && stands.others.iter().zip(others()).all(|(a, b)| a.is_as(&b));
        if !is_as_before {
            let others = others().collect();
            forest.bypass_change_detection().stand.set_others(others);
        }
    }
    known.clear();
}
