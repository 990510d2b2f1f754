//! What a game asks of trees and wind: what a ray meets, where one runs into wood, what the wind is like, and what is heard of it.
//!
//! | file | what |
//! |---|---|
//! | `passage` | A ray on its way through trees. |
//! | `rustle` | How loud leaves are, and levels that follow. |
//! | `components` | [`WindListener`], [`TreeColliders`], [`TreeColliderSettings`]. |
//! | `ecs/rays` | [`TreeRays`]: rays against trunks, limbs and crowns in their pose of this frame. |
//! | `ecs/canopy_wind` | [`WindInTrees`]: the wind at a place, among the trees about it. |
//! | `ecs/listen`, `ecs/colliders` | They tell listeners, and give colliders about the viewers. |
//! | `ecs/picking` | With the feature `picking`: trees under pointers. |
//! | `ecs/avian` | With the feature `avian`: static bodies. |
//!
//! The bodies that rays meet are in [`tree::body`](crate::tree::body), and who stands where in [`TreePlaces`](crate::tree::TreePlaces).

mod components;
mod ecs;
mod passage;
mod plugin;
mod rustle;

pub use components::{TreeColliderSettings, TreeColliders, WindListener};
#[cfg(feature = "avian")]
pub use ecs::avian::TreeAvianPlugin;
#[cfg(feature = "picking")]
pub use ecs::picking::TreePickingPlugin;
pub use ecs::{
    canopy_wind::{WindAt, WindInTrees},
    rays::{CrownHit, TreeHit, TreeRays, TreeTrace},
};
pub use plugin::TreeQueryPlugin;
