//! Reads places of plants from comma-separated values.

use crate::options::Window;
use bevy::math::DVec2;
use csv::{ByteRecord, ReaderBuilder, Trim};

/// Greatest number of points.
pub const MOST_POINTS: usize = 1_000_000;
/// Greatest size of a file: a million lines of 256 bytes.
pub const MOST_BYTES: u64 = 256 << 20;

/// Reads points, m: the first two columns, or the columns `x` and `y` if the first line is a header that names them.
/// Lines that begin with # are comments.
///
/// # Errors
/// With the line where a number is missing, unreadable, infinite or not a number, a point lies outside `window`, or the
/// points become more than [`MOST_POINTS`].
pub fn read_points(bytes: &[u8], window: &Window) -> Result<Vec<DVec2>, String> {
    let mut reader =
        ReaderBuilder::new().has_headers(false).flexible(true).trim(Trim::All).comment(Some(b'#')).from_reader(bytes);
    let (mut record, mut points) = (ByteRecord::new(), Vec::new());
    let (mut columns, mut first) = ([0, 1], true);
    while reader.read_byte_record(&mut record).map_err(|error| error.to_string())? {
        if std::mem::take(&mut first)
            && let Some(named) = header(&record)
        {
            columns = named;
            continue;
        }
        match point(&record, columns, window) {
            Ok(_) if points.len() == MOST_POINTS => {
                return Err(format!("{}: more than {MOST_POINTS} points", line(bytes, &record)));
            }
            Ok(point) => points.push(point),
            Err(error) => return Err(format!("{}: {error}", line(bytes, &record))),
        }
    }
    Ok(points)
}

/// The columns of x and y, if the record names them.
fn header(record: &ByteRecord) -> Option<[usize; 2]> {
    let column = |name: &str| record.iter().position(|field| field.eq_ignore_ascii_case(name.as_bytes()));
    Some([column("x")?, column("y")?])
}

fn point(record: &ByteRecord, [x, y]: [usize; 2], window: &Window) -> Result<DVec2, String> {
    let point = DVec2::new(number(record, x)?, number(record, y)?);
    if window.contains(point) {
        return Ok(point);
    }
    let (min_m, max_m) = (window.min_m, window.max_m);
    Err(format!("the point {point} is outside the window, but must be from {min_m} to {max_m}"))
}

fn number(record: &ByteRecord, column: usize) -> Result<f64, String> {
    let name = column + 1;
    let field = record.get(column).ok_or_else(|| format!("there is no column {name}, but x and y must be given"))?;
    let text = String::from_utf8_lossy(field);
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        _ => {
            let start: String = text.escape_debug().take(40).collect();
            Err(format!("column {name} is `{start}`, but must be a finite number"))
        }
    }
}

/// The line of a record, as `line N`. The position of a record is the end of the one before, so blank lines and comments may
/// follow it.
fn line(bytes: &[u8], record: &ByteRecord) -> String {
    let Some(position) = record.position() else { return "a line".to_owned() };
    let rest = bytes.get(position.byte() as usize..).unwrap_or_default();
    let is_passed_over = |line: &&[u8]| line.trim_ascii().is_empty() || line.starts_with(b"#");
    let passed_over = rest.split(|&byte| byte == b'\n').take_while(is_passed_over).count();
    format!("line {}", position.line() + passed_over as u64)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Vec<DVec2>, String> {
        let window = Window { min_m: DVec2::new(-10.0, -10.0), max_m: DVec2::splat(1000.0) };
        read_points(text.as_bytes(), &window)
    }

    #[test]
    fn header_is_optional() {
        let expected = vec![DVec2::new(1.5, -2.0), DVec2::new(3e2, 4.0)];
        assert_eq!(read("1.5,-2\n300,4\n"), Ok(expected.clone()));
        assert_eq!(read("\u{feff}x,y\n1.5,-2\n300,4"), Ok(expected.clone()));
        assert_eq!(read("# trees\r\nY, species, X\r\n-2, oak, 1.5\r\n4, fir, 3e2"), Ok(expected));
        assert_eq!(read(""), Ok(vec![]));
    }

    #[test]
    fn errors_name_line_and_value() {
        let error = |text: &str| read(text).unwrap_err();
        assert_eq!(error("x,y\n1,2\n3,NaN\n"), "line 3: column 2 is `NaN`, but must be a finite number");
        assert_eq!(error("1,2\n-inf,3"), "line 2: column 1 is `-inf`, but must be a finite number");
        assert_eq!(error("1,2\noak,3"), "line 2: column 1 is `oak`, but must be a finite number");
        assert_eq!(error("1,2\n7"), "line 2: there is no column 2, but x and y must be given");
        assert_eq!(
            error("1,2\n7,2000"),
            "line 2: the point [7, 2000] is outside the window, but must be from [-10, -10] to [1000, 1000]"
        );
    }

    #[test]
    fn comments_and_blank_lines_count_as_lines() {
        for end in ["\n", "\r\n"] {
            let text = ["# trees", "x,y", "", "# by hand", "1,2", "", "# more", "oak,3", ""].join(end);
            assert!(read(&text).unwrap_err().starts_with("line 8: "), "{}", read(&text).unwrap_err());
        }
    }

    #[test]
    fn invalid_input_is_an_error() {
        let window = Window { min_m: DVec2::ZERO, max_m: DVec2::ONE };
        assert!(read_points(&[0xff, 0xfe, 0x00, b',', 0x80], &window).is_err());
        assert!(read(&"\"1,".repeat(100_000)).is_err());
        assert!(read(&"0,0\n".repeat(MOST_POINTS + 1)).unwrap_err().ends_with("more than 1000000 points"));
    }
}
