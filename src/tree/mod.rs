//! What a tree is made of: its species, its skeleton of beams, its wood, leaves and their textures.
//!
//! A [`Species`] is a page of numbers; [`skeleton::grow`] makes one individual of it from an age and a seed;
//! [`mesh::wood`] and [`leaf_mesh::leaves`] give it a surface, [`bark`] and [`leaf`] paint it, and
//! [`mechanics`] finds out how stiff, heavy and exposed its beams are. All that together is a [`TreeModel`], baked once
//! for each variant of a species and shared by all its [`Tree`]s.

pub mod bark;
mod bounds;
mod components;
pub mod crown;
pub mod foliage;
mod grove;
mod grow;
pub mod growth;
mod joint;
pub mod leaf;
pub mod leaf_mesh;
mod loader;
pub mod mechanics;
pub mod mesh;
mod model;
pub mod painting;
pub mod phenology;
mod plugin;
mod season;
pub mod skeleton;
pub mod species;
mod tube;

#[cfg(feature = "render")]
pub(crate) use bounds::PressureStep;
pub use bounds::SwayBounds;
pub use components::{Articulated, Beam, BeamOf, Grown, Leaf, LeafOf, Tree, TreeBeams, TreeLeaves};
pub use grove::{BakedSpecies, BakedStage, Grove, SpeciesBaked, bake_variants};
pub use loader::SpeciesLoadError;
pub use model::TreeModel;
pub use plugin::TreePlugin;
pub use season::Season;
pub use species::{Species, SpeciesError};

#[cfg(all(test, feature = "render"))]
pub(crate) use bounds::MOST_ENLARGED;
#[cfg(feature = "render")]
pub(crate) use grove::receive_models;

#[cfg(test)]
mod tests;
