//! The components of falling trees.

use super::fall::{Fall, FallingBody};
use bevy::prelude::*;

/// Lets a [`Tree`](crate::tree::Tree) fall, once it has its model. It hinges at its cut and falls by its own weight, braked by the drag of
/// its crown, until it lies on the ground: then it is a [`FallenTree`]. What stays is a [`Stump`], beside the tree under the same parent.
///
/// The ground is that of its forest, else the world's [`Terrain`](crate::terrain::Terrain), else level. A tree falls in virtual time: it
/// stops where that is paused.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Component, Default)]
pub struct FallingTree {
    /// Where to (x, z), in the frame of its parent; of any length but zero. `None` lets it fall to its heavy side. Later changes have no
    /// effect.
    pub direction: Option<Vec2>,
    /// Height of the cut above its foot. units: m, clamped to 0 to half of the tree's height.
    pub cut_m: f32,
}

impl Default for FallingTree {
    fn default() -> Self {
        Self { direction: None, cut_m: 0.3 }
    }
}

/// A tree that has fallen: a log on the ground, with its crown. It stays until it is despawned; one of a forest goes with its cell.
#[derive(Component, Reflect, Clone, Copy, Debug, Default, PartialEq, Eq)]
#[reflect(Component, Default)]
pub struct FallenTree;

/// What stays of a tree where it was cut: a cylinder on the ground.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Component)]
#[require(Transform, Visibility)]
pub struct Stump {
    /// units: m.
    pub radius_m: f32,
    /// units: m.
    pub height_m: f32,
}

/// A fall that has begun.
#[derive(Component, Clone, Copy, Debug)]
pub(in crate::forest) struct FallInProgress {
    pub body: FallingBody,
    pub fall: Fall,
    /// At this angle from upright it rests, rad.
    pub resting_rad: f64,
    /// The tree as it stood, and where it hinges, in the frame of its parent.
    pub upright: Transform,
    pub hinge: Vec3,
    /// Unit axis of the fall.
    pub axis: Vec3,
}

impl FallInProgress {
    /// Where the tree is now.
    pub fn place(&self) -> Transform {
        let turn = Quat::from_axis_angle(self.axis, self.fall.angle_rad as f32);
        Transform {
            translation: self.hinge + turn * (self.upright.translation - self.hinge),
            rotation: turn * self.upright.rotation,
            scale: self.upright.scale,
        }
    }
}
