//! Reads the places of real plants from CSV.

use std::io::Read;

use bevy::math::DVec2;
use csv::{ByteRecord, ReaderBuilder, Trim};

use crate::scatter::error::ScatterError;

/// More points than this are refused: they take 160 MB.
pub const MOST_POINTS: usize = 10_000_000;
/// Longer than any pair of numbers: a line that is longer is no line of points.
const LONGEST_LINE_BYTES: usize = 1 << 16;

/// Reads points, m: the first two columns of comma-separated values, or the columns `x` and `y` if the first line is a
/// header that names them. Lines that begin with # are comments. (The line that an error names is the first after the last
/// good one: blank lines and comments may come between.)
///
/// # Errors
/// [`ScatterError::Points`] with the line where a number is missing, unreadable, infinite or not a number, where the file
/// cannot be read, or where it holds more than [`MOST_POINTS`].
pub fn read_points(source: impl Read) -> Result<Vec<DVec2>, ScatterError> {
    let mut reader =
        ReaderBuilder::new().has_headers(false).flexible(true).trim(Trim::All).comment(Some(b'#')).from_reader(source);
    let (mut record, mut points) = (ByteRecord::new(), Vec::new());
    let (mut columns, mut first) = ([0, 1], true);
    while reader.read_byte_record(&mut record).map_err(unreadable)? {
        let line = record.position().map_or(0, csv::Position::line);
        if std::mem::take(&mut first)
            && let Some(named) = header(&record)
        {
            columns = named;
            continue;
        }
        let refuse = |message: String| ScatterError::Points { line, message };
        if record.as_slice().len() > LONGEST_LINE_BYTES {
            return Err(refuse(format!("longer than {LONGEST_LINE_BYTES} bytes")));
        }
        if points.len() == MOST_POINTS {
            return Err(refuse(format!("more than {MOST_POINTS} points")));
        }
        let [x, y] = columns.map(|column| number(&record, column));
        points.push(DVec2::new(x.map_err(refuse)?, y.map_err(refuse)?));
    }
    Ok(points)
}

/// The columns of x and y, if the record names them.
fn header(record: &ByteRecord) -> Option<[usize; 2]> {
    let column = |name: &str| record.iter().position(|field| field.eq_ignore_ascii_case(name.as_bytes()));
    Some([column("x")?, column("y")?])
}

fn number(record: &ByteRecord, column: usize) -> Result<f64, String> {
    let name = column + 1;
    let field = record.get(column).ok_or_else(|| format!("no column {name}"))?;
    let text = String::from_utf8_lossy(field);
    let value: f64 = text.parse().map_err(|_| format!("column {name} is `{text:.40}`, but must be a number"))?;
    if !value.is_finite() {
        return Err(format!("column {name} is {value}, but must be a finite number"));
    }
    Ok(value)
}

fn unreadable(error: csv::Error) -> ScatterError {
    let line = error.position().map_or(0, csv::Position::line);
    ScatterError::Points { line, message: error.to_string() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Vec<DVec2>, String> {
        read_points(text.as_bytes()).map_err(|error| error.to_string())
    }

    #[test]
    fn points_are_read_with_and_without_a_header() {
        let expected = vec![DVec2::new(1.5, -2.0), DVec2::new(3e2, 4.0)];
        assert_eq!(read("1.5,-2\n300,4\n"), Ok(expected.clone()));
        assert_eq!(read("# trees\r\nY, species, X\r\n-2, oak, 1.5\r\n4, fir, 3e2"), Ok(expected));
        assert_eq!(read(""), Ok(vec![]));
    }

    #[test]
    fn what_is_no_point_is_named_with_its_line() {
        let error = |text: &str| read(text).unwrap_err();
        assert_eq!(error("x,y\n1,2\n3,NaN\n"), "points, line 3: column 2 is NaN, but must be a finite number");
        assert_eq!(error("1,2\n-inf,3"), "points, line 2: column 1 is -inf, but must be a finite number");
        assert_eq!(error("1,2\noak,3"), "points, line 2: column 1 is `oak`, but must be a number");
        assert_eq!(error("1,2\n7"), "points, line 2: no column 2");
    }

    #[test]
    fn nonsense_is_refused_without_panic() {
        assert!(read_points(&[0xff, 0xfe, 0x00, b',', 0x80][..]).is_err());
        assert!(read(&"\"1,".repeat(100_000)).is_err());
    }
}
