//! Trees that fall: hinged at the cut, by their own weight and against the drag of their crown, until they rest on the ground.
//!
//! - [`FallingTree`] on any tree lets it fall; a forest gives it to near trees that are felled.
//! - `fall` is the motion, `resting` tells at which angle the ground ends it. Both are plain arithmetic.
//! - `fell_trees` begins the falls and moves the trees; `stumps` draws what stays.

mod components;
mod fall;
mod fell_trees;
mod resting;
#[cfg(feature = "render")]
mod stumps;

pub use components::{FallenTree, FallingTree, Stump};
pub(super) use fell_trees::{advance_falls, begin_falls};
#[cfg(feature = "render")]
pub(super) use stumps::draw_stumps;
