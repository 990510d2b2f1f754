//! Files in and out, with errors that name them.

use image::RgbImage;
use serde_json::Value;
use std::{fs, fs::File, io::Read, path::Path};

/// Reads a whole file of at most `most_bytes`. The length that the file system states is not trusted.
///
/// # Errors
/// With the path, where the file cannot be read or is longer.
pub fn read(path: &Path, most_bytes: u64) -> Result<Vec<u8>, String> {
    let named = |error: std::io::Error| format!("{}: {error}", path.display());
    let mut bytes = Vec::new();
    File::open(path).map_err(named)?.take(most_bytes + 1).read_to_end(&mut bytes).map_err(named)?;
    if bytes.len() as u64 > most_bytes {
        return Err(format!("{}: longer than {} MiB, the most that is read", path.display(), most_bytes >> 20));
    }
    Ok(bytes)
}

/// Writes JSON, if there is a path.
///
/// # Errors
/// With the path, where it cannot be written.
pub fn write_json(path: Option<&Path>, json: &Value) -> Result<(), String> {
    let Some(path) = path else { return Ok(()) };
    create_folder_of(path)?;
    fs::write(path, format!("{json:#}\n")).map_err(|error| format!("{}: {error}", path.display()))
}

/// Writes a PNG and prints its path.
///
/// # Errors
/// With the path, where it cannot be written.
pub fn write_picture(path: &Path, picture: &RgbImage) -> Result<(), String> {
    create_folder_of(path)?;
    picture.save_with_format(path, image::ImageFormat::Png).map_err(|error| format!("{}: {error}", path.display()))?;
    println!("{}", path.display());
    Ok(())
}

fn create_folder_of(path: &Path) -> Result<(), String> {
    let Some(folder) = path.parent() else { return Ok(()) };
    fs::create_dir_all(folder).map_err(|error| format!("{}: {error}", folder.display()))
}
