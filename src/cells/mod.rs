//! The cells of a forest, from ten trees to a million.
//!
//! "One first step to reduce the number of polygons sent to the graphics pipeline [...] is to divide the scene into a
//! regular grid of cells (voxels) and process only the data in the cells belonging to the instantaneous view volume"
//! (Setas et al., section 4). Here the grid also decides what exists at all: a [`CellStore`] holds the cells about the
//! viewers, each plant in 16 bytes, and every query costs what is near and asked for, however large the forest is.
//!
//! | module | what |
//! |---|---|
//! | `store`, `cell`, `block` | [`CellStore`]: the cells and their plants. |
//! | `query` | Stems by place ([`CellStore::nearest`], [`CellStore::within`]), and the first trunk on a ray ([`CellStore::cast`]). |
//! | `stream` | [`CellStream`]: which cells to plant, keep and drop about the viewers. |
//! | `culling` | [`Culler`]: which boxes a camera sees, and which throw shadows into its view. |
//!
//! This room is plain arithmetic without an app. Everything is in the forest's own frame: x and z on the map, y up.

mod block;
mod bounds;
mod cell;
mod culling;
mod query;
mod store;
mod stream;

pub use cell::Cell;
pub use culling::{Culler, CullingView, SunShadows};
pub use query::{Found, ray::RayHit, trunk::Trunk};
pub use store::CellStore;
pub use stream::{CellSet, CellStream, Orders, settings::StreamSettings, viewer::ViewerPose};
