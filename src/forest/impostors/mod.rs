//! Trees too far to be entities of their own, drawn as impostors: tiles of cells, each one mesh a species, in which a tree is a quad that
//! faces the view, shows the views of its variant and leans in the wind.
//!
//! - `species` has the impostor atlas of each species baked in the background.
//! - `tiles` has meshes made of each tile that is planted, `tile_mesh` makes them: some 76 bytes a tree. Tiles whose plants stay as they are
//!   when the plan changes keep their meshes.
//! - `near_mask` tells the shader which cells' trees are drawn as entities: a bit a cell in each tile. The impostors fade there, and only
//!   there, so that no tree is missing while others are still to come.
//!
//! A merged mesh needs no table of trees and no limit on them, and is culled as any mesh is. The alternative, one shared mesh whose slots read
//! 16-byte rows, would save three quarters of the memory and cost a table to be kept in order.

mod forget;
mod near_mask;
mod plugin;
mod species;
mod tile_canopies;
mod tile_mesh;
mod tiles;

pub use plugin::ForestRenderPlugin;
pub use tiles::ForestImpostors;
