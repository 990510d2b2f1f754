//! Trees too far to be entities of their own, drawn as impostors: tiles of cells, each one mesh a species, in which a tree is a quad that
//! faces the view, shows the views of its variant and leans in the wind.
//!
//! - `species` has the impostor atlas of each species baked in the background.
//! - `tiles` plants tiles about the viewers and makes their meshes: some 76 bytes a tree.
//! - `near_mask` tells the shader which cells' trees are drawn as entities. The impostors fade there, and only there, so that no tree is
//!   missing while others are still to come.
//!
//! A merged mesh needs no table of trees and no limit on them, and is culled as any mesh is. The alternative, one shared mesh whose slots read
//! 16-byte rows, would save three quarters of the memory and cost a table to be kept in order.

mod near_mask;
mod plugin;
mod species;
mod tiles;

pub use plugin::ForestRenderPlugin;
pub use tiles::ForestImpostors;
