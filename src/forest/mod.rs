//! Forests as entities: a plan becomes trees about every [`Viewpoint`](crate::Viewpoint), cell by cell.
//!
//! - [`Forest`] stands on a [`Terrain`](crate::terrain::Terrain), on ground of your own ([`ForestGround`]), or on the level.
//! - `begin` makes a forest's plan ready, when it is new or has changed.
//! - `cells` plants the forest's voxel grid ([`CellStore`](crate::cells::CellStore)) in the background, as far as trees are
//!   drawn at all, one `planted_tile` after another (`known_tiles`); what nobody is near to goes again. Ask [`ForestCells::store`] who stands where. Near
//!   trees and impostors take the plants of a tile when it comes.
//! - `near` and `stream_trees` spawn the plants of near cells as [`Tree`](crate::tree::Tree)s, a few a frame. What stands where follows from
//!   the plan alone, in whatever order cells come. When the plan changes, trees that both plans have stay.
//! - What a game changes is in [`ForestChanges`], by [`StemId`]. `change_index` has the changes by place, `cell_planter` plants cells after
//!   them, `apply_changes` and `changed_cells` take them over: near trees at once (`near_changes`), the rest when its tile has been planted
//!   again. [`ForestEditor`] refuses what cannot be; `stems` tells which stem stands where, `messages` what becomes of trees.
//! - `falling` lets trees fall. `renew_stands` has the wind among the trees follow what was felled and planted (`stand_changes`).
//! - `near_services` gives cells a wind of their own and the nearest trees beams and leaves as entities, where that is asked for.
//! - `stand` knows how high and dense a forest's trees about a place are; `stand_species` makes it ready, `forest_stand` knows what of it is
//!   due to be worked out again. `stands` has those of all forests (`share_stands`), and how open a place is to each side, for the wind and
//!   the light there; `cell_canopies` works that out for a cell, `give_canopies` gives it to near trees.
//! - `missing_species` tells which species of a plan cannot be loaded.
//! - With the feature `render`, `impostors` draws the trees beyond, a tile of cells at a time, which `cells_for_impostors` gives it;
//!   `tree_impostors` tells near trees of theirs.
//! - With it, too, `cull` hides near cells out of view, `layers` gives trees and impostors the render layers of their forest, and `diagnose`
//!   tells how the forest does.
//! - [`PlanCover`] tells the ground where the woods are, so that they are seen beyond the last tree.

mod apply_changes;
mod begin;
mod cell_canopies;
mod cell_planter;
mod cells;
#[cfg(feature = "render")]
mod cells_for_impostors;
mod change_index;
mod changed_cells;
mod changes;
mod components;
mod cover;
#[cfg(feature = "render")]
mod cull;
#[cfg(feature = "render")]
mod diagnose;
mod editor;
mod extent;
mod falling;
mod forest_stand;
mod give_canopies;
#[cfg(feature = "render")]
mod impostors;
mod journal;
mod known_tiles;
#[cfg(feature = "render")]
mod layers;
mod messages;
mod missing_species;
mod near;
mod near_cell;
mod near_changes;
mod near_services;
mod planted_tile;
mod plugin;
mod reach;
mod renew_stands;
mod share_stands;
mod stand;
mod stand_changes;
mod stand_species;
mod stands;
mod stem_id;
mod stems;
mod stream_trees;
#[cfg(feature = "render")]
mod tree_impostors;

pub use cells::ForestCells;
pub use changes::{ForestChanges, NewStem};
pub use components::{Forest, ForestCell, ForestGround, ForestSettings};
pub use cover::{PlanCover, StandingGround};
pub use editor::ForestEditor;
pub use falling::{FallenTree, FallingTree, Stump};
pub use messages::{TreeEntered, TreeFelled, TreeLeft};
pub use plugin::ForestPlugin;
pub use stem_id::StemId;
pub use stems::StandingStem;
#[cfg(feature = "render")]
pub use {
    cull::ForestCulling,
    diagnose::{ForestDiagnosticsPlugin, ForestGizmos},
    impostors::{ForestImpostors, ForestRenderPlugin},
};
