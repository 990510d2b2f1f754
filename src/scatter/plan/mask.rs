//! A map of density, given as rows of digits.

use bevy::math::DVec2;

use super::place::{Place, in_f64};
use crate::setting::{SettingError, require};

pub(super) const MOST_POINTS_ALONG: usize = 4096;
/// The character of full density.
pub(super) const FULL: f32 = 9.0;

/// Checks the rows of a mask.
pub(super) fn validate(rows: &[String]) -> Result<(), SettingError> {
    require("rows.len()", rows.len(), 1..=MOST_POINTS_ALONG)?;
    let columns = rows[0].len();
    for (index, row) in rows.iter().enumerate() {
        require(&format!("rows[{index}].len()"), row.len(), 1..=MOST_POINTS_ALONG)?;
        if row.len() != columns {
            let field = format!("rows[{index}].len()");
            return Err(SettingError::new(field, row.len(), format!("that of rows[0], {columns}")));
        }
        if let Some(wrong) = row.chars().find(|c| !c.is_ascii_digit() && *c != '.') {
            let value = format!("`{}`", wrong.escape_default());
            return Err(SettingError::new(format!("rows[{index}]"), value, "digits from 0 to 9, and dots"));
        }
    }
    Ok(())
}

/// A mask, prepared for queries.
#[derive(Clone, Debug)]
pub(in crate::scatter) struct DensityMask {
    min: DVec2,
    max: DVec2,
    columns: usize,
    rows: usize,
    levels: Vec<u8>,
}

impl DensityMask {
    pub(super) fn new(min_m: Place, max_m: Place, rows: &[String]) -> Self {
        let level = |c: u8| if c == b'.' { 0 } else { c.wrapping_sub(b'0') };
        Self {
            min: in_f64(min_m),
            max: in_f64(max_m),
            columns: rows.first().map_or(0, String::len),
            rows: rows.len(),
            levels: rows.iter().flat_map(|row| row.bytes().map(level)).collect(),
        }
    }

    pub(super) fn bounds(&self) -> [DVec2; 2] {
        [self.min, self.max]
    }

    /// Bilinear between the centres of the points; the border points reach to the edge.
    pub(super) fn coverage(&self, at: DVec2) -> f32 {
        let points = DVec2::new(self.columns as f64, self.rows as f64);
        let at = ((at - self.min) / (self.max - self.min) * points - 0.5).clamp(DVec2::ZERO, points - 1.0);
        let (column, row) = (at.x as usize, at.y as usize);
        let [u, v] = (at - at.floor()).as_vec2().to_array();
        let (right, below) = ((column + 1).min(self.columns - 1), (row + 1).min(self.rows - 1));
        let level = |column, row| f32::from(self.levels[row * self.columns + column]);
        let upper = level(column, row) * (1.0 - u) + level(right, row) * u;
        let lower = level(column, below) * (1.0 - u) + level(right, below) * u;
        (upper * (1.0 - v) + lower * v) / FULL
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn rows(rows: &[&str]) -> Vec<String> {
        rows.iter().map(|row| (*row).to_owned()).collect()
    }

    #[test]
    fn coverage_is_that_of_the_digits_at_the_centres_and_linear_between() {
        let mask = DensityMask::new([0.0, 0.0], [30.0, 20.0], &rows(&["09.", "369"]));
        let at = |x: f64, z: f64| mask.coverage(DVec2::new(x, z));
        assert_relative_eq!(at(5.0, 5.0), 0.0);
        assert_relative_eq!(at(15.0, 5.0), 1.0);
        assert_relative_eq!(at(25.0, 15.0), 1.0);
        assert_relative_eq!(at(0.0, 20.0), 3.0 / 9.0);
        assert_relative_eq!(at(10.0, 5.0), 0.5);
        assert_relative_eq!(at(10.0, 10.0), (0.0 + 9.0 + 3.0 + 6.0) / 36.0);
    }

    #[test]
    fn a_mask_must_be_a_rectangle_of_digits() {
        let error = |text: &[&str]| validate(&rows(text)).unwrap_err().to_string();
        assert_eq!(error(&[]), "`rows.len()` is 0, but must be 1 to 4096");
        assert_eq!(error(&["12", "1"]), "`rows[1].len()` is 1, but must be that of rows[0], 2");
        assert_eq!(error(&["12", "1x"]), "`rows[1]` is `x`, but must be digits from 0 to 9, and dots");
        assert!(error(&["é"]).contains("`rows[0]`"));
        assert!(error(&[""]).contains("`rows[0].len()` is 0"));
    }
}
