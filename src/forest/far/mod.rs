//! Trees too far to be entities of their own: blocks of cells, each drawn as one mesh a species, in which a tree is a card
//! that faces the eye, wears the views of its variant of the species ([`ViewAtlas`](crate::lod::ViewAtlas)) and leans in the
//! wind ([`Lean`](crate::lod::Lean)).
//!
//! - `looks` has each species' views made in the background.
//! - `blocks` plants blocks about the viewers, and makes their meshes (`mesh`): some 76 bytes a tree.
//! - `near` tells the shader which cells' trees stand near, as entities: there the cards give way, and only there, so that
//!   no tree is missing while others are still to come.
//!
//! A merged mesh needs no table of trees and no limit on them, and culls as any mesh does; the alternative, one shared mesh
//! whose slots read 16-byte rows, would save three quarters of the memory and cost a table to be kept in order.

mod blocks;
mod looks;
mod material;
mod mesh;
mod near;
mod plugin;

pub use blocks::FarBlocks;
pub use plugin::ForestDrawPlugin;
