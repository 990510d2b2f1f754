//! What is told beside the numbers.

use serde_json::{Value, json};

/// One sentence about a file or what was found in it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Note {
    pub is_warning: bool,
    pub text: String,
}

impl Note {
    /// Something to know.
    pub fn new(text: impl Into<String>) -> Self {
        Self { is_warning: false, text: text.into() }
    }

    /// Something that may be wrong.
    pub fn warning(text: impl Into<String>) -> Self {
        Self { is_warning: true, text: text.into() }
    }

    /// Prints it.
    pub fn print(&self) {
        println!("{}: {}", if self.is_warning { "warning" } else { "note" }, self.text);
    }

    pub fn to_json(&self) -> Value {
        json!({ "is_warning": self.is_warning, "text": self.text })
    }
}
