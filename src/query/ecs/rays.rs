//! Rays against trees, as they are posed in the wind.

use crate::{
    dynamics::{beam_pose::BeamPose, pose::TreeInWind},
    query::passage::{LocalRay, Passed, depth_until},
    sway::{ActiveSway, InCanopy, TreePose, WeightedResponse, uniform_scale, world_from_local},
    tree::{
        Grown, Season, Tree, TreeModel, TreePlaces,
        body::{PosedBody, TreeCapsule},
    },
    wind::WindClock,
};
use bevy::{
    ecs::{entity::EntityHashMap, system::SystemParam},
    math::Vec3A,
    prelude::*,
};
use std::sync::{Arc, Mutex, PoisonError};

/// The bodies of trees that rays have come near to in this frame.
#[derive(Resource, Default)]
pub(in crate::query) struct PosedTrees {
    posed: Mutex<EntityHashMap<Arc<PosedBody>>>,
}

/// Another moment, other poses.
pub(in crate::query) fn forget_poses(mut posed: ResMut<PosedTrees>) {
    posed.bypass_change_detection().posed.get_mut().unwrap_or_else(PoisonError::into_inner).clear();
}

type TreeData =
    (&'static Tree, &'static Grown, &'static GlobalTransform, Option<&'static InCanopy>, Option<&'static TreePose>);

/// Asks what rays meet: trunks and limbs where they are in the wind now, and how much leaves and twigs let through.
///
/// It knows the trees that are entities, where transforms were propagated last. For stems farther away ask
/// [`ForestCells::store`](crate::forest::ForestCells::store). A tree is posed once in a frame, when the first ray comes near: that
/// costs more than all rays through it.
#[derive(SystemParam)]
pub struct TreeRays<'w, 's> {
    places: Res<'w, TreePlaces>,
    posed: Res<'w, PosedTrees>,
    sway: Res<'w, ActiveSway>,
    clock: Res<'w, WindClock>,
    season: Res<'w, Season>,
    models: Res<'w, Assets<TreeModel>>,
    trees: Query<'w, 's, TreeData>,
}

/// Where a ray hits wood.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TreeHit {
    /// The tree.
    pub tree: Entity,
    /// Number of the beam in its model's skeleton, as in [`Beam::index`](crate::tree::Beam::index).
    pub beam: u32,
    /// Where on the beam, from 0 at its root to 1 at its tip.
    pub at: f32,
    /// From the ray's origin, m; 0 where it begins in wood.
    pub distance_m: f32,
    /// Where, m in the world.
    pub position: Vec3,
    /// Unit normal of the wood.
    pub normal: Vec3,
}

/// Where leaves and twigs have stopped one half of a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CrownHit {
    /// The tree whose leaves they are.
    pub tree: Entity,
    /// From the ray's origin, m.
    pub distance_m: f32,
    /// Where, m in the world.
    pub position: Vec3,
}

/// What a ray meets on its way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TreeTrace {
    /// The first wood, at which it ends.
    pub wood: Option<TreeHit>,
    /// Share of the ray that leaves and twigs let through before that, 0 to 1.
    pub transmittance: f32,
    /// Where they have stopped half of it.
    pub half: Option<CrownHit>,
}

impl TreeTrace {
    /// How much of the ray comes through, 0 to 1: nothing where there is wood in its way.
    #[must_use]
    pub fn clear_share(&self) -> f32 {
        if self.wood.is_some() { 0.0 } else { self.transmittance }
    }
}

impl TreeRays<'_, '_> {
    /// What a ray meets within a length, m.
    #[must_use]
    pub fn trace(&self, origin: Vec3, direction: Dir3, longest_m: f32) -> TreeTrace {
        self.trace_those(origin, direction, longest_m, |_| true)
    }

    /// The same, of the trees that a filter lets count.
    #[must_use]
    pub fn trace_those(
        &self,
        origin: Vec3,
        direction: Dir3,
        longest_m: f32,
        counts: impl Fn(Entity) -> bool,
    ) -> TreeTrace {
        let mut passed: Vec<Passed<Entity>> = Vec::new();
        let wood = self.meet(origin, direction, longest_m, counts, |tree, near| {
            let leaf_share = self.leaf_share(near);
            near.model.body.pass_crown(near.posed, &near.local.ray, leaf_share, |step| {
                let [from_m, to_m] = step.part_m.map(|part_m| near.local.begins_m + near.local.scale * part_m);
                passed.push((from_m, to_m, step.depth, tree));
            });
        });
        let end_m = wood.map_or(longest_m, |wood| wood.distance_m);
        let (depth, half) = depth_until(passed, end_m);
        let half =
            half.map(|(distance_m, tree)| CrownHit { tree, distance_m, position: origin + distance_m * *direction });
        TreeTrace { wood, transmittance: (-depth).exp(), half }
    }

    /// The first wood on a ray within a length, m.
    #[must_use]
    pub fn first_wood(&self, origin: Vec3, direction: Dir3, longest_m: f32) -> Option<TreeHit> {
        self.meet(origin, direction, longest_m, |_| true, |_, _| {})
    }

    /// How much of a line of sight is clear, 0 to 1: 0 where there is wood in its way.
    #[must_use]
    pub fn sight(&self, from: Vec3, to: Vec3) -> f32 {
        let Ok((direction, length_m)) = Dir3::new_and_length(to - from) else { return 1.0 };
        self.trace(from, direction, length_m).clear_share()
    }

    /// Trunk and limbs of a tree that are as thick as this at their roots, m, as capsules in the world, where they are in the wind now.
    #[must_use]
    pub fn capsules(&self, tree: Entity, least_radius_m: f32) -> Vec<TreeCapsule> {
        let Ok(data) = self.trees.get(tree) else { return Vec::new() };
        let Some(model) = self.models.get(&data.1.model) else { return Vec::new() };
        let (at, scale) = (data.2, uniform_scale(data.2));
        let capsules = model.body.capsules(&self.posed(tree, model), least_radius_m / scale);
        let in_world = |TreeCapsule { a, b, radius_m, beam }| TreeCapsule {
            a: at.transform_point(a),
            b: at.transform_point(b),
            radius_m: radius_m * scale,
            beam,
        };
        capsules.into_iter().map(in_world).collect()
    }

    /// Walks along a ray up to the first wood. `pass` is told of every tree that it comes near to, and of some beyond the wood.
    fn meet(
        &self,
        origin: Vec3,
        direction: Dir3,
        longest_m: f32,
        counts: impl Fn(Entity) -> bool,
        mut pass: impl FnMut(Entity, &NearTree),
    ) -> Option<TreeHit> {
        let longest_m = if longest_m > 0.0 { longest_m } else { 0.0 };
        let mut first: Option<TreeHit> = None;
        self.places.along(origin, *direction, longest_m, |tree, met_m| {
            let end_m = first.map_or(longest_m, |hit| hit.distance_m);
            if met_m > end_m {
                return false;
            }
            let Ok((of, grown, at, _, pose)) = self.trees.get(tree) else { return true };
            let Some(model) = self.models.get(&grown.model).filter(|_| counts(tree)) else { return true };
            let bounds = if pose.is_some() { model.bounds } else { model.bounds_under(self.pressure()) };
            let Some(local) = LocalRay::new(at.affine(), origin, *direction, end_m, [bounds.min, bounds.max]) else {
                return true;
            };
            let posed = self.posed(tree, model);
            if let Some(hit) = model.body.hit(&posed, &local.ray) {
                let distance_m = local.begins_m + local.scale * hit.distance_m;
                if distance_m <= end_m {
                    let normal = local.world_from_local.transform_vector3(hit.normal).normalize_or(-*direction);
                    let position = origin + distance_m * *direction;
                    first = Some(TreeHit { tree, beam: hit.beam, at: hit.at, distance_m, position, normal });
                }
            }
            pass(tree, &NearTree { of, model, posed: &posed, local });
            true
        });
        first
    }

    /// No beam of a tree that follows the tables is pressed harder, m²/s².
    fn pressure(&self) -> f32 {
        self.sway.now().map(|wind| wind.response.strongest_pressure).fold(0.0, f32::max)
    }

    fn leaf_share(&self, near: &NearTree) -> f32 {
        near.model.leaf_season.share(self.season.wrapped() + near.of.season_shift())
    }

    /// The body of a tree in its pose of this frame.
    fn posed(&self, tree: Entity, model: &TreeModel) -> Arc<PosedBody> {
        let known = |posed: &Mutex<EntityHashMap<Arc<PosedBody>>>| {
            posed.lock().unwrap_or_else(PoisonError::into_inner).get(&tree).cloned()
        };
        if let Some(posed) = known(&self.posed.posed) {
            return posed;
        }
        let posed = Arc::new(self.pose(tree, model));
        self.posed.posed.lock().unwrap_or_else(PoisonError::into_inner).insert(tree, posed.clone());
        posed
    }

    fn pose(&self, tree: Entity, model: &TreeModel) -> PosedBody {
        let Ok((of, _, at, canopy, pose)) = self.trees.get(tree) else { return model.body.at_rest() };
        if let Some(pose) = pose.filter(|pose| !pose.beams().is_empty()) {
            return model.body.posed_by_all(pose.beams());
        }
        let leaf_share = model.leaf_season.share(self.season.wrapped() + of.season_shift());
        let canopy = canopy.copied().unwrap_or_default().0;
        let limbs = model.body.limbs.beams().len();
        let height_m = model.height_m() * uniform_scale(at);
        let mut blowing = Vec3::ZERO;
        let (mut free, mut poses) = (vec![Vec3A::ZERO; limbs], vec![BeamPose::REST; limbs]);
        let (mut responses, mut last_poser) = (Vec::new(), None);
        for WeightedResponse { response, weight } in self.sway.now() {
            let to_wind = response.field.frame().wind_from_world() * world_from_local(at);
            let (map, wind) = (response.basis.map(), response.beam_wind_in(&canopy));
            let stand = wind.stand;
            let poser = model.body.poser(&TreeInWind { map, wind, to_wind, scale: uniform_scale(at), leaf_share });
            let place = response.place(at.translation(), self.clock.time_s);
            response.table.responses(&place, poser.rows(), &mut responses);
            poser.add_free_angles(&responses, weight, &mut free);
            blowing += weight * (world_from_local(at).transpose() * response.wind_at(&stand, &place, height_m));
            last_poser = Some(poser);
        }
        // What beams do with their angles does not depend on the wind of which a poser was made.
        if let Some(poser) = last_poser {
            poser.pose_free(&free, blowing, &mut poses);
        }
        model.body.posed(&poses)
    }
}

/// A tree that a ray comes near to.
struct NearTree<'a> {
    of: &'a Tree,
    model: &'a TreeModel,
    posed: &'a PosedBody,
    local: LocalRay,
}
