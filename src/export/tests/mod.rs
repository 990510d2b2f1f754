//! The files of an export, read back by other crates and held against the tree that they are of.

mod glb_reader;
mod others;
mod seasons;
mod structure;
mod sway;

use super::{ExportSettings, ExportedTree, tree_glb};
use crate::{
    sway::{SwaySettings, WindResponse},
    tree::{
        Species, TreeModel,
        textures::{SpeciesTextures, species_textures},
    },
    wind::{FieldSettings, WindField},
};
use std::sync::{Arc, LazyLock};

/// A grown tree with its textures.
struct Grown {
    species: Species,
    textures: SpeciesTextures,
    model: TreeModel,
    age_years: f32,
    seed: u64,
}

impl Grown {
    fn new(species: Species, age_years: f32, seed: u64) -> Self {
        let (textures, model) = (species_textures(&species), TreeModel::bake(&species, age_years, seed));
        Self { species, textures, model, age_years, seed }
    }

    /// Of a shipped species.
    fn shipped(name: &str, age_years: f32) -> Self {
        let path = format!("{}/assets/species/{name}.species.ron", env!("CARGO_MANIFEST_DIR"));
        Self::new(Species::from_ron(&std::fs::read_to_string(path).unwrap()).unwrap(), age_years, 3)
    }

    fn tree(&self) -> ExportedTree<'_> {
        let Self { species, textures, model, age_years, seed } = self;
        ExportedTree { species, textures, model, age_years: *age_years, seed: *seed }
    }

    fn glb(&self, settings: &ExportSettings) -> Vec<u8> {
        tree_glb(&self.tree(), settings, None).unwrap()
    }
}

/// A grown oak.
static OAK: LazyLock<Grown> = LazyLock::new(|| Grown { seed: u64::MAX - 2, ..Grown::shipped("oak", 120.0) });

/// A strong breeze.
static WIND: LazyLock<WindResponse> = LazyLock::new(|| {
    let field = WindField::synthesise(&FieldSettings { speed: 11.0, seed: 5, ..FieldSettings::default() }).unwrap();
    WindResponse::new(Arc::new(field), &SwaySettings::default())
});
