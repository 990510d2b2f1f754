//! Tables as people have them: the given files, and more of their kind.

use super::{rows::MOST_POINTS, *};
use crate::note::Note;
use bevy::math::DVec2;
use std::path::Path;

const CASES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/cases/tables");

fn read_case(name: &str) -> Result<Table, String> {
    let bytes = std::fs::read(Path::new(CASES).join(name)).expect("the case is there");
    read_table(&bytes, None, |_| Ok(()))
}

fn case(name: &str) -> Table {
    read_case(name).unwrap_or_else(|error| panic!("{name}: {error}"))
}

fn read(text: &str) -> Result<Vec<DVec2>, String> {
    read_table(text.as_bytes(), None, |_| Ok(())).map(|table| table.points)
}

fn read_columns(text: &str, x: &str, y: &str) -> Result<Vec<DVec2>, String> {
    read_table(text.as_bytes(), Some(&[x.to_owned(), y.to_owned()]), |_| Ok(())).map(|table| table.points)
}

fn notes(table: &Table) -> Vec<&str> {
    table.notes.iter().map(|note: &Note| note.text.as_str()).collect()
}

/// Two places, as text in `line`, read as 1.5, -2 and 300, 4.25.
fn two_places() -> Vec<DVec2> {
    vec![DVec2::new(1.5, -2.0), DVec2::new(300.0, 4.25)]
}

#[test]
fn the_same_places_are_read_from_all_given_tables() {
    let expected = case("blanks.txt").points;
    assert_eq!(expected.len(), 80);
    assert_eq!((expected[0], expected[79]), (DVec2::new(15.43, 39.94), DVec2::new(42.87, 58.78)));
    let same = [
        "semicolon-decimal-comma.csv",
        "semicolon-bom-names.csv",
        "tabs.tsv",
        "census.csv",
        "units-in-header.csv",
        "title-line.csv",
        "empty-rows-at-end.csv",
    ];
    for name in same {
        assert_eq!(case(name).points, expected, "{name}");
    }
    for (utm, local) in case("utm.csv").points.iter().zip(&expected) {
        assert!((utm - DVec2::new(512_000.0, 4_649_000.0) - local).abs().max_element() < 1e-6, "{utm}");
    }
    assert_eq!(case("every-point-three-times.csv").points.len(), 240);
    let mut without_missing = expected;
    without_missing.remove(40);
    assert_eq!(case("missing-values.csv").points, without_missing);
}

#[test]
fn rows_that_are_left_out_are_told() {
    for name in ["blanks.txt", "tabs.tsv", "census.csv", "units-in-header.csv", "utm.csv", "semicolon-bom-names.csv"] {
        assert_eq!(case(name).notes, [], "{name}");
    }
    assert_eq!(notes(&case("title-line.csv")), ["1 rows above the header have no places and were left out: line 1"]);
    assert_eq!(notes(&case("missing-values.csv")), ["1 rows have no place and were left out: line 42"]);
    assert_eq!(notes(&case("empty-rows-at-end.csv")), ["3 rows are empty and were left out: lines 82, 83, 84"]);
    let many = format!("x,y\n{}1,2\n", "NA,3\n".repeat(20));
    let many = read_table(many.as_bytes(), None, |_| Ok(())).unwrap();
    assert_eq!(notes(&many), ["20 rows have no place and were left out: lines 2, 3, 4, 5, 6, 7, 8, 9 and more"]);
}

#[test]
fn unquoted_decimal_commas_are_refused_and_quoted_ones_read() {
    let error = read_case("decimal-comma-unquoted.csv").unwrap_err();
    assert_eq!(
        error,
        "line 2: the row has 4 fields, but the header has 2: if numbers have decimal commas, separate columns by semicolons, or put numbers \
         in quotes"
    );
    assert_eq!(read("x,y\n\"1,5\",\"-2\"\n\"300\",\"4,25\"\n"), Ok(two_places()));
    assert!(read("x,y\n15,43,39\n72,18,2\n").unwrap_err().starts_with("line 2: the row has 3 fields"));
    assert!(read("15,43,39,94\n72,18,2,30\n").unwrap_err().contains("4 whole numbers and no header"));
    assert!(read("x,y\n\"1,234\",5\n").unwrap_err().contains("may have a decimal comma or be thousands"));
    assert!(
        read("x;y\n1,5;2,5\n1.234;3\n").unwrap_err().starts_with("line 3: column 1 is `1.234` with a decimal point")
    );
    assert!(read("x;y\n1.234,5;2\n").unwrap_err().contains("`1.234,5`, but must be a finite number"));
}

#[test]
fn separators_are_found_out() {
    for text in [
        "x,y\n1.5,-2\n300,4.25\n",
        "x;y\n1.5;-2\n300;4.25\n",
        "x;y\n1,5;-2\n300;4,25\n",
        "x\ty\n1,5\t-2\n300\t4,25\n",
        "x | y\n1.5 | -2\n300 | 4.25\n",
        "x   y\n  1,5   -2\n300 \t 4,25\n",
        "1.5, -2\n300, 4.25",
        "1.5 -2\r\n300 4.25\r\n",
        "1.5;-2\r300;4.25\r",
        "sep=;\nx;y\n1,5;-2\n300;4,25\n",
        "Stems of plot 7, 2019\nx,y\n1.5,-2\n300,4.25\n",
        "\u{feff}x,y\n1.5,-2\n300,4.25",
        "# trees\r\nY, species, X\r\n-2, oak, 1.5\r\n4.25, fir, 3e2",
        "species;gx;gy\nQuercus robur;1,5;-2\n\"Fir; old\";300;4,25\n",
        "\"tag\" \"x\" \"y\"\n\"old oak\" 1.5 -2\n\"fir\" 300 4.25\n",
    ] {
        assert_eq!(read(text), Ok(two_places()), "{text}");
    }
    assert_eq!(read(""), Ok(vec![]));
}

#[test]
fn tables_of_spreadsheets_and_of_statistics_are_read() {
    let utf16: Vec<u8> = [0xff, 0xfe]
        .into_iter()
        .chain("x\ty\r\n1,5\t-2\r\n300\t4,25\r\n".encode_utf16().flat_map(u16::to_le_bytes))
        .collect();
    assert_eq!(read_table(&utf16, None, |_| Ok(())).map(|table| table.points), Ok(two_places()));
    // R writes the names of rows, but no name for their column.
    assert_eq!(read("\"x\" \"y\"\n\"1\" 1.5 -2\n\"2\" 300 4.25\n"), Ok(two_places()));
    assert_eq!(read("\"\",\"x\",\"y\"\n\"1\",1.5,-2\n\"2\",300,4.25\n"), Ok(two_places()));
    assert_eq!(read("x,y,\n1.5,-2,\n300,4.25,\n"), Ok(two_places()));
    let latin = b"x;y;H\xf6he\n1,5;-2;3\n300;4,25;4\n";
    assert_eq!(read_table(latin, None, |_| Ok(())).map(|table| table.points), Ok(two_places()));
    assert!(read_table(b"PK\x03\x04....", None, |_| Ok(())).unwrap_err().contains("export it as CSV"));
    assert!(read_table(b"x,y\n1,\x002\n", None, |_| Ok(())).unwrap_err().starts_with("no text"));
}

#[test]
fn columns_are_known_by_their_usual_names() {
    for names in [
        "X Coord,Y Coord",
        "UTM_E,UTM_N",
        "PX,PY",
        "x_m,y_m",
        "East [m],North [m]",
        "Rechtswert,Hochwert",
        "x (metres),y (metres)",
    ] {
        assert_eq!(read(&format!("{names}\n1.5,-2\n300,4.25\n")), Ok(two_places()), "{names}");
    }
    assert_eq!(read("id,tag,gx,gy\n1,7,1.5,-2\n2,8,300,4.25\n"), Ok(two_places()));
    let error = |text: &str| read(text).unwrap_err();
    assert!(error("a,b\n1,2\n3,4\n").starts_with("line 1: no two of the columns `a`, `b` have a name that is known"));
    assert!(error("lon,lat\n7.5,46.2\n").contains("degrees of longitude and latitude"));
    assert!(error("x (deg),y (deg)\n7.5,46.2\n").contains("degrees"));
    assert!(error("x (m),x (ft),y\n1,2,3\n").contains("more than one column is called `x`"));
}

#[test]
fn columns_may_be_told() {
    let text = "a,b,c\n1.5,9,-2\n300,9,4.25\n";
    assert_eq!(read_columns(text, "A", "c"), Ok(two_places()));
    assert_eq!(read_columns(text, "1", "3"), Ok(two_places()));
    assert_eq!(read_columns("1.5 9 -2\n300 9 4.25\n", "1", "3"), Ok(two_places()));
    assert_eq!(read_columns("Stem plan\n\nE (cm);N (cm)\n150;-200\n30000;425\n", "E", "N"), Ok(two_places()));
    let error = |x, y| read_columns(text, x, y).unwrap_err();
    assert_eq!(error("a", "d"), "no row has the columns `a` and `d`; the first row has `a`, `b`, `c`");
    assert!(error("a", "a").contains("the same column"));
    assert!(error("1", "9").starts_with("line 1: there is no column 9"));
}

#[test]
fn lengths_are_those_of_the_header() {
    let table = read_table(b"x (ft),y [cm]\n10,250\n20,300\n", None, |_| Ok(())).unwrap();
    assert_eq!(table.points[0], DVec2::new(10.0 * 0.3048, 2.5));
    assert!(table.notes[0].text.contains("the unit of the column `x (ft)` is 0.3048 m"), "{:?}", table.notes);
    assert_eq!(read("plot 3\nid;x;y\n;M;cm\n1;1,5;-200\n2;300;425\n"), Ok(two_places()));
    let table = read_table(b"x (OSGB),y (OSGB)\n10,250\n20,300\n", None, |_| Ok(())).unwrap();
    assert!(table.notes[0].is_warning && table.notes[0].text.contains("metres were taken"), "{:?}", table.notes);
}

#[test]
fn errors_name_line_and_value() {
    let error = |text: &str| read(text).unwrap_err();
    assert_eq!(error("1,2\n-inf,3"), "line 2: column 1 is `-inf`, but must be a finite number");
    assert_eq!(error("1,2\noak,3"), "line 2: column 1 is `oak`, but must be a finite number");
    assert_eq!(error("1,2\n7"), "line 2: there is no column 2, but x and y must be given");
    assert_eq!(error("x,y\n1,2\nsum,3\n"), "line 3: column 1 is `sum`, but must be a finite number");
    let far = read_table(b"1,2\n7,2000", None, |place| if place.y > 1e3 { Err("far".to_owned()) } else { Ok(()) });
    assert_eq!(far.unwrap_err(), "line 2: far");
    for end in ["\n", "\r\n"] {
        let text = ["# trees", "x,y", "", "# by hand", "1,2", "", "# more", "oak,3", ""].join(end);
        assert!(error(&text).starts_with("line 8: "), "{}", error(&text));
    }
}

#[test]
fn invalid_input_is_an_error_or_nothing_and_never_a_panic() {
    assert!(read_table(&[0xff, 0xfe, 0x00, b',', 0x80], None, |_| Ok(())).is_err());
    assert!(read(&"\"oak,".repeat(100_000)).is_err());
    assert!(read(&"0,0\n".repeat(MOST_POINTS + 1)).unwrap_err().ends_with("more than 1000000 points"));
    // Every byte of a table in turn replaced by others.
    let table = "id;x (m);y\n1;1,5;-2\n2;\"300\";4,25\n";
    for at in 0..table.len() {
        for other in [b',', b'"', b' ', b'\n', b'#', b';', b'9', 0, 0xff] {
            let mut bytes = table.as_bytes().to_vec();
            bytes[at] = other;
            if let Ok(table) = read_table(&bytes, None, |_| Ok(())) {
                assert!(table.points.iter().all(|point| point.is_finite()));
            }
        }
    }
}
