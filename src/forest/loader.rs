//! Reads `*.forest.ron` files.

use crate::scatter::{ForestPlan, ScatterError};
use bevy::{
    asset::{AssetLoader, LoadContext, io::Reader},
    reflect::TypePath,
};

/// Loads a [`ForestPlan`] from a RON file, and refuses it with the name of the field that is wrong.
#[derive(Default, TypePath)]
pub(super) struct ForestLoader;

/// Why a forest file was not taken.
#[derive(Debug, thiserror::Error)]
pub enum ForestLoadError {
    /// The file could not be read.
    #[error("cannot read the file: {0}")]
    Read(#[from] std::io::Error),
    /// The file is not text.
    #[error("not UTF-8 text: {0}")]
    Encoding(#[from] std::str::Utf8Error),
    /// The text is not a valid plan.
    #[error(transparent)]
    Plan(#[from] ScatterError),
}

impl AssetLoader for ForestLoader {
    type Asset = ForestPlan;
    type Settings = ();
    type Error = ForestLoadError;

    async fn load(
        &self,
        reader: &mut dyn Reader,
        (): &(),
        _: &mut LoadContext<'_>,
    ) -> Result<ForestPlan, ForestLoadError> {
        let mut bytes = Vec::new();
        reader.read_to_end(&mut bytes).await?;
        Ok(ForestPlan::from_ron(std::str::from_utf8(&bytes)?)?)
    }

    fn extensions(&self) -> &[&str] {
        &["forest.ron"]
    }
}
