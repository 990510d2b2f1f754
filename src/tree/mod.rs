//! What a tree is made of: its species, its skeleton of beams, its wood, leaves and their textures.
//!
//! A [`Species`] is a page of numbers; [`skeleton::grow`] makes one individual of it from a seed;
//! [`mesh::wood`] and [`leaf_mesh::leaves`] give it a surface, [`bark`] and [`leaf_texture`] paint it, and
//! [`mechanics`] finds out how stiff, heavy and exposed its beams are. All that together is a [`TreeModel`], baked once
//! for each variant of a species and shared by all its [`Tree`]s.

pub mod bark;
mod components;
pub mod foliage;
mod grove;
pub mod growth;
pub mod leaf_mesh;
pub mod leaf_texture;
mod loader;
pub mod mechanics;
pub mod mesh;
mod model;
pub mod phenology;
mod plugin;
mod season;
pub mod skeleton;
pub mod species;
pub mod texture;
mod tube;

pub use components::{Articulated, Beam, BeamOf, Grown, Leaf, LeafOf, Tree, TreeBeams, TreeLeaves};
pub use grove::{BakedSpecies, BakedStage, Grove, SpeciesBaked, bake_variants};
pub use loader::SpeciesLoadError;
pub use model::{SwayBounds, TreeModel};
pub use plugin::TreePlugin;
pub use season::Season;
pub use species::{Species, SpeciesError};

#[cfg(feature = "render")]
pub(crate) use grove::receive_models;

#[cfg(test)]
mod tests;
