//! Age: the size of a tree at each age, as shares of its mature size.
//!
//! Sizes follow the curve of Chapman and Richards (Richards 1959, J. Exp. Bot. 10, 290; Pienaar & Turnbull 1973,
//! Forest Science 19, 2), the usual curve of height over age in forestry:
//!
//! ```text
//! size(t) = A (1 - exp(-k t))^p,    size(t) / size(T) = ((1 - exp(-k t)) / (1 - exp(-k T)))^p
//! ```
//!
//! with `k` the rate, `p` the shape and `T` the age at which the tree has the sizes written in its species, which so
//! need no asymptote `A`. Girth has a slower rate than height and goes on when the height has levelled off; its shape
//! of 3/2 makes a young tree's girth grow with its height to the power 3/2, the elastic similarity of trees (`McMahon`
//! 1973, Science 179, 1201). The crown's width lies between the two, at their geometric mean. The default rates are
//! chosen to give an oak about 2 m at 10 years and 12 m at 60, not fitted to a table.
//!
//! A forest's plan has a law of its own for plants of any kind, without species files. [`Planted`](crate::scatter::Planted) says how the
//! two go together.

use bevy::reflect::Reflect;
use serde::{Deserialize, Serialize};

use crate::setting::{SettingError, require};

/// How a species ages.
#[derive(Clone, Copy, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Age {
    /// Age at which a tree has the sizes written in its species, years: 2 to 2000.
    pub mature_years: f32,
    /// Greatest age; an older tree is grown as one of this age, years: `mature_years` to 5000.
    pub oldest_years: f32,
    /// Rate `k` of the height, per year: 0.001 to 1.
    pub height_rate_per_year: f32,
    /// Shape `p` of the height, 0.5 to 4: above 1 a seedling starts slowly.
    pub height_shape: f32,
    /// Rate `k` of the trunk's diameter, per year: 0.001 to 1, below the height's if the trunk is to go on growing.
    pub girth_rate_per_year: f32,
    /// Shape `p` of the diameter, 0.5 to 4.
    pub girth_shape: f32,
}

/// How much larger than at maturity height or girth may become: it keeps trees within what a species may ask for.
const LARGEST_SHARE: f32 = 4.0;

impl Default for Age {
    /// A pedunculate oak.
    fn default() -> Self {
        Self {
            mature_years: 120.0,
            oldest_years: 500.0,
            height_rate_per_year: 0.02,
            height_shape: 1.3,
            girth_rate_per_year: 0.01,
            girth_shape: 1.5,
        }
    }
}

impl Age {
    /// Youngest tree that is grown, years.
    pub const YOUNGEST_YEARS: f32 = 1.0;

    pub(in crate::tree) fn validate(&self) -> Result<(), SettingError> {
        require("mature_years", self.mature_years, 2.0..=2000.0)?;
        require("oldest_years", self.oldest_years, self.mature_years..=5000.0)?;
        require("height_rate_per_year", self.height_rate_per_year, 0.001..=1.0)?;
        require("height_shape", self.height_shape, 0.5..=4.0)?;
        require("girth_rate_per_year", self.girth_rate_per_year, 0.001..=1.0)?;
        require("girth_shape", self.girth_shape, 0.5..=4.0)?;
        let oldest = self.stage(self.oldest_years);
        let bounded = |field, rate, share: f32| {
            let allowed = "high enough that the oldest tree is at most 4 times as large as the mature one";
            if share <= LARGEST_SHARE { Ok(()) } else { Err(SettingError::new(field, rate, allowed)) }
        };
        bounded("height_rate_per_year", self.height_rate_per_year, oldest.height)?;
        bounded("girth_rate_per_year", self.girth_rate_per_year, oldest.girth)
    }

    /// The stage of life at an age, which is clamped to 1..[`oldest_years`](Self::oldest_years); NaN is mature.
    #[must_use]
    pub fn stage(&self, age_years: f32) -> Stage {
        let years = if age_years.is_nan() { self.mature_years } else { age_years };
        let years = years.clamp(Self::YOUNGEST_YEARS, self.oldest_years.max(Self::YOUNGEST_YEARS));
        let share = |rate: f32, shape: f32| {
            let grown = |years: f32| -(-rate * years).exp_m1();
            (grown(years) / grown(self.mature_years)).powf(shape)
        };
        let height = share(self.height_rate_per_year, self.height_shape);
        let girth = share(self.girth_rate_per_year, self.girth_shape);
        Stage { years, height, girth, crown: (height * girth).sqrt() }
    }
}

/// A stage of life: sizes as shares of those at maturity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stage {
    /// The age, years.
    pub years: f32,
    /// Height.
    pub height: f32,
    /// Diameter of the trunk.
    pub girth: f32,
    /// Width of the crown.
    pub crown: f32,
}

impl Stage {
    /// The mature stage at `years`.
    #[must_use]
    pub fn mature(years: f32) -> Self {
        Self { years, height: 1.0, girth: 1.0, crown: 1.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tree_has_its_written_sizes_when_mature() {
        let age = Age::default();
        assert_eq!(age.stage(age.mature_years), Stage::mature(age.mature_years));
    }

    #[test]
    fn girth_grows_on_after_height_levels_off() {
        let age = Age::default();
        let [mature, old] = [age.mature_years, age.oldest_years].map(|years| age.stage(years));
        // The limits of the curve, from its asymptote A = 1 / (1 - exp(-k T))^p.
        let limit = |rate: f32, shape: f32| (1.0 - (-rate * age.mature_years).exp()).powf(-shape);
        assert!((old.height / limit(age.height_rate_per_year, age.height_shape) - 1.0).abs() < 1e-3);
        assert!(old.height - mature.height < 0.15 && old.girth - mature.girth > 0.5);
        let young: Vec<Stage> = (1..500).map(|years| age.stage(years as f32)).collect();
        assert!(young.windows(2).all(|pair| pair[0].height < pair[1].height && pair[0].girth < pair[1].girth));
    }

    /// d ln girth / d ln height is the ratio of the shapes while both curves are still straight.
    #[test]
    fn a_young_trees_girth_grows_by_elastic_similarity() {
        let age = Age { height_shape: 1.0, ..Age::default() };
        let [one, two] = [1.0, 2.0].map(|years| age.stage(years));
        let exponent = (two.girth / one.girth).ln() / (two.height / one.height).ln();
        assert!((exponent - 1.5).abs() < 0.03, "{exponent}");
    }

    #[test]
    fn ages_out_of_range_are_clamped() {
        let age = Age::default();
        for (asked, grown) in [(-3.0, 1.0), (0.0, 1.0), (f32::INFINITY, 500.0), (f32::NAN, 120.0), (77.0, 77.0)] {
            assert_eq!(age.stage(asked).years, grown);
        }
    }

    #[test]
    fn curves_that_grow_too_far_are_refused() {
        let age = Age { mature_years: 10.0, oldest_years: 1000.0, ..Age::default() };
        let error = age.validate().unwrap_err().to_string();
        assert!(error.starts_with("`height_rate_per_year` is 0.02"), "{error}");
    }
}
