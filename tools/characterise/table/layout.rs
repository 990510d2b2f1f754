//! Where the header of a table is, and which two columns have the places.

use super::{
    names::{Unit, column_named, has_degrees, known_pair, length_m, split},
    number::parse,
    separator::Separator,
};
use crate::note::Note;

/// A row of the start of a table, with its line.
pub struct Row {
    pub line: u64,
    pub fields: Vec<String>,
}

/// How a table is laid out.
#[derive(Clone, Debug, PartialEq)]
pub struct Layout {
    /// Rows above the first with data: titles, and then the header.
    pub rows_above: usize,
    /// The last of them, which are the header: names, and perhaps a row of units.
    pub header_rows: usize,
    /// Columns of x and y, from 0.
    pub columns: [usize; 2],
    /// Metres in a unit of x and of y.
    pub units_m: [f64; 2],
    /// Fields of the header, where there is one.
    pub fields: Option<usize>,
    /// What should be known of them.
    pub notes: Vec<Note>,
}

impl Layout {
    /// The layout of a table that starts with `head`. `wanted` are the columns of `--columns`.
    ///
    /// # Errors
    /// Where there is no telling which columns are meant.
    pub fn of(head: &[Row], separator: Separator, wanted: Option<&[String; 2]>) -> Result<Self, String> {
        if let Some(wanted) = wanted {
            return wanted_columns(head, wanted);
        }
        for (index, row) in head.iter().enumerate() {
            let in_line = |error| format!("line {}: {error}", row.line);
            if let Some(columns) = known_pair(&row.fields).map_err(in_line)? {
                return Self::below_header(head, index, columns);
            }
            if has_degrees(&row.fields) {
                return Err(in_line(
                    "the columns have degrees of longitude and latitude, but must have lengths: project them, to UTM for instance"
                        .to_owned(),
                ));
            }
        }
        Self::without_known_names(head, separator)
    }

    /// The layout of a table whose header is the row `index` of `head`.
    fn below_header(head: &[Row], index: usize, columns: [usize; 2]) -> Result<Self, String> {
        let header = &head[index];
        if columns[0] == columns[1] {
            return Err(format!("line {}: x and y are the same column, `{}`", header.line, header.fields[columns[0]]));
        }
        let mut notes = Vec::new();
        // Loggers and field books have a row of units below that of the names.
        let row_below =
            head.get(index + 1).map(|row| columns.map(|column| row.fields.get(column).and_then(|unit| length_m(unit))));
        let has_row_of_units = matches!(row_below, Some([Some(_), Some(_)]));
        let name = |column: usize| {
            let name = &header.fields[column];
            if has_row_of_units { format!("{name} ({})", head[index + 1].fields[column]) } else { name.clone() }
        };
        let units_m = columns.map(|column| unit_m(&name(column), &mut notes));
        let first = index + 1 + usize::from(has_row_of_units);
        let [Some(x_m), Some(y_m)] = units_m else {
            return Err(format!("line {}: the columns have degrees, but must have lengths", header.line));
        };
        let row_names = usize::from(has_row_names(header, &head[first..]));
        Ok(Self {
            rows_above: first,
            header_rows: first - index,
            columns: columns.map(|column| column + row_names),
            units_m: [x_m, y_m],
            fields: Some(header.fields.len() + row_names),
            notes,
        })
    }

    /// The layout of a table whose places are in its first two columns.
    fn without_known_names(head: &[Row], separator: Separator) -> Result<Self, String> {
        let is_number = |field: &String| parse(field).is_some();
        let has_place = |row: &Row| row.fields.len() > 1 && row.fields[..2].iter().all(is_number);
        let first = head.iter().position(has_place).unwrap_or(0);
        let width = head.get(first).map_or(0, |row| row.fields.len());
        let is_header = |row: &&Row| {
            row.fields.len() == width
                && width > 1
                && row.fields.iter().all(|field| !field.is_empty() && !is_number(field))
        };
        if let Some(header) = head[..first].iter().find(is_header) {
            return Err(format!(
                "line {}: no two of the columns `{}` have a name that is known for x and y: name them by `--columns NAME,NAME`",
                header.line,
                header.fields.join("`, `")
            ));
        }
        // 15,43,39,94: two numbers with decimal commas, or four whole ones?
        let is_whole = |row: &Row| row.fields.iter().all(|field| field.bytes().all(|byte| byte.is_ascii_digit()));
        let data = &head[first.min(head.len())..];
        if separator == Separator::Comma && width >= 4 && data.len() > 1 && data.iter().all(is_whole) {
            return Err(format!(
                "line {}: rows have {width} whole numbers and no header: if they are fewer numbers with decimal commas, separate them by \
                 semicolons; else say which are x and y by `--columns 1,2`",
                data[0].line
            ));
        }
        Ok(Self {
            rows_above: first,
            header_rows: 0,
            columns: [0, 1],
            units_m: [1.0, 1.0],
            fields: None,
            notes: Vec::new(),
        })
    }
}

/// The layout of a table whose columns are told, by name or by number.
fn wanted_columns(head: &[Row], wanted: &[String; 2]) -> Result<Layout, String> {
    for (index, row) in head.iter().enumerate() {
        if let [Some(x), Some(y)] = wanted.each_ref().map(|name| column_named(&row.fields, name)) {
            return Layout::below_header(head, index, [x, y]);
        }
    }
    let number = |name: &String| name.parse::<usize>().ok()?.checked_sub(1);
    if let [Some(x), Some(y)] = wanted.each_ref().map(number) {
        let is_data =
            |row: &Row| [x, y].iter().all(|column| row.fields.get(*column).is_some_and(|field| parse(field).is_some()));
        let rows_above = head.iter().position(is_data).unwrap_or(0);
        if x == y {
            return Err(format!("x and y are the same column, {}", wanted[0]));
        }
        return Ok(Layout {
            rows_above,
            header_rows: 0,
            columns: [x, y],
            units_m: [1.0, 1.0],
            fields: None,
            notes: Vec::new(),
        });
    }
    let there = head.first().map_or(String::new(), |row| row.fields.join("`, `"));
    Err(format!("no row has the columns `{}` and `{}`; the first row has `{there:.200}`", wanted[0], wanted[1]))
}

/// Metres in a unit of a column: `None` for degrees.
fn unit_m(name: &str, notes: &mut Vec<Note>) -> Option<f64> {
    match split(name).1 {
        Unit::Unsaid => Some(1.0),
        Unit::Length(unit_m) => {
            if unit_m != 1.0 {
                notes.push(Note::new(format!(
                    "the unit of the column `{name}` is {unit_m} m: its numbers were turned to metres"
                )));
            }
            Some(unit_m)
        }
        Unit::Unknown(unit) if unit.contains('°') || unit.starts_with("deg") => None,
        Unit::Unknown(_) => {
            notes.push(Note::warning(format!(
                "the column `{name}` says no unit of length that is known: metres were taken"
            )));
            Some(1.0)
        }
    }
}

/// Whether rows begin with a name that the header leaves out, as those of R do: with one field more, and running numbers in it.
fn has_row_names(header: &Row, rows: &[Row]) -> bool {
    let is_named = |(index, row): (usize, &Row)| {
        let number = row.fields.first().and_then(|field| field.parse::<usize>().ok());
        row.fields.len() == header.fields.len() + 1 && (number == Some(index) || number == Some(index + 1))
    };
    rows.len() > 1 && rows.iter().take(20).enumerate().all(is_named)
}
