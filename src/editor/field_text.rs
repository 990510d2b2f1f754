//! What the name and the documentation of a field say about it: its label, its unit, its range.

use std::ops::RangeInclusive;

/// Endings of names that are units, the longest first, with how the unit is written and by what values are multiplied to be shown in it.
const SUFFIXES: [(&str, &str, f64); 16] = [
    ("_per_year", "/a", 1.0),
    ("_kg_m3", "kg/m³", 1.0),
    ("_kg_m2", "kg/m²", 1.0),
    ("_m_s", "m/s", 1.0),
    ("_per_m", "/m", 1.0),
    ("_years", "a", 1.0),
    ("_texels", "texels", 1.0),
    ("_heights", "heights", 1.0),
    ("_frame", "", 1.0),
    ("_deg", "°", 1.0),
    ("_rad", "rad", 1.0),
    ("_pa", "GPa", 1e-9),
    ("_hz", "Hz", 1.0),
    ("_px", "px", 1.0),
    ("_m", "m", 1.0),
    ("_s", "s", 1.0),
];

/// Units that documentation names behind a comma, where the field's own name has none.
const UNITS_IN_DOCS: [&str; 4] = ["m/s", "m", "s", "Hz"];

/// How a value is shown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    /// Written behind the value.
    pub symbol: &'static str,
    /// What the value is multiplied by to be shown.
    pub factor: f64,
}

/// The label of a field: its name in words, without the unit.
pub fn label(name: &str) -> String {
    let (stem, _) = split_unit(name);
    let words = stem.replace('_', " ");
    let mut letters = words.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// The unit of a field, by its name, or else by its documentation.
pub fn unit(name: &str, docs: &str) -> Option<Unit> {
    let of_docs = || {
        let is_named = |unit: &&&str| {
            let [before_colon, before_stop] = [format!(", {unit}:"), format!(", {unit}.")];
            docs.contains(&before_colon) || docs.contains(&before_stop) || docs.contains(&format!("units: {unit},"))
        };
        UNITS_IN_DOCS.iter().find(is_named).map(|symbol| Unit { symbol, factor: 1.0 })
    };
    split_unit(name).1.filter(|unit| !unit.symbol.is_empty()).or_else(of_docs)
}

fn split_unit(name: &str) -> (&str, Option<Unit>) {
    let ending = SUFFIXES.into_iter().find_map(|(suffix, symbol, factor)| {
        let stem = name.strip_suffix(suffix).filter(|stem| !["", "per"].contains(stem))?;
        // A rate keeps its words: `girth rate`, `changes per frame`.
        Some((if symbol.is_empty() { name } else { stem }, Some(Unit { symbol, factor })))
    });
    ending.unwrap_or((name, None))
}

/// The range that a [`SettingError`](crate::SettingError) allows, such as `a power of two, 8 to 1024`.
pub fn allowed_range(allowed: &str) -> Option<RangeInclusive<f64>> {
    let open = allowed.strip_prefix("at least ").and_then(|low| low.strip_suffix(" and finite")?.parse().ok());
    open.map(|low: f64| low..=f64::from(f32::MAX)).or_else(|| range(allowed.rsplit(", ").next()?))
}

/// The first range in a documentation: `0.5 to 120`, or `domain: [0.1, 10]`, or `0..=3`.
pub fn documented_range(docs: &str) -> Option<RangeInclusive<f64>> {
    let words: Vec<&str> = docs.split_whitespace().collect();
    let in_words = words.windows(3).find_map(|three| match three {
        [low, "to", high] => range(&format!("{low} to {high}")),
        _ => None,
    });
    let in_brackets = || {
        let inside = docs.split_once('[')?.1.split_once(']')?.0;
        let (low, high) = inside.split_once(", ")?;
        range(&format!("{low} to {high}"))
    };
    let in_rust = || words.iter().find_map(|word| range(&word.replace("..=", " to ")));
    in_words.or_else(in_brackets).or_else(in_rust)
}

fn range(text: &str) -> Option<RangeInclusive<f64>> {
    let number = |text: &str| {
        let text = text.trim().trim_end_matches(['.', ',', ':', ';']).replace(',', "");
        text.parse::<f64>().ok().filter(|number| number.is_finite())
    };
    let (low, high) = text.split_once(" to ")?;
    let (low, high) = (number(low)?, number(high)?);
    (low <= high).then_some(low..=high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_words_and_units() {
        let unit = |name| unit(name, "").map(|unit| unit.symbol);
        assert_eq!((label("height_m"), unit("height_m")), ("Height".into(), Some("m")));
        assert_eq!((label("young_modulus_pa"), unit("young_modulus_pa")), ("Young modulus".into(), Some("GPa")));
        assert_eq!((label("onset_speed_m_s"), unit("onset_speed_m_s")), ("Onset speed".into(), Some("m/s")));
        assert_eq!((label("height_rate_per_year"), unit("height_rate_per_year")), ("Height rate".into(), Some("/a")));
        assert_eq!((label("per_m"), unit("per_m")), ("Per m".into(), None));
        assert_eq!((label("changes_per_frame"), unit("changes_per_frame")), ("Changes per frame".into(), None));
        assert_eq!((label("gaps"), unit("gaps")), ("Gaps".into(), None));
        assert_eq!(super::unit("speed", "Mean speed at 10 m above ground, m/s. Range 0..=75.").unwrap().symbol, "m/s");
    }

    #[test]
    fn ranges_are_read_from_errors_and_from_documentation() {
        assert_eq!(allowed_range("0.5 to 17.2"), Some(0.5..=17.2));
        assert_eq!(allowed_range("a power of two, 8 to 1024"), Some(8.0..=1024.0));
        assert_eq!(allowed_range("at most 5 orders"), None);
        assert_eq!(allowed_range("at least 0 and finite"), Some(0.0..=f64::from(f32::MAX)));
        assert_eq!(documented_range("Height of the tree, m: 0.5 to 120."), Some(0.5..=120.0));
        assert_eq!(documented_range("Turn, degrees: -360 to 360. Turn 0 is level."), Some(-360.0..=360.0));
        assert_eq!(documented_range("Faster. domain: [0.1, 10]."), Some(0.1..=10.0));
        assert_eq!(documented_range("m/s. Range 0..=75. A breeze"), Some(0.0..=75.0));
        assert_eq!(documented_range("How it is built."), None);
        assert_eq!(documented_range("Where, `flush` to 0.95."), None);
    }
}
