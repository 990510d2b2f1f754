//! Files that are old or new, never half.

use super::error::ExportError;
use crate::{file_write::replace_file, setting::SettingError};
use std::path::Path;

/// Files that belong together, each with its name, without a folder.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ExportedFiles(pub Vec<(String, Vec<u8>)>);

impl ExportedFiles {
    /// Writes all into a folder, each as [`write_atomically`] does. The one that names the others comes last, so that it never names what
    /// is not there.
    ///
    /// # Errors
    /// [`ExportError::Write`] for the first that cannot be written; those before it are.
    pub fn write(&self, folder: &Path) -> Result<(), ExportError> {
        self.0.iter().try_for_each(|(name, bytes)| write_atomically(&folder.join(name), bytes))
    }
}

/// Writes a file whole or not at all: if it fails, or the program is killed meanwhile, a file of that name stays as it was.
///
/// # Errors
/// [`ExportError::Write`] with the path and the reason.
pub fn write_atomically(path: &Path, bytes: &[u8]) -> Result<(), ExportError> {
    replace_file(path, bytes).map_err(|source| ExportError::Write { path: path.to_owned(), source })
}

/// Refuses what is no name for files that name each other: OBJ ends a name at a space, and a folder in it would lead elsewhere.
pub(super) fn require_file_name(name: &str) -> Result<(), SettingError> {
    let is_allowed = |letter: char| letter.is_alphanumeric() || matches!(letter, '_' | '-');
    if !name.is_empty() && name.chars().all(is_allowed) {
        return Ok(());
    }
    Err(SettingError::new("name", format!("{name:?}"), "letters, digits, `_` and `-`, at least one"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    fn names(folder: &Path) -> Vec<String> {
        let mut names: Vec<String> =
            fs::read_dir(folder).unwrap().map(|file| file.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    #[test]
    fn an_existing_file_is_replaced_and_nothing_else_is_left() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("oak.glb");
        write_atomically(&path, b"old, and longer than the new one").unwrap();
        write_atomically(&path, b"new").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"new");
        assert_eq!(names(folder.path()), ["oak.glb"]);
    }

    /// A folder of that name cannot be replaced by a file: the last step fails, after all has been written.
    #[test]
    fn a_failure_leaves_what_was_there_and_removes_its_part() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("oak.glb");
        fs::create_dir(&path).unwrap();
        fs::write(path.join("inside"), b"kept").unwrap();
        let error = write_atomically(&path, b"new").unwrap_err();
        assert!(error.to_string().contains("oak.glb"), "{error}");
        assert_eq!(fs::read(path.join("inside")).unwrap(), b"kept");
        assert_eq!(names(folder.path()), ["oak.glb"]);
    }

    #[test]
    fn a_folder_that_is_not_there_is_named_in_the_error() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("none").join("oak.glb");
        let error = write_atomically(&path, b"new").unwrap_err();
        assert!(matches!(&error, ExportError::Write { path: told, .. } if *told == path), "{error}");
        assert!(names(folder.path()).is_empty());
    }
}
