//! Forests as entities: a plan becomes trees about every [`Viewpoint`](crate::Viewpoint), cell by cell.
//!
//! - [`Forest`] stands on a [`Terrain`](crate::terrain::Terrain), on ground of your own ([`ForestGround`]), or on the level.
//! - `stream` plants cells in the background and turns their plants into [`Tree`](crate::tree::Tree)s, a few a frame; cells
//!   that nobody is near to go again. What stands where follows from the plan alone, in whatever order cells come.
//! - With the feature `render`, `far` draws the trees beyond as cards, a block of cells at a time.
//! - [`PlanCover`] tells the ground where the woods are, so that they are seen beyond the last tree.

mod components;
mod cover;
#[cfg(feature = "render")]
mod far;
mod loader;
mod plugin;
mod stream;

pub use components::{Forest, ForestCell, ForestGround, ForestSettings};
pub use cover::{PlanCover, StandingGround};
#[cfg(feature = "render")]
pub use far::{FarBlocks, ForestDrawPlugin};
pub use loader::ForestLoadError;
pub use plugin::ForestPlugin;
pub use stream::ForestCells;
