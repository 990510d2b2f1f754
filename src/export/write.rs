//! Files that are old or new, never half.
//!
//! A file is written beside its place under another name, forced to the disk, and then given its name, which file systems do in one
//! step. Whatever happens before that, the old file is whole; a rest that a killed program leaves is called `.NAME.NUMBER.part`.

use super::error::ExportError;
use crate::setting::SettingError;
use std::{
    ffi::OsString,
    fs::{self, File, OpenOptions},
    io::{self, Write},
    path::{Path, PathBuf},
};

/// Other names that are tried for a part, if rests of killed programs have the first ones.
const NAMES_TRIED: u32 = 64;

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
    replace(path, bytes).map_err(|source| ExportError::Write { path: path.to_owned(), source })
}

fn replace(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let name = path.file_name().ok_or_else(|| io::Error::new(io::ErrorKind::InvalidInput, "it names no file"))?;
    let folder = path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let (part, file) = create_part(folder, name.to_os_string())?;
    let written = fill(file, bytes).and_then(|()| fs::rename(&part, path));
    if written.is_err() {
        // What went wrong first is what is told.
        let _ = fs::remove_file(&part);
    }
    written?;
    sync_folder(folder);
    Ok(())
}

/// A new file in the folder, which no other program writes to.
fn create_part(folder: &Path, name: OsString) -> io::Result<(PathBuf, File)> {
    let mut number = 0;
    loop {
        let mut part = OsString::from(".");
        part.push(&name);
        part.push(format!(".{}-{number}.part", std::process::id()));
        let part = folder.join(part);
        match OpenOptions::new().write(true).create_new(true).open(&part) {
            Ok(file) => return Ok((part, file)),
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists && number < NAMES_TRIED => number += 1,
            Err(error) => return Err(error),
        }
    }
}

fn fill(mut file: File, bytes: &[u8]) -> io::Result<()> {
    file.write_all(bytes)?;
    file.sync_all()
}

/// Has the disk keep the new name as well. Where folders cannot be synced, the file itself is on the disk all the same.
fn sync_folder(folder: &Path) {
    if cfg!(unix) {
        let _ = File::open(folder).and_then(|folder| folder.sync_all());
    }
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

    #[test]
    fn rests_of_killed_programs_are_stepped_over() {
        let folder = tempfile::tempdir().unwrap();
        let rest = folder.path().join(format!(".oak.glb.{}-0.part", std::process::id()));
        fs::write(&rest, b"half").unwrap();
        write_atomically(&folder.path().join("oak.glb"), b"whole").unwrap();
        assert_eq!(fs::read(&rest).unwrap(), b"half");
        assert_eq!(fs::read(folder.path().join("oak.glb")).unwrap(), b"whole");
    }
}
