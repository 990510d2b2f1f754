//! Blows.

use bevy::prelude::*;

/// A blow on a [`Tree`](crate::tree::Tree): an axe, an arrow, a bird that starts, a car. The beam is struck that passes nearest to the
/// place, with all that bear it. A tree whose model is not there yet does not feel it.
#[derive(Message, Reflect, Clone, Copy, Debug, PartialEq)]
pub struct TreeImpulse {
    /// The tree.
    pub tree: Entity,
    /// Where it is struck, in the world.
    pub place: Vec3,
    /// Mass times change of velocity, in the world's axes, N s. An axe has some 20, a rifle bullet 8, an arrow 3, a starting crow 1.5, a car at
    /// 30 km/h 10,000.
    pub impulse_n_s: Vec3,
}
