//! Numbers of a table, and what stands for a missing one.

/// What programs and people write where they have no number.
const MISSING: [&str; 13] = ["", "na", "n/a", "#n/a", "nan", "null", "none", "nil", "-", "--", ".", "?", "missing"];

/// The mark between whole and parts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Decimal {
    /// None: a whole number.
    Whole,
    Point,
    Comma,
}

/// Whether a field says that there is no number.
pub fn is_missing(field: &str) -> bool {
    MISSING.iter().any(|missing| field.eq_ignore_ascii_case(missing))
}

/// A finite number and its decimal mark. With one comma and no point the comma is the mark.
pub fn parse(field: &str) -> Option<(f64, Decimal)> {
    // Typesetting has a minus of its own.
    let field = &field.replace('\u{2212}', "-");
    let (text, decimal) = match (field.matches(',').count(), field.contains('.')) {
        (0, true) => (field.clone(), Decimal::Point),
        (0, false) => (field.clone(), Decimal::Whole),
        (1, false) => (field.replace(',', "."), Decimal::Comma),
        _ => return None,
    };
    // The standard library also takes `inf` and `infinity`.
    text.parse::<f64>().ok().filter(|number| number.is_finite()).map(|number| (number, decimal))
}

/// Whether a comma may as well divide thousands: 1,234.
pub fn may_divide_thousands(field: &str) -> bool {
    let Some((before, after)) = field.split_once(',') else { return false };
    let before = before.trim_start_matches(['+', '-']);
    (1..=3).contains(&before.len()) && after.len() == 3 && before != "0"
}
