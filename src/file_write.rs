//! Replaces files so that whoever reads one finds all of its old content or all of its new, whatever happens meanwhile.
//!
//! The content goes to a new file beside the old one, is brought to the disk, and then takes the old one's name. A full disk or a
//! program that is ended leave the old file as it was.

use std::{
    ffi::OsString,
    fs::{self, File, OpenOptions},
    io::{self, Write},
    path::{Path, PathBuf},
};

/// Other names that are tried for the new file, if rests of killed programs have the first ones: they are called `.NAME.NUMBER.part`.
const NAMES_TRIED: u32 = 64;

/// Replaces the content of a file, or creates it. A link is followed, and the file keeps its permissions.
///
/// # Errors
/// Where the content cannot be written: the file is as it was before.
pub(crate) fn replace_file(path: &Path, content: &[u8]) -> io::Result<()> {
    replace_file_with(path, |file| file.write_all(content))
}

/// The same for content that is written piece by piece.
///
/// # Errors
/// As above, and where `write` fails.
fn replace_file_with(path: &Path, write: impl FnOnce(&mut File) -> io::Result<()>) -> io::Result<()> {
    let path = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    let (part, file) = create_part(&path)?;
    let written = fill(file, &path, write).and_then(|()| fs::rename(&part, &path));
    if written.is_err() {
        // Whether it can be removed or not, the error to tell is that of the writing.
        let _ = fs::remove_file(&part);
        return written;
    }
    sync_folder(&path);
    Ok(())
}

/// A new hidden file in the same folder, which no other program writes to.
fn create_part(path: &Path) -> io::Result<(PathBuf, File)> {
    let name = path.file_name().ok_or_else(|| io::Error::new(io::ErrorKind::InvalidInput, "the path names no file"))?;
    let mut number = 0;
    loop {
        let mut hidden = OsString::from(".");
        hidden.push(name);
        hidden.push(format!(".{}-{number}.part", std::process::id()));
        let part = path.with_file_name(hidden);
        match OpenOptions::new().write(true).create_new(true).open(&part) {
            Ok(file) => return Ok((part, file)),
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists && number < NAMES_TRIED => number += 1,
            Err(error) => return Err(error),
        }
    }
}

fn fill(mut file: File, path: &Path, write: impl FnOnce(&mut File) -> io::Result<()>) -> io::Result<()> {
    if let Ok(old) = fs::metadata(path) {
        file.set_permissions(old.permissions())?;
    }
    write(&mut file)?;
    file.sync_all()
}

/// Brings the new name to the disk. Where folders cannot be synced, the file itself is on the disk all the same.
fn sync_folder(path: &Path) {
    if cfg!(unix) {
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let _ = File::open(folder).and_then(|folder| folder.sync_all());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).unwrap();
        entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
    }

    #[test]
    fn a_file_is_created_and_replaced_and_nothing_else_stays() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("oak.species.ron");
        for content in ["old", "new and longer", ""] {
            replace_file(&path, content.as_bytes()).unwrap();
            assert_eq!(fs::read_to_string(&path).unwrap(), content);
        }
        assert_eq!(names(folder.path()), ["oak.species.ron"]);
        assert!(replace_file(&folder.path().join("missing/oak.ron"), b"x").is_err());
        assert!(replace_file(Path::new("/"), b"x").is_err());
    }

    #[test]
    fn a_full_disk_leaves_the_old_file_whole() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("oak.species.ron");
        replace_file(&path, b"old").unwrap();
        let error = replace_file_with(&path, |file| {
            file.write_all(b"half of the ne")?;
            Err(io::ErrorKind::StorageFull.into())
        });
        assert_eq!(error.unwrap_err().kind(), io::ErrorKind::StorageFull);
        assert_eq!(fs::read_to_string(&path).unwrap(), "old");
        assert_eq!(names(folder.path()), ["oak.species.ron"]);
    }

    #[test]
    fn rests_of_killed_programs_are_stepped_over() {
        let folder = tempfile::tempdir().unwrap();
        let rest = folder.path().join(format!(".oak.glb.{}-0.part", std::process::id()));
        fs::write(&rest, b"half").unwrap();
        replace_file(&folder.path().join("oak.glb"), b"whole").unwrap();
        assert_eq!(fs::read(&rest).unwrap(), b"half");
        assert_eq!(fs::read(folder.path().join("oak.glb")).unwrap(), b"whole");
    }

    #[cfg(unix)]
    #[test]
    fn links_are_followed_and_permissions_stay() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let folder = tempfile::tempdir().unwrap();
        let (path, link) = (folder.path().join("oak.ron"), folder.path().join("link.ron"));
        replace_file(&path, b"old").unwrap();
        fs::set_permissions(&path, fs::Permissions::from_mode(0o640)).unwrap();
        symlink(&path, &link).unwrap();
        replace_file(&link, b"new").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"new");
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::metadata(&path).unwrap().permissions().mode() & 0o777, 0o640);
    }

    /// The path that a child process of the next test writes to.
    const WRITER: &str = "WINDWOOD_TEST_WRITER";

    /// Large enough that a process is often ended in the middle of it.
    fn content(letter: u8) -> Vec<u8> {
        vec![letter; 1 << 20]
    }

    #[test]
    fn a_process_that_is_killed_while_saving_leaves_the_old_file_or_the_new_one() {
        if let Some(path) = std::env::var_os(WRITER) {
            for letter in (b'a'..=b'z').cycle() {
                replace_file(Path::new(&path), &content(letter)).unwrap();
            }
        }
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("oak.species.ron");
        replace_file(&path, &content(b'a')).unwrap();
        let name = std::thread::current().name().map(str::to_owned).expect("tests run in threads of their name");
        for round in 0..12_u64 {
            let mut child = std::process::Command::new(std::env::current_exe().unwrap())
                .args(["--exact", &name])
                .env(WRITER, &path)
                .stdout(std::process::Stdio::null())
                .spawn()
                .unwrap();
            // A process has begun to write after some 10 ms.
            std::thread::sleep(Duration::from_millis(20 + 7 * round));
            child.kill().unwrap();
            child.wait().unwrap();
            let found = fs::read(&path).unwrap();
            assert!(found.len() == 1 << 20 && found.iter().all(|letter| *letter == found[0]), "round {round}");
        }
    }
}
