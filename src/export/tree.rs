//! What is exported.

use crate::tree::{Species, TreeModel, textures::SpeciesTextures};

/// A baked tree with all that an export of it needs.
#[derive(Clone, Copy)]
pub struct ExportedTree<'a> {
    /// Its species.
    pub species: &'a Species,
    /// The species' textures ([`species_textures`](crate::tree::textures::species_textures)).
    pub textures: &'a SpeciesTextures,
    /// The model, at an age and of a seed.
    pub model: &'a TreeModel,
    /// Age at which the model was baked, years: for the file alone.
    pub age_years: f32,
    /// Seed that the model was baked with: for the file alone.
    pub seed: u64,
}

impl ExportedTree<'_> {
    /// What the node of the tree says of it: `species`, `height_m`, `age_years`, `seed`, `year`, `generator`.
    pub(super) fn extras(&self, year: f32) -> serde_json::Value {
        serde_json::json!({
            "species": self.species.name,
            "height_m": self.model.height_m(),
            "age_years": self.age_years,
            // As text: numbers of JSON are exact to 53 bits only in many programs.
            "seed": self.seed.to_string(),
            "year": year,
            "generator": GENERATOR,
        })
    }
}

/// The program that made a file, and its version.
pub(super) const GENERATOR: &str = concat!("bevy_windwood ", env!("CARGO_PKG_VERSION"));
