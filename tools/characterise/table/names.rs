//! Names of columns, and units of length in them.

/// Names of the two columns, without blanks, dashes and the like, in the order in which they are taken.
const PAIRS: [[&str; 2]; 25] = [
    ["x", "y"],
    ["gx", "gy"],
    ["px", "py"],
    ["lx", "ly"],
    ["easting", "northing"],
    ["eastings", "northings"],
    ["east", "north"],
    ["utme", "utmn"],
    ["utmx", "utmy"],
    ["xutm", "yutm"],
    ["xcoord", "ycoord"],
    ["coordx", "coordy"],
    ["xcoordinate", "ycoordinate"],
    ["xpos", "ypos"],
    ["posx", "posy"],
    ["xposition", "yposition"],
    ["xlocal", "ylocal"],
    ["localx", "localy"],
    ["pointx", "pointy"],
    ["treex", "treey"],
    ["stemx", "stemy"],
    ["plotx", "ploty"],
    ["rechtswert", "hochwert"],
    ["xkoordinate", "ykoordinate"],
    ["e", "n"],
];

/// Names of degrees, which are no lengths.
const DEGREES: [[&str; 2]; 4] = [["lon", "lat"], ["long", "lat"], ["lng", "lat"], ["longitude", "latitude"]];

/// Units of length, m.
const UNITS: [(&str, f64); 25] = [
    ("m", 1.0),
    ("metre", 1.0),
    ("metres", 1.0),
    ("meter", 1.0),
    ("meters", 1.0),
    ("mm", 1e-3),
    ("cm", 1e-2),
    ("dm", 0.1),
    ("km", 1e3),
    ("centimetres", 1e-2),
    ("centimeters", 1e-2),
    ("kilometres", 1e3),
    ("kilometers", 1e3),
    ("in", 0.0254),
    ("inch", 0.0254),
    ("inches", 0.0254),
    ("ft", 0.3048),
    ("foot", 0.3048),
    ("feet", 0.3048),
    ("yd", 0.9144),
    ("yard", 0.9144),
    ("yards", 0.9144),
    ("chain", 20.1168),
    ("chains", 20.1168),
    ("link", 0.201168),
];

/// What a name says of the unit.
#[derive(Clone, Debug, PartialEq)]
pub enum Unit {
    /// Nothing.
    Unsaid,
    /// A length, m.
    Length(f64),
    /// Something in brackets that is no unit of length.
    Unknown(String),
}

/// A name without its unit and without blanks, dashes, dots and underscores, in small letters; and the unit.
pub fn split(name: &str) -> (String, Unit) {
    let name = name.trim().to_lowercase();
    let bracketed = name.strip_suffix([')', ']']).and_then(|name| name.rsplit_once(['(', '[']));
    if let Some((name, unit)) = bracketed {
        let unit = length_m(unit.trim()).map_or_else(|| Unit::Unknown(unit.trim().to_owned()), Unit::Length);
        return (plain(name), unit);
    }
    if let Some((start, unit)) = name.rsplit_once(['_', ' ', '.', '-'])
        && let Some(unit_m) = length_m(unit)
    {
        return (plain(start), Unit::Length(unit_m));
    }
    (plain(&name), Unit::Unsaid)
}

/// Metres of a unit of length.
pub fn length_m(unit: &str) -> Option<f64> {
    UNITS.iter().find(|(name, _)| unit.eq_ignore_ascii_case(name)).map(|(_, length_m)| *length_m)
}

fn plain(name: &str) -> String {
    name.chars().filter(|character| character.is_alphanumeric()).collect()
}

/// The two columns of a row that names them as is usual.
///
/// # Errors
/// Where two columns have one of the names.
pub fn known_pair(row: &[String]) -> Result<Option<[usize; 2]>, String> {
    pair_of(row, &PAIRS)
}

/// Whether a row names columns of degrees.
pub fn has_degrees(row: &[String]) -> bool {
    pair_of(row, &DEGREES).is_ok_and(|pair| pair.is_some())
}

fn pair_of(row: &[String], pairs: &[[&str; 2]]) -> Result<Option<[usize; 2]>, String> {
    let names: Vec<String> = row.iter().map(|name| split(name).0).collect();
    for pair in pairs {
        if pair.iter().all(|name| names.iter().any(|known| known == name)) {
            let [x, y] = pair.map(|name| only(&names, name));
            return Ok(Some([x?, y?]));
        }
    }
    Ok(None)
}

/// The one column of a name.
fn only(names: &[String], name: &str) -> Result<usize, String> {
    let mut found = (0..names.len()).filter(|&column| names[column] == name);
    match (found.next(), found.next()) {
        (Some(column), None) => Ok(column),
        _ => Err(format!("more than one column is called `{name}`: say which two are meant by `--columns NAME,NAME`")),
    }
}

/// The column that a row calls `wanted`: by all its letters, or else by its name without the unit.
pub fn column_named(row: &[String], wanted: &str) -> Option<usize> {
    let wanted = wanted.trim();
    let exact = row.iter().position(|name| name.trim().to_lowercase() == wanted.to_lowercase());
    exact.or_else(|| row.iter().position(|name| split(name).0 == split(wanted).0 && !split(name).0.is_empty()))
}
