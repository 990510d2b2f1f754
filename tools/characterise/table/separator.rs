//! What separates the columns of a table.

use super::number::parse;
use csv::{ReaderBuilder, StringRecord, Trim};
use std::borrow::Cow;

/// Rows from which the separator is found out.
const ROWS_LOOKED_AT: usize = 200;

/// What separates the columns of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Separator {
    Tab,
    Semicolon,
    Bar,
    Comma,
    /// One blank or more.
    Blanks,
}

impl Separator {
    /// The separator with which most rows have two numbers. A comma may also be the decimal mark of a table with another separator; so of
    /// comma and blanks that one is taken which makes numbers of more fields, and all others go before. Where no row has two numbers, what
    /// is in most rows separates.
    pub fn of(text: &str) -> Self {
        let text = first_lines(text);
        let qualifies = |separator: &Self| separator.share_of_numbers(text).is_some();
        if let Some(certain) = Self::CERTAIN.into_iter().find(qualifies) {
            return certain;
        }
        let [comma, blanks] = [Self::Comma, Self::Blanks].map(|separator| separator.share_of_numbers(text));
        match (comma, blanks) {
            (None, None) => {
                Self::CERTAIN.into_iter().find(|separator| separator.is_in_most_rows(text)).unwrap_or(Self::Comma)
            }
            (comma, blanks) if blanks > comma => Self::Blanks,
            _ => Self::Comma,
        }
    }

    /// Those that are hardly ever anything else.
    const CERTAIN: [Self; 3] = [Self::Tab, Self::Semicolon, Self::Bar];

    fn is_in_most_rows(self, text: &str) -> bool {
        let (mut rows, mut divided) = (0, 0);
        for record in self.reader(text).records().map_while(Result::ok) {
            rows += 1;
            divided += usize::from(record.len() > 1);
        }
        2 * divided > rows
    }

    /// The share of fields that are numbers in rows with two numbers or more: `None` where these are less than half of all rows.
    fn share_of_numbers(self, text: &str) -> Option<f64> {
        let (mut rows, mut good, mut fields, mut numbers) = (0, 0, 0, 0);
        for record in self.reader(&self.prepare(text)).records().map_while(Result::ok) {
            rows += 1;
            let of_row = record.iter().filter(|field| parse(field).is_some()).count();
            if of_row >= 2 {
                good += 1;
                fields += record.len();
                numbers += of_row;
            }
        }
        (2 * good >= rows && good > 0).then(|| f64::from(numbers as u32) / f64::from(fields as u32))
    }

    /// The text with one character between columns. Lines stay where they are.
    pub fn prepare(self, text: &str) -> Cow<'_, str> {
        if self != Self::Blanks {
            return Cow::Borrowed(text);
        }
        Cow::Owned(text.lines().flat_map(|line| [single_blanks(line), "\n".to_owned()]).collect())
    }

    /// A reader of [prepared](Self::prepare) text.
    pub fn reader(self, text: &str) -> csv::Reader<&[u8]> {
        let delimiter = match self {
            Self::Tab => b'\t',
            Self::Semicolon => b';',
            Self::Bar => b'|',
            Self::Comma => b',',
            Self::Blanks => b' ',
        };
        let mut builder = ReaderBuilder::new();
        builder.has_headers(false).flexible(true).trim(Trim::All).comment(Some(b'#')).delimiter(delimiter);
        builder.from_reader(text.as_bytes())
    }
}

/// The line of a record, from 1. The position of a record is the end of the one before, so blank lines and comments may follow it.
pub fn line(text: &str, record: &StringRecord) -> u64 {
    let Some(position) = record.position() else { return 0 };
    let rest = text.get(position.byte() as usize..).unwrap_or_default();
    let is_passed_over = |line: &&str| line.trim().is_empty() || line.starts_with('#');
    position.line() + rest.split('\n').take_while(is_passed_over).count() as u64
}

fn first_lines(text: &str) -> &str {
    let end = text.match_indices('\n').nth(ROWS_LOOKED_AT).map_or(text.len(), |(end, _)| end);
    &text[..end]
}

/// A line with single blanks between its words, outside of quotes.
fn single_blanks(line: &str) -> String {
    let (mut result, mut is_quoted) = (String::with_capacity(line.len()), false);
    for character in line.trim().chars() {
        is_quoted ^= character == '"';
        if !character.is_whitespace() || is_quoted {
            result.push(character);
        } else if !result.ends_with(' ') {
            result.push(' ');
        }
    }
    result
}
