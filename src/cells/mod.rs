//! The voxel grid of a forest, from ten trees to a million.
//!
//! "One first step to reduce the number of polygons sent to the graphics pipeline [...] is to divide the scene into a
//! regular grid of cells (voxels) and process only the data in the cells belonging to the instantaneous view volume"
//! (Setas et al., section 4). Here the grid also decides what exists at all: a [`CellStore`] holds the cells about the
//! viewers, each plant in 16 bytes, and every question costs what is near and asked for, however large the forest is.
//!
//! - [`CellStore::insert`], [`get`](CellStore::get) and so on: the cells and their plants (`store`, `cell`, `block`).
//! - [`CellStore::see`]: the cells in view, and those whose shadows fall into view (`view`).
//! - [`CellLevels`]: which level of detail a cell has, without flicker (`level`).
//! - [`CellStream`]: which cells to plant, keep and drop about the viewers (`stream`).
//! - [`CellStore::nearest`], [`within`](CellStore::within), [`cast`](CellStore::cast): stems by place, and the first trunk
//!   on a ray (`query`).
//!
//! This room is plain arithmetic without an app. Everything is in the forest's own frame: x and z on the map, y up.

mod block;
mod bounds;
mod cell;
mod level;
mod query;
mod store;
mod stream;
mod view;

pub use cell::Cell;
pub use level::CellLevels;
pub use query::{Found, RayHit, Trunk};
pub use store::CellStore;
pub use stream::{CellSet, CellStream, Orders, StreamSettings, Viewpoint};
pub use view::{Seen, Sun, TreeExtent, View, Watch};
