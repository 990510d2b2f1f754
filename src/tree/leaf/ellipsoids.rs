//! Leaves as Zaharia draws them ("Procedural Modeling of Natural Phenomena", section 2.3): small, thin ellipsoids with a
//! Fourier texture, "5 to 10 \[on a branch\], depending on the branch length".
//!
//! Their semi-axes, "parallel to the axis of the referential associated to the leaf", have "(positive) lengths normally
//! distributed around 3, 1 and 0": they are the absolute values of normal variates. He does not print how far these spread.

use bevy::{math::Vec3, reflect::Reflect};
use rand::{SeedableRng, rngs::Xoshiro256PlusPlus};
use rand_distr::{Distribution, StandardNormal};
use serde::{Deserialize, Serialize};

use crate::{
    setting::{SettingError, require},
    tree::ellipsoid::EllipsoidSurface,
};

/// An ellipsoid keeps this thickness in relation to its mean length, and its length this share of the mean one.
const THINNEST: f32 = 0.02;
const SHORTEST: f32 = 0.2;
/// A variate that is further off its mean, in standard deviations, counts as so far off.
const FARTHEST: f32 = 3.0;

/// What leaves are drawn as.
#[derive(Clone, Copy, Debug, Default, PartialEq, Reflect, Serialize, Deserialize)]
pub enum LeafKind {
    /// Cut leaves on a twig: a card for each spray.
    #[default]
    Sprays,
    /// Ellipsoids on terminal branches alone, after Zaharia.
    Ellipsoids(LeafEllipsoids),
}

/// Leaves that are ellipsoids. How long one is, is the foliage's `size_m`.
#[derive(Clone, Copy, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct LeafEllipsoids {
    /// Ellipsoids for each metre of a terminal branch, 0 to 100, rounded up.
    pub per_m: f32,
    /// Fewest on a terminal branch, 0 to 100: his 5.
    pub fewest: u32,
    /// Most on a terminal branch, `fewest` to 100: his 10.
    pub most: u32,
    /// Mean semi-axes along the leaf, across it and through it, in a unit of their own, 0 to 10 and the first at least 1: his
    /// 3, 1 and 0.
    pub semi_axes: [f32; 3],
    /// Standard deviation of each, in the same unit: 0 to 3.
    pub deviation: f32,
    /// Their texture and translucency.
    pub surface: EllipsoidSurface,
}

impl Default for LeafEllipsoids {
    /// His numbers where he has any; the leaves for each metre meet his table 2.
    fn default() -> Self {
        Self {
            per_m: 2.0,
            fewest: 5,
            most: 10,
            semi_axes: [3.0, 1.0, 0.0],
            deviation: 0.4,
            surface: EllipsoidSurface::default(),
        }
    }
}

impl LeafEllipsoids {
    pub(in crate::tree) fn validate(&self) -> Result<(), SettingError> {
        require("per_m", self.per_m, 0.0..=100.0)?;
        require("fewest", self.fewest, 0..=100)?;
        require("most", self.most, self.fewest..=100)?;
        require("semi_axes[0]", self.semi_axes[0], 1.0..=10.0)?;
        require("semi_axes[1]", self.semi_axes[1], 0.0..=10.0)?;
        require("semi_axes[2]", self.semi_axes[2], 0.0..=10.0)?;
        require("deviation", self.deviation, 0.0..=3.0)?;
        self.surface.validate().map_err(|error| error.inside("surface"))
    }

    /// How many sit on a terminal branch of that length, m.
    #[must_use]
    pub fn count_on(&self, length_m: f32) -> u32 {
        ((length_m * self.per_m).ceil() as u32).clamp(self.fewest, self.most.max(self.fewest))
    }

    /// The semi-axes of the ellipsoid with this random phase, where the mean length of all ellipsoids is 1. Phase alone
    /// decides, so that an ellipsoid keeps its shape whichever others are drawn.
    pub(in crate::tree) fn semi_axes_of(&self, phase: f32) -> Vec3 {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(u64::from(phase.to_bits()));
        let unit = 0.5 / self.semi_axes[0];
        let drawn = self.semi_axes.map(|mean| {
            let variate: f32 = StandardNormal.sample(&mut random);
            (mean + self.deviation * variate.clamp(-FARTHEST, FARTHEST)).abs() * unit
        });
        Vec3::from(drawn).max(0.5 * Vec3::new(SHORTEST, THINNEST, THINNEST))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_branch_has_five_to_ten_by_its_length() {
        let leaves = LeafEllipsoids { per_m: 3.0, ..LeafEllipsoids::default() };
        let counts = [0.0, 0.5, 1.7, 2.0, 2.1, 3.2, 4.0, f32::NAN, f32::INFINITY].map(|m| leaves.count_on(m));
        assert_eq!(counts, [5, 5, 6, 6, 7, 10, 10, 5, 10]);
    }

    /// The absolute value of a normal variate about 0 has the mean `deviation sqrt(2 / pi)`; about 3 and 1, at these
    /// deviations, it is the variate itself.
    #[test]
    fn semi_axes_are_normally_distributed_about_three_one_and_nought() {
        let leaves = LeafEllipsoids { deviation: 0.3, ..LeafEllipsoids::default() };
        let count = 20_000;
        let drawn: Vec<Vec3> =
            (0..count).map(|index| 6.0 * leaves.semi_axes_of((index as f32 + 0.5) / count as f32)).collect();
        let mean = drawn.iter().sum::<Vec3>() / count as f32;
        let spread = drawn.iter().map(|axes| (axes - mean).powf(2.0)).sum::<Vec3>() / count as f32;
        let half_normal = 0.3 * std::f32::consts::FRAC_2_PI.sqrt();
        // Four standard errors of the mean, 0.3 / sqrt(20000), and of the deviation; the thinnest are no thinner than 0.06.
        assert!(mean.abs_diff_eq(Vec3::new(3.0, 1.0, half_normal), 0.01), "{mean}");
        assert!((spread.x.sqrt() - 0.3).abs() < 0.008 && (spread.y.sqrt() - 0.3).abs() < 0.008, "{spread}");
        assert!(drawn.iter().all(|axes| axes.min_element() >= 0.059));
    }

    #[test]
    fn a_bad_field_is_named() {
        let error = LeafEllipsoids { most: 3, ..LeafEllipsoids::default() }.validate().unwrap_err();
        assert_eq!(error.to_string(), "`most` is 3, but must be 5 to 100");
        LeafEllipsoids::default().validate().unwrap();
    }
}
