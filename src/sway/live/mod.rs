//! Trees that a game touches: winds of its own, bodies that push branches aside, blows.
//!
//! A tree that is touched is given a [`LiveSway`]: oscillators that run beside the table ([`dynamics::live`](crate::dynamics::live)). It
//! loses it once it is still. All other trees have nothing to do with this: in a frame without a cause nothing is looked at, and
//! in one with a cause only the trees of the cells about it.
//!
//! - `settings` ([`LiveSettings`]), `components` ([`LiveSway`]), `pusher` ([`Pusher`]), `impulse` ([`TreeImpulse`]).
//! - `wake` finds the trees that are touched, `step` carries them on, and lets them sleep. [`TreePlaces`](crate::tree::TreePlaces) knows where
//!   trees stand.

mod components;
mod impulse;
mod pusher;
mod settings;
mod step;
mod trail;
mod wake;

pub use components::LiveSway;
pub use impulse::TreeImpulse;
pub use pusher::{Pusher, PusherShape, Pushers};
pub use settings::LiveSettings;

pub(super) use pusher::gather_pushers;
pub(super) use step::{rest_live_trees, step_live_trees};
pub(super) use wake::{has_cause, wake_trees};
