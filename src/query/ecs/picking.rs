//! Trees under pointers: a backend of `bevy_picking`.

use super::rays::TreeRays;
use crate::schedule::WindwoodSystems;
use bevy::{
    picking::{
        Pickable, PickingSystems,
        backend::{HitData, PointerHits, ray::RayMap},
    },
    prelude::*,
};

/// Rays are followed so far, m: trees that are entities are nearer.
const LONGEST_M: f32 = 2000.0;

/// Makes trees pickable: their entities get Bevy's pointer events, where a pointer is on wood, or on leaves that hide more than half of
/// what is behind. [`Pickable::IGNORE`] leaves a tree out.
pub struct TreePickingPlugin;

impl Plugin for TreePickingPlugin {
    fn build(&self, app: &mut App) {
        // A pointer points at what was drawn: trees as they stood in the last frame, before the wind moves on.
        let pick = pick_trees.before(WindwoodSystems::AdvanceWind).in_set(PickingSystems::Backend);
        app.add_systems(PreUpdate, pick.run_if(resource_exists::<RayMap>));
    }
}

fn pick_trees(
    rays: Res<RayMap>,
    trees: TreeRays,
    cameras: Query<&Camera>,
    pickable: Query<&Pickable>,
    hidden: Query<&InheritedVisibility>,
    mut hits: MessageWriter<PointerHits>,
) {
    for (id, ray) in rays.iter() {
        let Ok(camera) = cameras.get(id.camera) else { continue };
        let counts = |tree: Entity| {
            pickable.get(tree).ok().is_none_or(|pickable| pickable.is_hoverable)
                && hidden.get(tree).is_ok_and(|visibility| visibility.get())
        };
        let trace = trees.trace_those(ray.origin, ray.direction, LONGEST_M, counts);
        let on_leaves = trace.half.map(|hit| (hit.tree, hit.distance_m, hit.position, None));
        let on_wood = || trace.wood.map(|hit| (hit.tree, hit.distance_m, hit.position, Some(hit.normal)));
        // Leaves that hide the wood are before it.
        let Some((tree, depth, place, normal)) = on_leaves.or_else(on_wood) else { continue };
        let hit = HitData::new(id.camera, depth, Some(place), normal);
        hits.write(PointerHits::new(id.pointer, vec![(tree, hit)], camera.order as f32));
    }
}
