//! Forests as entities: a plan becomes trees about every [`Viewpoint`](crate::Viewpoint), cell by cell.
//!
//! - [`Forest`] stands on a [`Terrain`](crate::terrain::Terrain), on ground of your own ([`ForestGround`]), or on the level.
//! - `cells` plants the forest's voxel grid ([`CellStore`](crate::cells::CellStore)) in the background, as far as trees are
//!   drawn at all; what nobody is near to goes again. Ask [`ForestCells::store`] who stands where.
//! - `near` turns the plants of near cells into [`Tree`](crate::tree::Tree)s, a few a frame. What stands where follows from
//!   the plan alone, in whatever order cells come.
//! - `serve` gives cells a wind of their own and the nearest trees beams and leaves as entities, where that is asked for.
//! - With the feature `render`, `far` draws the trees beyond as cards, a block of cells at a time.
//! - With it, too, `cull` hides near cells out of view, and `diagnose` tells how the forest does.
//! - [`PlanCover`] tells the ground where the woods are, so that they are seen beyond the last tree.

mod cells;
mod components;
mod cover;
#[cfg(feature = "render")]
mod cull;
#[cfg(feature = "render")]
mod diagnose;
mod extent;
#[cfg(feature = "render")]
mod far;
mod loader;
mod near;
mod plugin;
mod serve;

pub use cells::ForestCells;
pub use components::{Forest, ForestCell, ForestGround, ForestSettings};
pub use cover::{PlanCover, StandingGround};
pub use loader::ForestLoadError;
pub use plugin::ForestPlugin;
#[cfg(feature = "render")]
pub use {
    cull::ForestCulling,
    diagnose::{ForestDiagnosticsPlugin, ForestGizmos},
    far::{FarBlocks, ForestDrawPlugin},
};
