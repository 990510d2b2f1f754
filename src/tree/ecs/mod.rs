//! Trees in Bevy: resources and systems that turn species into models, and give the models to trees.

pub(super) mod grow_trees;
pub(super) mod missing_species;
pub(super) mod places;
pub(super) mod season;
pub(super) mod species_models;
#[cfg(test)]
mod test_app;
