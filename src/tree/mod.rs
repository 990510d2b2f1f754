//! Trees: from a species file to the model that thousands of trees share, and the [`Tree`] entities that use it.
//!
//! # From species file to mesh
//! A model is baked once for each variant of a species at each step of age, in the background. The stages, in order:
//!
//! | stage | input -> output | file |
//! |---|---|---|
//! | load | `*.species.ron` -> [`Species`], checked field by field | [`species`] |
//! | pick an age | age in years -> [`Stage`](growth::age::Stage), the shares of the mature sizes | [`growth::age`] |
//! | grow branches | [`Growth`] settings, stage, seed -> beams, parents first | `generator.rs` chooses one of [`growth::reeves_blau`], [`growth::zaharia`], [`growth::aono_kunii`]; they share `growth/grower.rs` and `growth/stems.rs`, [`growth::trunk`], [`growth::envelope`] and [`growth::phyllotaxis`] |
//! | or grow a crown | crown settings -> a whole skeleton with polygons or ellipsoids for leaves | [`crown::impressionist`], [`crown::gardner`] |
//! | place foliage | beams -> sprays of leaves on them | [`foliage`] |
//! | find radii | beams, sprays -> radii, by the pipe model | `growth/pipes.rs` |
//! | break | skeleton -> skeleton with stubs, or without leaves | [`growth::damage`] |
//! | **skeleton** | all of the above, called from one place | [`individual::grow`] -> [`skeleton`] |
//! | mechanics | skeleton -> gain and frequency of each beam, for the response tables | [`mechanics`] |
//! | wood mesh | skeleton -> one tube a branch, flared where it leaves its parent | `wood_mesh.rs`, `tube.rs`, `joint/` |
//! | leaf mesh | skeleton -> one card a spray, or the crown's polygons or ellipsoids | `leaf_mesh.rs` |
//! | bounds | vertices, beams -> the box that holds the tree in every wind | `bounds.rs` |
//! | body | beams, leaf mesh -> trunk and limbs for rays and colliders, leaves as a density | [`body`] |
//! | **model** | all of the above, called from one place | [`TreeModel::bake`], in `model.rs` |
//!
//! Beside the model a species has textures, which do not depend on the individual: [`textures`] renders them from
//! [`bark`], [`leaf`] and [`crown`]. [`phenology`] says what leaves look like at a time of the year, [`recolour`] of what colour they are then.
//!
//! # From model to tree
//! `ecs/species_models.rs` bakes in the background and stores the models in [`SpeciesModels`]. `ecs/grow_trees.rs` gives
//! each [`Tree`] its variant as a [`Grown`] component. What draws and moves trees starts from there.
//! `ecs/missing_species.rs` tells which trees wait for a species that cannot be loaded. [`Season`] is the time of the year.
//!
//! [`TreePlaces`] knows who stands where, on the grid of `place_grid.rs`: for all who ask what is near, or on the way of a ray.

pub mod bark;
pub mod body;
mod bounds;
mod components;
pub mod crown;
mod ecs;
pub mod ellipsoid;
pub mod foliage;
mod frontal_area;
mod generator;
pub mod green_wood;
pub mod growth;
pub mod individual;
mod joint;
pub mod leaf;
mod leaf_mesh;
mod leaf_places;
mod leaf_season;
pub mod mechanics;
mod model;
pub mod phenology;
mod place_grid;
mod plugin;
pub mod recolour;
pub mod skeleton;
pub mod species;
pub mod textures;
mod tube;
pub mod vertices;
mod wood_mesh;

#[cfg(feature = "render")]
pub(crate) use bounds::PressureStep;
pub use bounds::SwayBounds;
pub use components::{Articulated, Beam, BeamOf, Grown, Leaf, LeafOf, Tree, TreeBeams, TreeLeaves};
pub(crate) use ecs::{missing_species::ReportedSpecies, places::track_trees, species_models::no_longer_used};
pub use ecs::{
    places::TreePlaces,
    season::Season,
    species_models::{BakedSpecies, BakedStage, SpeciesBaked, SpeciesModels, bake_variants},
};
pub(crate) use frontal_area::frontal_area_m2;
pub use generator::Growth;
pub use leaf_season::LeafSeason;
pub(crate) use mechanics::{Piece, tree_pieces};
pub use model::TreeModel;
pub use plugin::TreePlugin;
pub use species::{Species, SpeciesError};
pub(crate) use wood_mesh::coarse_wood;

#[cfg(all(test, feature = "render"))]
pub(crate) use bounds::MOST_ENLARGED;
#[cfg(feature = "render")]
pub(crate) use ecs::grow_trees::regrow_trees;

#[cfg(test)]
mod tests;
