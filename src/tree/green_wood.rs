//! Green branches: the last levels of a tree, greenish and the darker the smaller, as those of Zaharia's fir ("Procedural
//! Modeling of Natural Phenomena", section 2.3: "the last four levels of branches have greenish shades that are darker for
//! smaller branch levels").
//!
//! Levels are counted from the smallest. The texture of a spray holds two of them, its shoots and their twig; the next are
//! the wood's orders of branches from the last on.

use bevy::reflect::Reflect;
use serde::{Deserialize, Serialize};

use crate::{
    setting::{SettingError, require, require_colour},
    texture::linear,
};

/// Levels of branches that are drawn in the texture of a spray.
const IN_SPRAYS: u32 = 2;
/// Brightness of the smallest level against the largest green one.
const DARKEST: f32 = 0.4;
/// Bark that is darker than this counts as so dark, or no factor would make it green.
const DARKEST_BARK: f32 = 0.01;

/// Which levels of branches are green.
#[derive(Clone, Copy, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct GreenWood {
    /// The last levels that are green, 0 to 8, two in the texture of a spray among them: Zaharia's fir has 4.
    pub levels: u32,
    /// Colour of the largest of these, sRGB 0 to 1, with the pattern of the bark; smaller ones are darker, the smallest by 0.4.
    pub colour: [f32; 3],
}

impl Default for GreenWood {
    /// None is green.
    fn default() -> Self {
        Self { levels: 0, colour: [0.30, 0.38, 0.16] }
    }
}

impl GreenWood {
    pub(super) fn validate(&self) -> Result<(), SettingError> {
        require("levels", self.levels, 0..=8)?;
        require_colour("colour", self.colour)
    }

    /// Brightness of branches of an order against the largest green level, 0.4 to 1; 0 where they have bark. `last_order`
    /// is the greatest of the tree.
    pub(super) fn of_order(&self, order: u8, last_order: u8) -> f32 {
        self.of_level(IN_SPRAYS + 1 + u32::from(last_order.saturating_sub(order)))
    }

    /// Linear colours of a spray's twig and of its shoots; `twig` (sRGB) where they are not green.
    pub(super) fn of_spray(&self, twig: [f32; 3]) -> [[f32; 3]; 2] {
        [2, 1].map(|level| match self.of_level(level) {
            0.0 => linear(twig),
            brightness => linear(self.colour).map(|channel| channel * brightness),
        })
    }

    /// What bark of a colour (sRGB) is multiplied with to have the green one, linear.
    #[must_use]
    pub fn tint(&self, bark: [f32; 3]) -> [f32; 3] {
        let (green, bark) = (linear(self.colour), linear(bark));
        std::array::from_fn(|channel| green[channel] / bark[channel].max(DARKEST_BARK))
    }

    /// `level` is 1 for the smallest.
    fn of_level(&self, level: u32) -> f32 {
        if level > self.levels {
            return 0.0;
        }
        let from_largest = (self.levels - level) as f32 / self.levels.saturating_sub(1).max(1) as f32;
        1.0 + (DARKEST - 1.0) * from_largest
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_four_levels_are_green_and_darker_when_smaller() {
        let green = GreenWood { levels: 4, colour: [0.3, 0.5, 0.2] };
        // A trunk, floors, and side branches: the wood of a fir.
        let wood = [0, 1, 2].map(|order| green.of_order(order, 2));
        let spray = green.of_spray([0.4, 0.3, 0.2]).map(|colour| colour[1] / linear(green.colour)[1]);
        assert_eq!(wood[0], 0.0, "the trunk has bark");
        let shades = [wood[1], wood[2], spray[0], spray[1]];
        let expected = [1.0, 0.8, 0.6, 0.4];
        assert!(shades.iter().zip(expected).all(|(shade, expected)| (shade - expected).abs() < 1e-5), "{shades:?}");
    }

    #[test]
    fn without_green_levels_all_has_bark() {
        let none = GreenWood::default();
        assert!((0..6).all(|order| none.of_order(order, 5) == 0.0));
        assert_eq!(none.of_spray([0.4, 0.3, 0.2]), [linear([0.4, 0.3, 0.2]); 2]);
        let one = GreenWood { levels: 1, ..none };
        assert_eq!([one.of_order(3, 3), one.of_level(1), one.of_level(2)], [0.0, 1.0, 0.0]);
    }

    #[test]
    fn tinted_bark_has_the_green_colour() {
        let green = GreenWood { levels: 4, colour: [0.3, 0.5, 0.2] };
        let bark = [0.5, 0.49, 0.46];
        let tinted: Vec<f32> = linear(bark).iter().zip(green.tint(bark)).map(|(bark, tint)| bark * tint).collect();
        assert!(tinted.iter().zip(linear(green.colour)).all(|(own, wanted)| (own - wanted).abs() < 1e-6), "{tinted:?}");
        assert!(green.tint([0.0; 3]).iter().all(|factor| factor.is_finite()));
    }
}
