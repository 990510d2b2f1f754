//! Motion: the tables that join wind, dynamics and trees, and trees whose parts are entities that follow the wind.
//!
//! - `response` turns a wind field into tables, once per wind, off the frame.
//! - `active` fades from the tables of one wind to those of the next.
//! - `components` tells in what stand a tree stands ([`InCanopy`]).
//! - `articulated` poses the trees that ask for it on the CPU.
//! - `live` moves trees that a game touches: by winds of its own, bodies and blows.
//! - `stands` has what all of these know of a tree's place.
//!
//! How the same tables move every tree on the GPU is in `render`.

mod active;
mod articulated;
mod components;
mod live;
mod plugin;
mod response;
mod stands;

pub use active::{ActiveSway, FLUTTER_PERIOD_S, WeightedResponse, leaf_clock_s, wrapped_time_s};
pub use articulated::TreePose;
pub use components::InCanopy;
pub use live::{LiveSettings, LiveSway, Pusher, PusherShape, Pushers, TreeImpulse};
pub use plugin::SwayPlugin;
pub use response::{SwaySettings, WindResponse};
pub(crate) use stands::{uniform_scale, world_from_local};
