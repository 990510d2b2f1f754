//! Fields of grass in an app.

mod field;

pub use field::{GrassField, GrassFieldPatches};
pub(super) use field::{apply_grass_fields, move_grass_fields, remove_grass_field};
