//! All rows of a table to places.

use super::{
    layout::{Layout, Row},
    number::{Decimal, is_missing, may_divide_thousands, parse},
    separator::{Separator, line},
    text::decode,
};
use crate::note::Note;
use bevy::math::DVec2;
use csv::StringRecord;

/// Greatest number of points.
pub const MOST_POINTS: usize = 1_000_000;
/// Rows among which the header is looked for.
const HEAD: usize = 40;
/// Lines that are named of each kind of rows that were left out.
const MOST_LINES_NAMED: usize = 8;
/// Characters of a wrong field that are shown.
const MOST_SHOWN: usize = 40;

/// The places of a table.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// Places, m.
    pub points: Vec<DVec2>,
    /// What should be known about the table.
    pub notes: Vec<Note>,
}

/// Reads the places of a table; `columns` are the names of those of x and y, where they are told. `check` says what is wrong with a place.
///
/// # Errors
/// In one line, with the line of the table: where there is no telling what is meant, a number cannot be read, `check` refuses a place, or
/// there are more than [`MOST_POINTS`].
pub fn read_table(
    bytes: &[u8],
    columns: Option<&[String; 2]>,
    check: impl Fn(DVec2) -> Result<(), String>,
) -> Result<Table, String> {
    let text = decode(bytes)?;
    let separator = Separator::of(&text);
    let text = separator.prepare(&text);
    let layout = Layout::of(&head(separator, &text)?, separator, columns)?;
    let mut reading = Reading::new(&layout, separator);
    let (mut reader, mut record, mut index) = (separator.reader(&text), StringRecord::new(), 0);
    while reader.read_record(&mut record).map_err(|error| error.to_string())? {
        let outcome =
            if index < layout.rows_above { reading.above(index, &text, &record) } else { reading.row(&text, &record) };
        let place = outcome.map_err(|error| format!("line {}: {error}", line(&text, &record)))?;
        if let Some(place) = place {
            check(place).map_err(|error| format!("line {}: {error}", line(&text, &record)))?;
            if reading.points.len() == MOST_POINTS {
                return Err(format!("line {}: more than {MOST_POINTS} points", line(&text, &record)));
            }
            reading.points.push(place);
        }
        index += 1;
    }
    Ok(reading.into_table())
}

/// The first rows.
fn head(separator: Separator, text: &str) -> Result<Vec<Row>, String> {
    let mut rows = Vec::new();
    for record in separator.reader(text).records().take(HEAD) {
        let record = record.map_err(|error| error.to_string())?;
        rows.push(Row { line: line(text, &record), fields: record.iter().map(str::to_owned).collect() });
    }
    Ok(rows)
}

/// What has been read of a table.
struct Reading<'a> {
    layout: &'a Layout,
    separator: Separator,
    points: Vec<DVec2>,
    titles: Vec<u64>,
    empty: Vec<u64>,
    without_place: Vec<u64>,
    /// The first field with either decimal mark.
    marks: [Option<String>; 2],
}

impl<'a> Reading<'a> {
    fn new(layout: &'a Layout, separator: Separator) -> Self {
        let (titles, empty, without_place) = (Vec::new(), Vec::new(), Vec::new());
        Self { layout, separator, points: Vec::new(), titles, empty, without_place, marks: [None, None] }
    }

    /// A title, or a row of the header.
    fn above(&mut self, index: usize, text: &str, record: &StringRecord) -> Result<Option<DVec2>, String> {
        if index + self.layout.header_rows < self.layout.rows_above {
            self.titles.push(line(text, record));
        }
        Ok(None)
    }

    /// The place of a row, if it has one.
    fn row(&mut self, text: &str, record: &StringRecord) -> Result<Option<DVec2>, String> {
        if record.iter().all(str::is_empty) {
            self.empty.push(line(text, record));
            return Ok(None);
        }
        self.require_fields(record)?;
        let [x, y] = self.layout.columns.map(|column| field(record, column));
        let (x, y) = (x?, y?);
        if is_missing(x) || is_missing(y) {
            self.without_place.push(line(text, record));
            return Ok(None);
        }
        let [x_m, y_m] = self.layout.units_m;
        let place = DVec2::new(self.number(x, 0)? * x_m, self.number(y, 1)? * y_m);
        Ok(Some(place))
    }

    /// Refuses a row with more fields than the header, unless the others are empty.
    fn require_fields(&self, record: &StringRecord) -> Result<(), String> {
        let Some(fields) = self.layout.fields else { return Ok(()) };
        if record.iter().skip(fields).all(str::is_empty) {
            return Ok(());
        }
        let commas = match self.separator {
            Separator::Comma => {
                ": if numbers have decimal commas, separate columns by semicolons, or put numbers in quotes"
            }
            _ => "",
        };
        Err(format!("the row has {} fields, but the header has {fields}{commas}", record.len()))
    }

    /// The number in a field, whose decimal mark is the same in all of the table.
    fn number(&mut self, field: &str, axis: usize) -> Result<f64, String> {
        let column = self.layout.columns[axis] + 1;
        let Some((number, decimal)) = parse(field) else {
            return Err(format!("column {column} is `{}`, but must be a finite number", shown(field)));
        };
        if decimal == Decimal::Comma && self.separator == Separator::Comma && may_divide_thousands(field) {
            return Err(format!(
                "column {column} is `{field}`, which may have a decimal comma or be thousands: write it with a point"
            ));
        }
        let (own, other) = match decimal {
            Decimal::Whole => return Ok(number),
            Decimal::Point => (0, 1),
            Decimal::Comma => (1, 0),
        };
        if let Some(other) = &self.marks[other] {
            let which = ["a decimal point", "a decimal comma"][own];
            return Err(format!("column {column} is `{}` with {which}, but there was `{other}` before", shown(field)));
        }
        if self.marks[own].is_none() {
            self.marks[own] = Some(shown(field));
        }
        Ok(number)
    }

    fn into_table(self) -> Table {
        let mut notes = self.layout.notes.clone();
        let left_out = [
            (&self.titles, "above the header have no places"),
            (&self.empty, "are empty"),
            (&self.without_place, "have no place"),
        ];
        let told = left_out.into_iter().filter(|(lines, _)| !lines.is_empty());
        notes.extend(
            told.map(|(lines, why)| {
                Note::new(format!("{} rows {why} and were left out: {}", lines.len(), named(lines)))
            }),
        );
        Table { points: self.points, notes }
    }
}

fn field(record: &StringRecord, column: usize) -> Result<&str, String> {
    let name = column + 1;
    record.get(column).ok_or_else(|| format!("there is no column {name}, but x and y must be given"))
}

fn shown(field: &str) -> String {
    field.escape_debug().take(MOST_SHOWN).collect()
}

/// The numbers of lines, the first few of many.
fn named(lines: &[u64]) -> String {
    let first: Vec<String> = lines.iter().take(MOST_LINES_NAMED).map(u64::to_string).collect();
    let word = if lines.len() == 1 { "line" } else { "lines" };
    let rest = if lines.len() > MOST_LINES_NAMED { " and more" } else { "" };
    format!("{word} {}{rest}", first.join(", "))
}
