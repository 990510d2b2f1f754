//! What can be edited in a session: settings with files of their own.

use bevy::reflect::{PartialReflect, Reflect};
use serde::Serialize;

use super::fields::Section;

/// Settings that are read from a file, checked, and written back.
pub trait Document: Reflect + Clone + PartialEq + Serialize {
    /// How its files end.
    const EXTENSION: &'static str;
    /// What one is called.
    const NAME: &'static str;

    /// Reads and checks it.
    ///
    /// # Errors
    /// Where the text is not what it should be.
    fn read(text: &str) -> Result<Self, String>;

    /// Checks every field.
    ///
    /// # Errors
    /// For the first that is wrong.
    fn check(&self) -> Result<(), String>;

    /// The table of its fields, or of those that are the same for each.
    fn table(&self) -> Section;

    /// One of the same build with the default settings: where there is a field, it has one, too.
    fn default_of_kind(&self) -> Self;

    /// Gives a value of it the variant of that name, with default settings. Returns whether there is such a variant.
    fn choose(value: &mut dyn PartialReflect, variant: &str) -> bool;
}
