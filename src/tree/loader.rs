//! Reads `*.species.ron` files.

use super::species::{Species, SpeciesError};
use bevy::{
    asset::{AssetLoader, LoadContext, io::Reader},
    reflect::TypePath,
};

/// Loads a [`Species`] from a RON file, and refuses it with the name of the field that is wrong.
#[derive(Default, TypePath)]
pub(super) struct SpeciesLoader;

/// Why a species file was not taken.
#[derive(Debug, thiserror::Error)]
pub enum SpeciesLoadError {
    /// The file could not be read.
    #[error("cannot read the file: {0}")]
    Read(#[from] std::io::Error),
    /// The file is not text.
    #[error("not UTF-8 text: {0}")]
    Encoding(#[from] std::str::Utf8Error),
    /// The text is not a valid species.
    #[error(transparent)]
    Species(#[from] SpeciesError),
}

impl AssetLoader for SpeciesLoader {
    type Asset = Species;
    type Settings = ();
    type Error = SpeciesLoadError;

    async fn load(
        &self,
        reader: &mut dyn Reader,
        (): &(),
        _: &mut LoadContext<'_>,
    ) -> Result<Species, SpeciesLoadError> {
        let mut bytes = Vec::new();
        reader.read_to_end(&mut bytes).await?;
        Ok(Species::from_ron(std::str::from_utf8(&bytes)?)?)
    }

    fn extensions(&self) -> &[&str] {
        &["species.ron"]
    }
}
