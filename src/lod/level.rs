//! Which level of detail a tree has.
//!
//! A level follows from the size on screen: a tree of height h at distance d measures h·v / (2·d·tan(f/2)) pixels in a
//! picture of v pixels with a vertical field of view f. Solved for the distance this gives three distances at which the
//! levels change. What has a level keeps it until the distance is passed by a margin.

use crate::setting::{SettingError, require};
use bevy::reflect::Reflect;
use serde::{Deserialize, Serialize};

/// How much of a tree is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Reflect)]
pub enum Level {
    /// The grown tree.
    High,
    /// A trunk and an envelope of leaves.
    Medium,
    /// A few still polygons.
    Low,
    /// Nothing but the colour of the ground.
    #[default]
    Ground,
}

const LEVELS: [Level; 4] = [Level::High, Level::Medium, Level::Low, Level::Ground];

/// How large on screen a tree must be for each level.
#[derive(Clone, Copy, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct LevelDistances {
    /// Trees that measure more have the high level. units: pixels of height, domain: `medium_px` to 100000.
    pub high_px: f32,
    /// Smaller ones that measure more than this have the medium level. units: pixels, domain: `low_px` to 100000.
    pub medium_px: f32,
    /// Smaller ones that measure more than this have the low level; the rest fade into the ground.
    /// units: pixels, domain: \[0.1, 100000\].
    pub low_px: f32,
    /// All distances are multiplied by it: a fast machine has more, a slow one less than 1. domain: \[0.1, 10\].
    pub quality: f32,
    /// By this share of a distance it must be passed before a level changes. domain: \[0, 0.5\].
    pub margin: f32,
}

impl Default for LevelDistances {
    /// Full trees from two thirds of a picture of 1080 pixels on; of 25 m in a view of 45° that is at 47 m, 330 m and 11 km.
    fn default() -> Self {
        Self { high_px: 700.0, medium_px: 100.0, low_px: 3.0, quality: 1.0, margin: 0.08 }
    }
}

/// What makes a picture of what is seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lens {
    /// Vertical field of view. units: rad, domain: (0, π).
    pub fov_rad: f32,
    /// Height of the picture. units: pixels.
    pub picture_px: f32,
}

/// At which distances a tree changes its level.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LevelSwitches {
    at_m: [f32; 3],
    margin: f32,
}

impl LevelDistances {
    /// Checks every field.
    ///
    /// # Errors
    /// The first field outside its domain.
    pub fn validate(&self) -> Result<(), SettingError> {
        require("low_px", self.low_px, 0.1..=1e5)?;
        require("medium_px", self.medium_px, self.low_px..=1e5)?;
        require("high_px", self.high_px, self.medium_px..=1e5)?;
        require("quality", self.quality, 0.1..=10.0)?;
        require("margin", self.margin, 0.0..=0.5)
    }

    /// Where trees of a height, m, change their level. Without a picture (no pixels, no field of view) nothing but the
    /// ground is left.
    pub fn switches(&self, tree_height_m: f32, lens: Lens) -> LevelSwitches {
        let pixels_at_1_m = tree_height_m * lens.picture_px / (2.0 * (0.5 * lens.fov_rad).tan());
        let at_m = [self.high_px, self.medium_px, self.low_px].map(|px| (self.quality * pixels_at_1_m / px).max(0.0));
        LevelSwitches { at_m, margin: self.margin }
    }
}

impl LevelSwitches {
    /// The distances at which the high, the medium and the low level end, m.
    pub fn at_m(&self) -> [f32; 3] {
        self.at_m
    }

    /// The level at a distance, m, of what has had the level `before`. A distance that is no number changes nothing.
    pub fn choose(&self, distance_m: f32, before: Option<Level>) -> Level {
        if distance_m.is_nan() {
            return before.unwrap_or_default();
        }
        let passed = |margin: f32| self.at_m.iter().filter(|&&at_m| distance_m > at_m * (1.0 + margin)).count();
        match before {
            Some(before) => before.clamp(LEVELS[passed(self.margin)], LEVELS[passed(-self.margin)]),
            None => LEVELS[passed(0.0)],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};

    const LENS: Lens = Lens { fov_rad: 0.785, picture_px: 1080.0 };

    fn switches() -> LevelSwitches {
        LevelDistances::default().switches(25.0, LENS)
    }

    #[test]
    fn the_defaults_are_valid_and_survive_writing() {
        let distances = LevelDistances::default();
        distances.validate().unwrap();
        assert_eq!(ron::from_str::<LevelDistances>(&ron::to_string(&distances).unwrap()).unwrap(), distances);
        let error = LevelDistances { medium_px: 800.0, ..distances }.validate().unwrap_err();
        assert_eq!(error.to_string(), "`high_px` is 700, but must be 800 to 100000");
        assert!(LevelDistances { margin: f32::NAN, ..distances }.validate().is_err());
    }

    #[test]
    fn a_tree_has_its_size_on_screen_where_its_level_changes() {
        let [high_m, medium_m, low_m] = switches().at_m();
        let pixels = |distance_m: f32| 25.0 / (2.0 * distance_m * (0.5 * LENS.fov_rad).tan()) * LENS.picture_px;
        for (at_m, px) in [(high_m, 700.0), (medium_m, 100.0), (low_m, 3.0)] {
            assert!((pixels(at_m) / px - 1.0).abs() < 1e-4);
        }
        let twice = LevelDistances { quality: 2.0, ..Default::default() }.switches(25.0, LENS);
        assert!((twice.at_m()[0] / high_m - 2.0).abs() < 1e-4);
    }

    proptest! {
        #[test]
        fn within_the_margin_a_level_changes_once_at_most(
            border in 0..3_usize, seed in 0..1000_u64, start in 0.0..12_000.0_f32,
        ) {
            let switches = switches();
            let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
            let mut level = switches.choose(start, None);
            let mut changes = 0;
            for _ in 0..200 {
                let share = 1.0 + 0.079 * random.random_range(-1.0..=1.0_f32);
                let next = switches.choose(switches.at_m()[border] * share, Some(level));
                changes += usize::from(next != level);
                level = next;
            }
            prop_assert!(changes <= 1);
        }

        #[test]
        fn beyond_the_margins_a_level_follows_from_the_distance_alone(distance_m in 1.0..20_000.0_f32) {
            let switches = switches();
            let near_a_border = switches.at_m().iter().any(|at_m| (distance_m / at_m - 1.0).abs() < 0.081);
            for before in LEVELS {
                prop_assert!(near_a_border || switches.choose(distance_m, Some(before)) == switches.choose(distance_m, None));
            }
        }
    }

    #[test]
    fn what_is_no_number_is_harmless() {
        assert_eq!(switches().choose(f32::NAN, Some(Level::Medium)), Level::Medium);
        assert_eq!(switches().choose(f32::NAN, None), Level::Ground);
        assert_eq!(switches().choose(f32::INFINITY, Some(Level::High)), Level::Ground);
        for lens in [Lens { fov_rad: f32::NAN, ..LENS }, Lens { picture_px: 0.0, ..LENS }] {
            assert_eq!(LevelDistances::default().switches(25.0, lens).choose(10.0, Some(Level::High)), Level::Ground);
        }
    }
}
