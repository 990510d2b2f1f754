//! Phyllotaxis: how leaves, and the branches that grow in their axils, are arranged along a shoot.

use bevy::reflect::Reflect;
use serde::{Deserialize, Serialize};

use crate::setting::{SettingError, require};

/// Arrangement of leaves, or of the branches from their axils, on a shoot (Aono & Kunii 1984: alternate, opposite,
/// whorled).
#[derive(Clone, Copy, Debug, Default, PartialEq, Reflect, Serialize, Deserialize)]
pub enum Phyllotaxis {
    /// One at a node, each turned by the golden angle from the one before: oak, poplar, willow.
    #[default]
    Spiral,
    /// One at a node, left and right in turn: beech, elm, hazel.
    Alternate,
    /// Two at a node face to face, each pair across the one before: maple, ash.
    Opposite,
    /// This many at a node, each whorl in the gaps of the one before, 3 to 12: fir, pine.
    Whorled(u32),
}

/// Turn from one leaf to the next in a spiral, degrees: the circle divided by the golden ratio squared.
pub const GOLDEN_ANGLE_DEG: f32 = 137.507_77;

impl Phyllotaxis {
    pub(in crate::tree) fn validate(&self) -> Result<(), SettingError> {
        match self {
            Self::Whorled(count) => require("Whorled", *count as f32, 3.0..=12.0),
            Self::Spiral | Self::Alternate | Self::Opposite => Ok(()),
        }
    }

    /// Leaves at a node.
    #[must_use]
    pub fn per_node(self) -> u32 {
        match self {
            Self::Spiral | Self::Alternate => 1,
            Self::Opposite => 2,
            Self::Whorled(count) => count,
        }
    }

    /// Turn about the shoot from one node to the next, degrees.
    #[must_use]
    pub fn turn_deg(self) -> f32 {
        match self {
            Self::Spiral => GOLDEN_ANGLE_DEG,
            Self::Alternate => 180.0,
            Self::Opposite | Self::Whorled(_) => 180.0 / self.per_node() as f32,
        }
    }

    /// Angle about the shoot of a leaf: the `sibling`-th of the `node`-th node, degrees.
    #[must_use]
    pub fn roll_deg(self, node: u32, sibling: u32) -> f32 {
        node as f32 * self.turn_deg() + sibling as f32 * 360.0 / self.per_node() as f32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whorls_lie_in_the_gaps_of_the_whorl_before() {
        for arrangement in [Phyllotaxis::Opposite, Phyllotaxis::Whorled(3), Phyllotaxis::Whorled(8)] {
            let count = arrangement.per_node();
            let gap_deg = 360.0 / count as f32;
            for sibling in 0..count {
                let past = (arrangement.roll_deg(1, sibling) - arrangement.roll_deg(0, 0)).rem_euclid(gap_deg);
                assert!((past - 0.5 * gap_deg).abs() < 1e-3, "{past} of {gap_deg}");
            }
            let third = (arrangement.roll_deg(2, 0) - arrangement.roll_deg(0, 0)).rem_euclid(gap_deg);
            assert!(third.min(gap_deg - third) < 1e-3, "every other whorl stands above the first");
        }
    }

    /// No leaf of a spiral stands right above another for many turns; in two ranks every other does.
    #[test]
    fn no_two_leaves_of_a_spiral_are_above_one_another() {
        let apart = |a: f32, b: f32| ((a - b + 180.0).rem_euclid(360.0) - 180.0).abs();
        let spiral = Phyllotaxis::Spiral;
        let nearest = (1..13).map(|node| apart(spiral.roll_deg(node, 0), spiral.roll_deg(0, 0)));
        assert!(nearest.fold(f32::MAX, f32::min) > 15.0);
        assert!(apart(Phyllotaxis::Alternate.roll_deg(2, 0), 0.0) < 1e-3);
    }
}
