//! Begins the falls of trees, and moves those that fall.

use super::{
    components::{FallInProgress, FallenTree, FallingTree, Stump},
    fall::{Fall, FallingBody},
    resting::resting_rad,
};
use crate::{
    forest::{cells::ForestCells, cover::StandingGround},
    ground::{Ground, LevelGround},
    sway::InCanopy,
    terrain::{Terrain, TerrainSettings},
    tree::{Grown, Season, SpeciesModels, Tree, TreeModel, skeleton::Skeleton, tree_pieces},
    wind::{Canopy, EXPOSURE_DIRECTIONS},
};
use bevy::{ecs::system::SystemParam, math::DVec2, prelude::*};
use std::sync::Arc;

/// With this speed a fall begins, rad/s: what wedges push a tree out of its balance by.
const FIRST_SPEED_RAD_S: f64 = 0.03;
/// A tree on the ground is out of the wind: as in a stand so high, m, and so dense, into which no wind blows.
const SHELTER: Canopy = Canopy { height_m: 127.5, frontal_area_index: 5.0, exposure: [0.0; EXPOSURE_DIRECTIONS] };

/// The ground that falling trees come to rest on.
#[derive(SystemParam)]
pub(in crate::forest) struct GroundOfTrees<'w, 's> {
    parents: Query<'w, 's, &'static ChildOf>,
    forests: Query<'w, 's, &'static ForestCells>,
    terrains: Query<'w, 's, (&'static Terrain, &'static TerrainSettings)>,
}

impl GroundOfTrees<'_, '_> {
    /// The ground under a tree whose foot is so high, m.
    fn of(&self, tree: Entity, foot_m: f32) -> Arc<dyn Ground> {
        if let Some(forest) = self.parents.iter_ancestors(tree).find_map(|parent| self.forests.get(parent).ok()) {
            return forest.ground.clone();
        }
        match self.terrains.iter().next() {
            Some((terrain, settings)) => Arc::new(StandingGround::new(terrain.ground.clone(), settings.finest_cell_m)),
            None => Arc::new(LevelGround(f64::from(foot_m))),
        }
    }
}

/// Begins the falls of trees that have a model.
pub(in crate::forest) fn begin_falls(
    mut commands: Commands,
    models: Res<Assets<TreeModel>>,
    species: Res<SpeciesModels>,
    season: Res<Season>,
    grounds: GroundOfTrees,
    trees: Query<(Entity, &FallingTree, &Tree, &Grown, &Transform, Option<&ChildOf>), Without<FallInProgress>>,
) {
    for (entity, falling, tree, grown, at, parent) in &trees {
        let (Some(model), Some(baked)) = (models.get(&grown.model), species.get(tree.species.id())) else { continue };
        let scale = f64::from(at.scale.y);
        let height_m = f64::from(model.height_m()) * scale;
        // What is no number is 0.
        let cut_m = f64::from(falling.cut_m.max(0.0)).min(0.5 * height_m);
        let year = Season { year: season.year + tree.season_shift() }.wrapped();
        let leaf_share = f64::from(model.leaf_season.share(year));
        let pieces = || tree_pieces(&baked.species, &model.skeleton);
        let body = FallingBody::of(pieces(), cut_m / scale, leaf_share).scaled(scale);

        let towards = falling.direction.and_then(Vec2::try_normalize);
        let towards =
            towards.unwrap_or_else(|| heavy_side(pieces().map(|piece| (at.rotation * piece.at, piece.mass_kg))));
        let hinge = at.translation + Vec3::Y * cut_m as f32;
        let radius_m = f64::from(radius_at(&model.skeleton, (cut_m / scale) as f32)) * scale;
        let ground = grounds.of(entity, at.translation.y);
        let rise_m = |away_m: f64| {
            let place = DVec2::new(f64::from(hinge.x), f64::from(hinge.z)) + towards.as_dvec2() * away_m;
            ground.height_m(place) - f64::from(hinge.y)
        };
        let progress = FallInProgress {
            body,
            fall: Fall { angle_rad: 0.0, speed_rad_s: FIRST_SPEED_RAD_S },
            // Where it hinges the stem's axis is no higher above the ground than the cut.
            resting_rad: resting_rad(height_m - cut_m, radius_m.min(cut_m), rise_m),
            upright: *at,
            hinge,
            axis: Vec3::Y.cross(Vec3::new(towards.x, 0.0, towards.y)),
        };
        commands.entity(entity).insert(progress);
        let stump = Stump { radius_m: radius_m as f32, height_m: cut_m as f32 };
        let mut stump = commands.spawn((stump, Transform::from_translation(at.translation)));
        if let Some(parent) = parent {
            stump.insert(ChildOf(parent.parent()));
        }
    }
}

/// The direction (x, z) of the centre of mass.
fn heavy_side(masses: impl Iterator<Item = (Vec3, f64)>) -> Vec2 {
    let moment = masses.fold(DVec2::ZERO, |sum, (at, mass_kg)| sum + mass_kg * at.xz().as_dvec2());
    moment.as_vec2().try_normalize().unwrap_or(Vec2::X)
}

/// Radius of the stem at a height above its foot, m.
fn radius_at(skeleton: &Skeleton, height_m: f32) -> f32 {
    let at_height = skeleton.beams.iter().rfind(|beam| beam.order == 0 && beam.base.y <= height_m);
    let at_height = at_height.or(skeleton.beams.first());
    at_height.map_or(0.1, |beam| beam.radius_m(((height_m - beam.base.y) / beam.length_m.max(1e-3)).clamp(0.0, 1.0)))
}

/// Moves trees that fall, and lays down those that touch the ground.
pub(in crate::forest) fn advance_falls(
    mut commands: Commands,
    time: Res<Time>,
    mut trees: Query<(Entity, &mut FallInProgress, &mut Transform)>,
) {
    for (entity, mut progress, mut at) in &mut trees {
        let FallInProgress { body, resting_rad, .. } = *progress;
        progress.fall.advance(&body, f64::from(time.delta_secs()));
        let is_down = progress.fall.angle_rad >= resting_rad;
        if is_down {
            progress.fall = Fall { angle_rad: resting_rad, speed_rad_s: 0.0 };
        }
        *at = progress.place();
        if is_down {
            commands.entity(entity).remove::<(FallInProgress, FallingTree)>().insert((FallenTree, InCanopy(SHELTER)));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_heavy_side_is_that_of_the_centre_of_mass() {
        let masses =
            [(Vec3::new(0.0, 9.0, 0.0), 500.0), (Vec3::new(3.0, 8.0, 0.0), 20.0), (Vec3::new(0.0, 8.0, -4.0), 15.0)];
        assert!(heavy_side(masses.into_iter()).distance(Vec2::new(1.0, -1.0).normalize()) < 1e-6);
        assert_eq!(heavy_side(masses.into_iter().take(1)), Vec2::X, "an upright pole falls somewhere");
    }
}
