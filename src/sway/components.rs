//! What a tree's wind depends on beside its place.

use crate::wind::Canopy;
use bevy::prelude::*;

/// The stand in which a tree stands: the wind is weaker between other trees, and gustier. The trees of a
/// [`Forest`](crate::forest::Forest) are given theirs; a tree without stands in the open. Give it to trees of your own that stand
/// close together.
#[derive(Component, Reflect, Clone, Copy, Debug, Default, PartialEq)]
#[reflect(Component, Default)]
pub struct InCanopy(pub Canopy);
