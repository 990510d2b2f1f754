//! The file of what is edited: read, saved without loss, and looked after.

use std::{
    fs, io,
    path::{Path, PathBuf},
};

use ron::{Options, extensions::Extensions, ser::PrettyConfig};
use thiserror::Error;

use super::{
    document::Document,
    ron_merge::{Merged, merge},
    ron_tree::has_comments,
};
use crate::file_write::replace_file;

/// Why a file was not opened or saved.
#[derive(Debug, Error)]
pub enum FileError {
    /// It cannot be read or written.
    #[error("{}: {error}", path.display())]
    Disk { path: PathBuf, error: io::Error },
    /// It is not what it should be.
    #[error("{}: {error}", path.display())]
    Content { path: PathBuf, error: String },
    /// It cannot be written as RON.
    #[error("it cannot be written: {0}")]
    Writing(#[from] ron::Error),
}

/// Settings as they were last read from their file or saved there.
#[derive(Clone, Debug)]
pub struct DocumentFile<T> {
    pub path: PathBuf,
    pub document: T,
    /// The file's text; none if there is no file yet.
    text: Option<String>,
}

/// What another program has done to the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OnDisk {
    /// Nothing.
    AsKnown,
    Changed,
    Removed,
}

impl<T: Document> DocumentFile<T> {
    /// Reads a file.
    ///
    /// # Errors
    /// Where it cannot be read, or is not what it should be.
    pub fn open(path: &Path) -> Result<Self, FileError> {
        let text = fs::read_to_string(path).map_err(|error| FileError::Disk { path: path.to_owned(), error })?;
        let document = T::read(&text).map_err(|error| FileError::Content { path: path.to_owned(), error })?;
        Ok(Self { path: path.to_owned(), document, text: Some(text) })
    }

    /// Settings that have no file yet, and the one that they will have.
    pub fn new(path: &Path, document: T) -> Self {
        Self { path: path.to_owned(), document, text: None }
    }

    /// Whether there is a file of it.
    pub fn is_saved(&self) -> bool {
        self.text.is_some()
    }

    /// What saving would write: the person's own text with what has changed; all anew where that does not work.
    ///
    /// # Errors
    /// Where the RON crate cannot write it.
    pub fn text_of(&self, document: &T) -> Result<Merged, FileError> {
        let Some(own) = &self.text else {
            return Ok(Merged { text: written(document)?, loses_comments: false });
        };
        if *document == self.document {
            return Ok(Merged { text: own.clone(), loses_comments: false });
        }
        let new = written(document)?;
        let merged = merge(own, &written(&self.document)?, &new);
        let reads_back = |merged: &Merged| T::read(&merged.text).is_ok_and(|read| read == *document);
        let anew = || Merged { text: new.clone(), loses_comments: has_comments(own) };
        Ok(merged.filter(reads_back).unwrap_or_else(anew))
    }

    /// Saves it, to another path if one is given.
    ///
    /// # Errors
    /// Where it cannot be written: the file is as it was before.
    pub fn save(&mut self, document: &T, path: Option<&Path>) -> Result<(), FileError> {
        let text = self.text_of(document)?.text;
        let path = path.unwrap_or(&self.path).to_owned();
        replace_file(&path, text.as_bytes()).map_err(|error| FileError::Disk { path: path.clone(), error })?;
        *self = Self { path, document: document.clone(), text: Some(text) };
        Ok(())
    }

    /// What another program has done to it. Reads the file.
    pub fn on_disk(&self) -> OnDisk {
        match (fs::read_to_string(&self.path), &self.text) {
            (Ok(text), own) if Some(&text) == own.as_ref() => OnDisk::AsKnown,
            (Ok(_), _) => OnDisk::Changed,
            (Err(error), Some(_)) if error.kind() == io::ErrorKind::NotFound => OnDisk::Removed,
            (Err(_), _) => OnDisk::AsKnown,
        }
    }

    /// Where unsaved work is kept in case the program ends: a hidden file in the same folder.
    fn autosave_path(&self) -> PathBuf {
        let name = self.path.file_name().unwrap_or_default().to_string_lossy();
        self.path.with_file_name(format!(".{name}.autosave"))
    }

    /// Keeps unsaved work.
    ///
    /// # Errors
    /// Where it cannot be written.
    pub fn autosave(&self, document: &T) -> Result<(), FileError> {
        let path = self.autosave_path();
        replace_file(&path, written(document)?.as_bytes()).map_err(|error| FileError::Disk { path, error })
    }

    /// Work that was kept and never saved. It may break rules that have been changed in between: then it is not offered.
    pub fn autosaved(&self) -> Option<T> {
        let text = fs::read_to_string(self.autosave_path()).ok()?;
        T::read(&text).ok().filter(|document| *document != self.document)
    }

    /// Forgets work that was kept: it is saved, or not wanted.
    pub fn forget_autosave(&self) {
        // A file that is not there, or that cannot be removed, is offered once more at worst.
        let _ = fs::remove_file(self.autosave_path());
    }
}

/// Settings as RON, in the form of the shipped files.
fn written<T: Document>(document: &T) -> Result<String, ron::Error> {
    let extensions = Extensions::UNWRAP_VARIANT_NEWTYPES | Extensions::IMPLICIT_SOME;
    let form = PrettyConfig::new().new_line("\n".to_owned()).separate_tuple_members(false);
    let mut text = Options::default().with_default_extension(extensions).to_string_pretty(document, form)?;
    text.push('\n');
    Ok(text)
}

#[cfg(test)]
mod tests;
