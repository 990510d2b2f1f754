//! At which distances one level of detail follows another.
//!
//! A level follows from the size on screen: a tree of height h at distance d measures h·v / (2·d·tan(f/2)) pixels in a
//! picture of v pixels with a vertical field of view f. Solved for the distance this gives the distances at which levels
//! end.

use super::settings::MOST_LEVELS;
use crate::setting::{SettingError, require};
use bevy::reflect::Reflect;
use serde::{Deserialize, Serialize};

/// How large on screen a tree must be for each level.
#[derive(Clone, Copy, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct LodScreenSizes {
    /// Trees that measure more have the high level. units: pixels of height, domain: `medium_px` to 100000.
    pub high_px: f32,
    /// Smaller ones that measure more than this have the medium level, the rest the low one. units: pixels, domain: 0.1 to
    /// 100000.
    pub medium_px: f32,
    /// All distances are multiplied by it: a fast machine has more, a slow one less than 1. domain: \[0.1, 10\].
    pub quality: f32,
    /// By this share of a distance it must be passed before a level changes. domain: \[0, 0.5\].
    pub margin: f32,
}

impl Default for LodScreenSizes {
    /// Full trees from two thirds of a picture of 1080 pixels on; of 25 m in a view of 45° that is at 47 m, and the medium
    /// level ends at 255 m: where a tree is no larger than a view of its impostor.
    fn default() -> Self {
        Self { high_px: 700.0, medium_px: 128.0, quality: 1.0, margin: 0.04 }
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

impl Default for Lens {
    /// 45°, as Bevy's cameras have it, on a picture of 1080 pixels.
    fn default() -> Self {
        Self { fov_rad: std::f32::consts::FRAC_PI_4, picture_px: 1080.0 }
    }
}

impl Lens {
    /// Pixels that a metre has in the picture, seen from a distance of one metre.
    #[must_use]
    pub fn pixels_at_1_m(&self) -> f32 {
        self.picture_px / (2.0 * (0.5 * self.fov_rad).tan())
    }

    /// A lens that shows so many.
    #[must_use]
    pub fn with_pixels_at_1_m(pixels: f32) -> Self {
        // A right angle of view shows two metres there.
        Self { fov_rad: std::f32::consts::FRAC_PI_2, picture_px: 2.0 * pixels }
    }
}

impl LodScreenSizes {
    /// Checks every field.
    ///
    /// # Errors
    /// The first field outside its domain.
    pub fn validate(&self) -> Result<(), SettingError> {
        require("medium_px", self.medium_px, 0.1..=1e5)?;
        require("high_px", self.high_px, self.medium_px..=1e5)?;
        require("quality", self.quality, 0.1..=10.0)?;
        require("margin", self.margin, 0.0..=0.5)
    }

    /// The distances at which the high and the medium level of trees of a height, m, end; m. Without a picture (no pixels,
    /// no field of view) they are 0.
    pub fn distances_m(&self, tree_height_m: f32, lens: Lens) -> [f32; 2] {
        let pixels_at_1_m = tree_height_m * lens.picture_px / (2.0 * (0.5 * lens.fov_rad).tan());
        [self.high_px, self.medium_px].map(|px| (self.quality * pixels_at_1_m / px).max(0.0))
    }

    /// The same with a level between the two: it begins half way, as the eye sees distances.
    pub fn distances_of_three_m(&self, tree_height_m: f32, lens: Lens) -> [f32; MOST_LEVELS] {
        let [high, medium] = self.distances_m(tree_height_m, lens);
        [high, (high * medium).sqrt(), medium]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LENS: Lens = Lens { fov_rad: 0.785, picture_px: 1080.0 };

    #[test]
    fn defaults_are_valid_and_survive_writing() {
        let sizes = LodScreenSizes::default();
        sizes.validate().unwrap();
        assert_eq!(ron::from_str::<LodScreenSizes>(&ron::to_string(&sizes).unwrap()).unwrap(), sizes);
        let error = LodScreenSizes { medium_px: 800.0, ..sizes }.validate().unwrap_err();
        assert_eq!(error.to_string(), "`high_px` is 700, but must be 800 to 100000");
        assert!(LodScreenSizes { margin: f32::NAN, ..sizes }.validate().is_err());
    }

    #[test]
    fn a_tree_has_its_size_on_screen_where_a_level_ends() {
        let [high_m, medium_m] = LodScreenSizes::default().distances_m(25.0, LENS);
        let pixels = |distance_m: f32| 25.0 / (2.0 * distance_m * (0.5 * LENS.fov_rad).tan()) * LENS.picture_px;
        for (at_m, px) in [(high_m, 700.0), (medium_m, 128.0)] {
            assert!((pixels(at_m) / px - 1.0).abs() < 1e-4);
        }
        let twice = LodScreenSizes { quality: 2.0, ..Default::default() }.distances_m(25.0, LENS);
        assert!((twice[0] / high_m - 2.0).abs() < 1e-4);
    }

    #[test]
    fn without_a_picture_all_levels_end_at_once() {
        for lens in [Lens { fov_rad: f32::NAN, ..LENS }, Lens { picture_px: 0.0, ..LENS }] {
            assert_eq!(LodScreenSizes::default().distances_m(25.0, lens), [0.0; 2]);
        }
    }
}
