//! The error of a plan that is read from RON.

use crate::{ron_text::SyntaxError, setting::SettingError};
use thiserror::Error;

/// Why a plan was refused.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum ScatterError {
    /// The text is not the RON of a plan.
    #[error(transparent)]
    Syntax(#[from] SyntaxError),
    /// A field is outside its domain.
    #[error(transparent)]
    Setting(#[from] SettingError),
}
