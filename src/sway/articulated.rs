//! Trees that are posed on the CPU: those whose beams and leaves are entities that follow the wind, and those that a body pushes.

use super::{
    active::{ActiveSway, FLUTTER_PERIOD_S, WeightedResponse, leaf_clock_s},
    components::InCanopy,
    live::LiveSway,
    stands::{stands_at, uniform_scale, wind_at_tree, world_from_local},
};
use crate::{
    dynamics::{
        RestingLeaf,
        beam_pose::BeamPose,
        pose::{TreeInWind, TreePoser},
        stand_wind::{StandWind, WindAtTree},
    },
    tree::{
        Articulated, Beam, BeamOf, Grown, Leaf, LeafOf, Season, SpeciesModels, Tree, TreeBeams, TreeLeaves, TreeModel,
    },
    wind::{Canopy, WindClock},
};
use bevy::{math::Vec3A, prelude::*};

/// The pose of a tree this frame, beam by beam, in the order of its skeleton: of one that is articulated, or that a body pushes.
#[derive(Component, Default)]
pub struct TreePose {
    beams: Vec<BeamPose>,
    /// Wind at the tree in tree-local axes.
    wind: WindAtTree,
    /// One for each wind that blows: two while one fades into another.
    posers: [TreePoser; 2],
    /// The same wind at the tree, for its leaves.
    stands: [Option<StandWind>; 2],
    /// What the posers were made for.
    made_for: Option<(u64, AssetId<TreeModel>, GlobalTransform, f32, Canopy)>,
    free_angles: Vec<Vec3A>,
    responses: Vec<Vec4>,
}

impl TreePose {
    /// One pose a beam, tree-local.
    pub fn beams(&self) -> &[BeamPose] {
        &self.beams
    }
}

/// Gives trees that ask for it entities for their beams and leaves, anew when the model has changed.
pub(super) fn articulate_trees(
    mut commands: Commands,
    models: Res<Assets<TreeModel>>,
    trees: Query<(Entity, &Articulated, &Grown), Or<(Changed<Articulated>, Changed<Grown>)>>,
    mut retired: RemovedComponents<Articulated>,
) {
    for entity in retired.read() {
        if let Ok(mut tree) = commands.get_entity(entity) {
            tree.despawn_related::<TreeBeams>().despawn_related::<TreeLeaves>().remove::<TreePose>();
        }
    }
    for (entity, articulated, grown) in &trees {
        let Some(model) = models.get(&grown.model) else { continue };
        let mut tree = commands.entity(entity);
        tree.despawn_related::<TreeBeams>().despawn_related::<TreeLeaves>().insert(TreePose::default());
        for (index, beam) in (0..).zip(&model.skeleton.beams) {
            if beam.order <= articulated.deepest_order {
                commands.spawn((Beam { index, at: 1.0 }, BeamOf(entity)));
            }
        }
        if articulated.leaves {
            commands.spawn_batch(
                (0..model.skeleton.clusters.len() as u32)
                    .map(move |index| (Leaf { index }, LeafOf(entity)))
                    .collect::<Vec<_>>(),
            );
        }
    }
}

/// Poses every such tree, tree by tree in parallel.
pub(super) fn pose_trees(
    sway: Res<ActiveSway>,
    clock: Res<WindClock>,
    season: Res<Season>,
    models: Res<Assets<TreeModel>>,
    mut trees: Query<(
        (&Tree, &Grown, Option<&InCanopy>),
        (&Transform, &GlobalTransform, Has<ChildOf>),
        Option<&LiveSway>,
        &mut TreePose,
    )>,
) {
    trees.par_iter_mut().for_each(|((of, grown, canopy), (transform, global, is_child), live, mut tree)| {
        let Some(model) = models.get(&grown.model) else { return };
        let stands = stands_at(transform, global, is_child);
        let leaf_share = model.leaf_season.share(season.wrapped() + of.season_shift());
        let canopy = canopy.copied().unwrap_or_default().0;
        tree.refresh(&sway, grown.model.id(), model, stands, leaf_share, canopy);
        tree.follow(&sway, clock.time_s, model.height_m(), stands, live);
    });
}

impl TreePose {
    /// Looks the load coefficients up again when the wind, the model, the tree's place or its share of leaves is another.
    fn refresh(
        &mut self,
        sway: &ActiveSway,
        id: AssetId<TreeModel>,
        model: &TreeModel,
        stands: GlobalTransform,
        leaf_share: f32,
        canopy: Canopy,
    ) {
        let key = (sway.generation(), id, stands, leaf_share, canopy);
        if self.made_for == Some(key) {
            return;
        }
        self.beams.resize(model.beams.len(), BeamPose::REST);
        let winds = self.posers.iter_mut().zip(&mut self.stands).zip(sway.now());
        for ((poser, stand), WeightedResponse { response, .. }) in winds {
            let to_wind = response.field.frame().wind_from_world() * world_from_local(&stands);
            let scale = uniform_scale(&stands);
            let (map, wind) = (response.basis.map(), response.beam_wind_in(&canopy));
            *stand = Some(wind.stand);
            poser.prepare(&model.beams, &TreeInWind { map, wind, to_wind, scale, leaf_share });
        }
        self.made_for = Some(key);
    }

    fn follow(
        &mut self,
        sway: &ActiveSway,
        time_s: f64,
        height_m: f32,
        stands: GlobalTransform,
        live: Option<&LiveSway>,
    ) {
        let local_from_world = world_from_local(&stands).transpose();
        let height_m = height_m * uniform_scale(&stands);
        self.wind = WindAtTree::default();
        self.free_angles.clear();
        self.free_angles.resize(self.beams.len(), Vec3A::ZERO);
        let winds = self.posers.iter().zip(&self.stands).zip(sway.now());
        for ((poser, stand), WeightedResponse { response, weight }) in winds {
            let place = response.place(stands.translation(), time_s);
            response.table.responses(&place, poser.rows(), &mut self.responses);
            poser.add_free_angles(&self.responses, weight, &mut self.free_angles);
            let Some(stand) = stand else { continue };
            let wind = wind_at_tree(response, stand, &place, height_m);
            self.wind.high += weight * (local_from_world * wind.high);
            self.wind.low += weight * (local_from_world * wind.low);
        }
        if let Some(live) = live {
            self.free_angles.iter_mut().zip(live.angles()).for_each(|(free, added)| *free += added);
            self.wind.high += live.wind().high;
            self.wind.low += live.wind().low;
        }
        self.posers[0].pose_free(&self.free_angles, self.wind.high, &mut self.beams);
    }
}

/// Moves beam entities to where their cross-sections are.
pub(super) fn pose_beams(
    models: Res<Assets<TreeModel>>,
    trees: Query<(&Grown, &Transform, &GlobalTransform, Has<ChildOf>, &TreePose), (Without<Beam>, Without<Leaf>)>,
    mut beams: Query<(&Beam, &BeamOf, &mut Transform), Without<Leaf>>,
) {
    beams.par_iter_mut().for_each(|(beam, of, mut transform)| {
        let Ok((grown, tree_transform, global, is_child, tree)) = trees.get(of.0) else { return };
        let Some(model) = models.get(&grown.model) else { return };
        let index = beam.index as usize;
        let (Some(rest), Some(pose)) = (model.beams.get(index), tree.beams.get(index)) else { return };
        let stands = if is_child { global.compute_transform() } else { *tree_transform };
        let s = if beam.at.is_finite() { beam.at.clamp(0.0, 1.0) } else { 1.0 };
        let path = model.skeleton.beams[index].path(s);
        let (position, rotation) = pose.carry(rest, s, path);
        let upright = Quat::from_rotation_arc(Vec3::Y, rest.direction);
        *transform = stands * Transform::from_translation(position).with_rotation(rotation * upright);
    });
}

/// Moves leaf entities to their anchors and turns them into the wind.
pub(super) fn turn_leaves(
    species_models: Res<SpeciesModels>,
    clock: Res<WindClock>,
    models: Res<Assets<TreeModel>>,
    trees: Query<
        (&Tree, &Grown, &Transform, &GlobalTransform, Has<ChildOf>, &TreePose),
        (Without<Leaf>, Without<Beam>),
    >,
    mut leaves: Query<(&Leaf, &LeafOf, &mut Transform)>,
) {
    let seconds = leaf_clock_s(clock.time_s);
    leaves.par_iter_mut().for_each(|(leaf, of, mut transform)| {
        let Ok((tree, grown, tree_transform, global, is_child, pose)) = trees.get(of.0) else { return };
        let (Some(species), Some(model)) = (species_models.get(tree.species.id()), models.get(&grown.model)) else {
            return;
        };
        let Some(cluster) = model.skeleton.clusters.get(leaf.index as usize) else { return };
        let beam = cluster.beam as usize;
        let (Some(rest), Some(beam_pose)) = (model.beams.get(beam), pose.beams.get(beam)) else { return };
        let stands = if is_child { global.compute_transform() } else { *tree_transform };
        let (anchor, carried) = beam_pose.carry(rest, cluster.at, cluster.anchor);
        let leaf = RestingLeaf { axis: cluster.axis, phase: cluster.phase };
        let response = &species.species.foliage.response;
        let wind = pose.wind.at(anchor.y / model.height_m());
        let rotation = response.rotation(&leaf, carried, wind, seconds, FLUTTER_PERIOD_S as f32);
        let upright = Quat::from_rotation_arc(Vec3::Y, cluster.axis);
        *transform = stands * Transform::from_translation(anchor).with_rotation(rotation * upright);
    });
}
