//! Reads settings that are written in RON.

use ron::{Options, extensions::Extensions};
use serde::de::DeserializeOwned;
use thiserror::Error;

/// Text that is not the RON of what is read from it.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("line {line}, column {column}: {message}")]
pub struct SyntaxError {
    /// Line, from 1.
    pub line: usize,
    /// Column, from 1.
    pub column: usize,
    /// What is wrong there.
    pub message: String,
}

/// Reads `T`. A variant's struct may be written without parentheses of its own, an optional value without `Some`.
pub(crate) fn from_ron<T: DeserializeOwned>(text: &str) -> Result<T, SyntaxError> {
    let extensions = Extensions::UNWRAP_VARIANT_NEWTYPES | Extensions::IMPLICIT_SOME;
    Options::default().with_default_extension(extensions).from_str(text).map_err(|error| SyntaxError {
        line: error.span.start.line,
        column: error.span.start.col,
        message: error.code.to_string(),
    })
}
