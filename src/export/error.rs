//! Why an export failed.

use crate::setting::SettingError;
use image::ImageError;
use std::{io, path::PathBuf};
use thiserror::Error;

/// Why an export failed. Nothing was written, and a file of that name is as it was.
#[derive(Debug, Error)]
pub enum ExportError {
    /// A setting outside its domain.
    #[error(transparent)]
    Setting(#[from] SettingError),
    /// A crown without the polygons that were asked for.
    #[error(
        "the crown of `{species}` is not made of polygons: only those of `growth: Impressionist(..)` are; export it as a tree"
    )]
    NoPolygons {
        /// Name of the species.
        species: String,
    },
    /// A picture that could not be encoded.
    #[error("the picture `{name}` cannot be encoded: {source}")]
    Picture {
        /// What it is called.
        name: String,
        /// Why.
        source: ImageError,
    },
    /// A document that could not be written as text.
    #[error("the document cannot be written as JSON: {0}")]
    Json(#[from] serde_json::Error),
    /// The same for OBJ and MTL.
    #[error("the document cannot be written as text: {0}")]
    Text(#[from] std::fmt::Error),
    /// More than a GLB holds.
    #[error("the buffer would have {bytes} bytes, but a GLB holds at most {most}: export fewer trees or levels")]
    TooLarge {
        /// Its size.
        bytes: u64,
        /// What is allowed.
        most: u64,
    },
    /// A file that could not be written.
    #[error(
        "`{path}` cannot be written: {source}. Nothing was changed; check the folder, its rights and the space left"
    )]
    Write {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
}
