//! Trees and stands as files for other programs: glTF, OBJ and atlases of impostors. Pure code, without an app; feature `export`.
//!
//! | stage | input -> output | file |
//! |---|---|---|
//! | settings | season, levels, motion; checked field by field | `settings.rs` |
//! | look | species, textures, time of the year -> colours, textures and masks as they are then | `look.rs`, `leaf_look.rs` |
//! | level | model -> vertices with colours and tangents, each bound to a place on a beam | `level.rs`, `surface.rs` |
//! | skin | model, wind -> which beams become joints, and the weights of each place | `skin.rs`, `joints.rs` |
//! | motion | response table -> a loop of the joints' poses without a seam | `motion.rs`, `looped.rs` |
//! | glTF | all of these -> a GLB | `gltf/` |
//! | others | vertices -> OBJ and MTL; the crown's polygons; an atlas of impostors and what its views are | `obj.rs`, `polygons.rs`, `impostors.rs` |
//! | write | bytes -> a file that is old or new, never half | `write.rs` |
//!
//! ```
//! use bevy_windwood::{
//!     export::{ExportSettings, ExportedTree, tree_glb},
//!     tree::{Species, TreeModel, textures::species_textures},
//! };
//!
//! let species = Species::default();
//! let (textures, model) = (species_textures(&species), TreeModel::bake(&species, 5.0, 7));
//! let tree = ExportedTree { species: &species, textures: &textures, model: &model, age_years: 5.0, seed: 7 };
//! let glb = tree_glb(&tree, &ExportSettings::default(), None)?;
//! assert_eq!(&glb[..4], b"glTF");
//! # Ok::<(), bevy_windwood::export::ExportError>(())
//! ```

mod error;
mod gltf;
mod impostors;
mod joints;
mod leaf_look;
mod level;
mod look;
mod looped;
mod motion;
mod obj;
mod picture;
mod polygons;
mod settings;
mod skin;
mod surface;
mod tree;
mod write;

#[cfg(test)]
mod tests;

pub use error::ExportError;
pub use gltf::{Instancing, StandInstance, stand_glb, tree_glb};
pub use impostors::impostor_files;
pub use obj::obj_files;
pub use polygons::polygon_files;
pub use settings::{ExportLevels, ExportSettings, LeafSides, MOST_JOINTS, MotionSettings};
pub use tree::ExportedTree;
pub use write::{ExportedFiles, write_atomically};
