//! Loads assets that are written in RON.

use bevy::{
    asset::{AssetLoader, LoadContext, io::Reader},
    prelude::*,
};
use std::{marker::PhantomData, str::Utf8Error};
use thiserror::Error;

/// An asset that is written in RON.
pub(crate) trait RonAsset: Asset + Sized {
    /// What is wrong with a text.
    type Error: std::error::Error + Send + Sync + 'static;

    /// How its files end.
    const EXTENSIONS: &'static [&'static str];

    /// Reads and checks it.
    fn read(text: &str) -> Result<Self, Self::Error>;
}

/// Loads an asset from a RON file, and refuses it with the name of the field that is wrong.
#[derive(TypePath)]
pub(crate) struct RonLoader<A: RonAsset>(PhantomData<A>);

impl<A: RonAsset> Default for RonLoader<A> {
    fn default() -> Self {
        Self(PhantomData)
    }
}

/// Why a RON file was not taken.
#[derive(Debug, Error)]
pub enum RonLoadError<E: std::error::Error + 'static> {
    /// The file could not be read.
    #[error("cannot read the file: {0}")]
    Read(#[from] std::io::Error),
    /// The file is not text.
    #[error("not UTF-8 text: {0}")]
    Encoding(#[from] Utf8Error),
    /// The text is not what it should be.
    #[error(transparent)]
    Content(E),
}

impl<A: RonAsset> AssetLoader for RonLoader<A> {
    type Asset = A;
    type Settings = ();
    type Error = RonLoadError<A::Error>;

    async fn load(&self, reader: &mut dyn Reader, (): &(), _: &mut LoadContext<'_>) -> Result<A, Self::Error> {
        let mut bytes = Vec::new();
        reader.read_to_end(&mut bytes).await?;
        A::read(std::str::from_utf8(&bytes)?).map_err(RonLoadError::Content)
    }

    fn extensions(&self) -> &[&str] {
        A::EXTENSIONS
    }
}
