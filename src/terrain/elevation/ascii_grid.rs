//! ESRI ASCII grids: a header of names and numbers, then the samples, row by row from the north.
//!
//! ```text
//! ncols 76
//! nrows 93
//! xllcorner 423000      or xllcenter
//! yllcorner 4446000     or yllcenter
//! cellsize 466          or dx and dy
//! NODATA_value -9999    which is so where it is left out
//! ```

use super::{
    georeference::{Georeference, MapUnit},
    samples::Samples,
};
use crate::{
    setting::SettingError,
    terrain::{elevation_grid::require_size, error::TerrainError},
};
use bevy::math::DVec2;
use std::{iter::Peekable, str::SplitAsciiWhitespace};

/// What the format takes for no data where the header does not say it.
const USUAL_NO_DATA: f64 = -9999.0;
/// The names that a header can have.
const NAMES: [&str; 10] =
    ["ncols", "nrows", "xllcorner", "yllcorner", "xllcenter", "yllcenter", "cellsize", "dx", "dy", "nodata_value"];
/// Characters of a wrong word that are shown.
const MOST_SHOWN: usize = 40;

/// Whether a file begins as a grid does.
pub(super) fn is_grid(bytes: &[u8]) -> bool {
    let start = without_mark(bytes).trim_ascii_start();
    NAMES.iter().any(|name| start.get(..name.len()).is_some_and(|start| start.eq_ignore_ascii_case(name.as_bytes())))
}

/// Reads a grid.
pub(super) fn read(bytes: &[u8]) -> Result<Samples, TerrainError> {
    let text = std::str::from_utf8(without_mark(bytes))
        .map_err(|error| TerrainError::Unreadable { reason: format!("the grid is not text: {error}") })?;
    let mut words = text.split_ascii_whitespace().peekable();
    let header = Header::read(&mut words)?;
    let [columns, rows] = [header.count("ncols")?, header.count("nrows")?];
    require_size(columns, rows).map_err(|error| error.inside("header"))?;
    let expected = u64::from(columns) * u64::from(rows);
    // A sample takes two bytes at least, so that a header alone cannot ask for memory.
    let mut values = Vec::with_capacity(expected.min(bytes.len() as u64 / 2 + 1) as usize);
    for word in words {
        let index = values.len();
        if index as u64 == expected {
            let field = "samples of the grid".to_owned();
            return Err(TerrainError::Count { field, found: index + 1, columns, rows, expected });
        }
        let place = || format!("sample at column {}, row {}", index % columns as usize, index / columns as usize);
        values.push(number(word).ok_or_else(|| no_number(place(), word))? as f32);
    }
    if (values.len() as u64) < expected {
        let field = "samples of the grid".to_owned();
        return Err(TerrainError::Count { field, found: values.len(), columns, rows, expected });
    }
    Ok(Samples {
        columns,
        rows,
        values,
        no_data: Some(header.get("nodata_value").unwrap_or(USUAL_NO_DATA)),
        georeference: header.georeference(rows),
        ..Samples::default()
    })
}

/// The numbers of the header, by their place in [`NAMES`].
struct Header([Option<f64>; NAMES.len()]);

impl Header {
    fn read(words: &mut Peekable<SplitAsciiWhitespace<'_>>) -> Result<Self, TerrainError> {
        let mut header = Self([None; NAMES.len()]);
        while let Some(name) = words.next_if(|word| number(word).is_none()) {
            let Some(index) = NAMES.iter().position(|known| name.eq_ignore_ascii_case(known)) else {
                let reason = format!("the grid's header has `{}`, which is no name that it can have", shown(name));
                return Err(TerrainError::Unreadable { reason });
            };
            let word = words.next().unwrap_or_default();
            header.0[index] = Some(number(word).ok_or_else(|| no_number(NAMES[index].to_owned(), word))?);
        }
        Ok(header)
    }

    fn get(&self, name: &str) -> Option<f64> {
        NAMES.iter().position(|known| *known == name).and_then(|index| self.0[index])
    }

    fn count(&self, name: &str) -> Result<u32, SettingError> {
        let whole = |value: &f64| value.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(value);
        let given = self.get(name);
        given.filter(whole).map(|value| value as u32).ok_or_else(|| {
            let found = given.map_or("not in the header".to_owned(), |value| value.to_string());
            SettingError::new(name, found, "a whole number in the grid's header")
        })
    }

    /// Where the grid lies, if the header says how large a cell is.
    fn georeference(&self, rows: u32) -> Option<Georeference> {
        let size = self.get("cellsize");
        let cell = DVec2::new(self.get("dx").or(size)?, self.get("dy").or(size)?);
        let edge = |corner: &str, centre: &str, cell: f64| {
            self.get(corner).or_else(|| Some(self.get(centre)? - 0.5 * cell)).unwrap_or(0.0)
        };
        let west = edge("xllcorner", "xllcenter", cell.x);
        let south = edge("yllcorner", "yllcenter", cell.y);
        let west_north = DVec2::new(west, south + f64::from(rows) * cell.y);
        Some(Georeference { unit: MapUnit::Unknown, cell, west_north })
    }
}

/// A number, also one with a decimal comma, as programs write it in many countries.
fn number(word: &str) -> Option<f64> {
    word.parse().ok().or_else(|| word.replacen(',', ".", 1).parse().ok())
}

fn no_number(place: String, word: &str) -> TerrainError {
    SettingError::new(place, format!("`{}`", shown(word)), "a number").into()
}

fn shown(word: &str) -> String {
    word.escape_debug().take(MOST_SHOWN).collect()
}

/// Without the byte order mark that some editors write.
fn without_mark(bytes: &[u8]) -> &[u8] {
    bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes)
}
