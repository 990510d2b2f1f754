//! Reads places from tables as people have them.
//!
//! Columns are separated by commas, semicolons, tabs, bars or blanks, which is found out; numbers have decimal points or, where that is
//! clear, decimal commas; a header names the columns, or --columns does, or places are in the first two; lengths are those of the header,
//! or metres. Titles above the header, empty rows and rows without a place are left out, and told. Everything else is refused, by its line.
//!
//! | file | what |
//! |---|---|
//! | `text` | Bytes to text. |
//! | `separator` | What separates columns. |
//! | `names` | Names of columns, and units of length in them. |
//! | `layout` | Where the header is, and the two columns. |
//! | `number` | Numbers, and what stands for a missing one. |
//! | `rows` | All rows to places. |

mod layout;
mod names;
mod number;
mod rows;
mod separator;
#[cfg(test)]
mod tests;
mod text;

pub use rows::{Table, read_table};

/// Greatest size of a file: a million lines of 256 bytes.
pub const MOST_BYTES: u64 = 256 << 20;
