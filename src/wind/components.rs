//! Entities that are given the wind at their place.

use super::ecs::{active::ActiveWind, clock::WindClock, sources::WindSources};
use bevy::prelude::*;

/// Samples the wind: each frame `velocity` is the wind at this entity's place.
///
/// Give it to whatever the wind should move, or be heard at: a sail, smoke, an audio emitter.
#[derive(Component, Reflect, Clone, Copy, Debug, Default, PartialEq)]
#[reflect(Component, Default)]
#[require(Transform)]
pub struct WindCell {
    /// World height of the ground below, m. The wind grows with the height above it.
    pub ground_m: f32,
    /// The wind here, m/s in world axes: mean, turbulence and what [`WindSource`](super::WindSource)s blow. Written in
    /// [`WindwoodSystems::AdvanceWind`](crate::schedule::WindwoodSystems::AdvanceWind).
    pub velocity: Vec3,
}

impl WindCell {
    /// A cell over ground at world height `ground_m`.
    pub fn above(ground_m: f32) -> Self {
        Self { ground_m, velocity: Vec3::ZERO }
    }
}

/// Samples the wind for every cell.
///
/// An entity without a parent is where its `Transform` says. For a child the best that is known is the place of the last
/// propagation.
pub(super) fn sample_wind_cells(
    wind: Res<ActiveWind>,
    sources: Res<WindSources>,
    clock: Res<WindClock>,
    mut cells: Query<(&mut WindCell, &Transform, Option<&GlobalTransform>, Has<ChildOf>)>,
) {
    cells.par_iter_mut().for_each(|(mut cell, transform, global, is_child)| {
        let place = match (is_child, global) {
            (true, Some(global)) => global.translation(),
            _ => transform.translation,
        };
        let above_ground = place - Vec3::Y * cell.ground_m;
        let velocity = wind.sample(above_ground, clock.time_s) + sources.velocity(place);
        cell.set_if_neq(WindCell { velocity, ..*cell });
    });
}
