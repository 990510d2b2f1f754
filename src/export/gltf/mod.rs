//! glTF 2.0, in its binary form (GLB): one file with all pictures inside.
//!
//! `builder.rs` gathers the buffer and its accessors. `materials.rs`, `meshes.rs` and `skeleton.rs` add what a tree is made of,
//! `tree_file.rs` and `stand_file.rs` put the scenes together.

mod builder;
mod materials;
mod meshes;
mod skeleton;
mod stand_file;
mod tree_file;

pub use stand_file::{Instancing, StandInstance, stand_glb};
pub use tree_file::tree_glb;
