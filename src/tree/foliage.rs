//! Foliage: the settings of where the sprays of leaves sit and how they lie. `leaf_places.rs` places them.
//!
//! A spray is a stretch of twig with its leaves, one card to draw. Sprays sit along the thin branches and close each
//! branch's tip, face the sky and the way out of the crown as leaves do, and know how deep in the crown they are:
//! Reeves & Blau (1985, section 4) shade a tree by that depth.

use bevy::reflect::Reflect;
use serde::{Deserialize, Serialize};

use super::leaf::{Leaf, LeafArrangement, LeafKind};
use crate::{
    dynamics::leaf::LeafResponse,
    setting::{SettingError, require},
};

/// Most sprays on one tree.
pub const CLUSTERS_LIMIT: usize = 16_384;

/// The surface on which a spray is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Reflect, Serialize, Deserialize)]
pub enum Card {
    /// A level kite: 4 vertices, a line when seen from its edge.
    Flat,
    /// A kite folded along its axis: 4 vertices, and no direction from which it vanishes.
    #[default]
    Folded,
    /// A folded kite whose outer half bends down, too: 5 vertices, the nearest to a real spray.
    Bent,
    /// Two kites through one axis, at right angles: 8 vertices, for needles all around a twig.
    Crossed,
}

impl Card {
    /// Vertices of one card.
    #[must_use]
    pub fn vertices(self) -> usize {
        match self {
            Self::Flat | Self::Folded => 4,
            Self::Bent => 5,
            Self::Crossed => 8,
        }
    }
}

/// The foliage of a species: its sprays, where they sit and how they lie.
#[derive(Clone, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Foliage {
    /// What leaves are drawn as. [Ellipsoids](LeafKind::Ellipsoids) sit on branches that bear no others, by numbers of their own
    /// instead of `first_order`, `spacing_m`, `size_spread` and `arrangement`; what follows about cards and the `leaf` does
    /// not concern them.
    pub kind: LeafKind,
    /// First order of branches that carries leaves along it (lower ones do at their tips), 0 to 5.
    pub first_order: u8,
    /// Where on such a branch the first spray sits, as a share of its first beam: 0 to 1.
    pub first_at: f32,
    /// Mean distance between sprays, m: 0.03 to 10.
    pub spacing_m: f32,
    /// Length of a spray, m: 0.02 to 5.
    pub size_m: f32,
    /// Random part of that length, 0 to 0.9.
    pub size_spread: f32,
    /// Width of a spray's card as a share of its length, 0.1 to 2.
    pub aspect: f32,
    /// The surface on which a spray is drawn.
    pub card: Card,
    /// How far the outer half of a [bent](Card::Bent) card turns down from the inner, degrees: -90 to 90.
    pub bend_deg: f32,
    /// How sprays are set along their branch: one, two or three at a place.
    pub arrangement: LeafArrangement,
    /// How far each half of a card folds down from its axis, degrees: -80 to 80.
    pub fold_deg: f32,
    /// Angle between a spray and its branch, degrees: 0 to 150.
    pub angle_deg: f32,
    /// Turn about the branch from one spray to the next, degrees: -360 to 360. Turn 0 is level, 90 is up.
    pub roll_deg: f32,
    /// Random part of the turn, degrees: 0 to 180.
    pub roll_spread_deg: f32,
    /// How much sprays hang (negative: rise), -2 to 2.
    pub droop: f32,
    /// How much a spray's face seeks the sky rather than the way out of the crown, 0 to 1.
    pub skyward: f32,
    /// How much it faces anywhere, 0 to 3.
    pub disorder: f32,
    /// How dark the middle of the crown is: light falls by `exp(-extinction depth)`, 0 to 6.
    pub extinction: f32,
    /// The leaves of a spray.
    pub leaf: Leaf,
    /// How much light comes through a leaf, of what falls on it: 0 to 1.
    pub translucency: f32,
    /// Mass of the leaves for each square metre of a spray's size squared, kg/m^2: 0 to 10.
    pub mass_per_area_kg_m2: f32,
    /// Drag coefficient of a spray in a wind of 10 m/s, by its size squared, 0 to 2; far below that of a plate, because sprays
    /// fold away and shelter one another.
    pub drag_coefficient: f32,
    /// How the drag of the tree in leaf falls with the wind's speed: above 4 m/s it grows with the speed to the power 2 + this,
    /// -1 to 0 (Vogel's exponent). Oaks in leaf: 1.6 to 1.7 (Angelou et al. 2019).
    pub drag_exponent: f32,
    /// How they respond to the wind.
    pub response: LeafResponse,
}

impl Default for Foliage {
    /// A pedunculate oak's.
    fn default() -> Self {
        Self {
            kind: LeafKind::Sprays,
            first_order: 2,
            first_at: 0.25,
            spacing_m: 0.4,
            size_m: 1.05,
            size_spread: 0.35,
            aspect: 0.95,
            card: Card::Folded,
            bend_deg: 30.0,
            arrangement: LeafArrangement::Alternate,
            fold_deg: 18.0,
            angle_deg: 55.0,
            roll_deg: 137.5,
            roll_spread_deg: 40.0,
            droop: 0.15,
            skyward: 0.45,
            disorder: 0.6,
            extinction: 1.7,
            leaf: Leaf::default(),
            translucency: 0.35,
            mass_per_area_kg_m2: 0.2,
            drag_coefficient: 0.012,
            drag_exponent: -0.35,
            response: LeafResponse::default(),
        }
    }
}

impl Foliage {
    pub(super) fn validate(&self) -> Result<(), SettingError> {
        require("first_order", f32::from(self.first_order), 0.0..=5.0)?;
        require("first_at", self.first_at, 0.0..=1.0)?;
        require("spacing_m", self.spacing_m, 0.03..=10.0)?;
        require("size_m", self.size_m, 0.02..=5.0)?;
        require("size_spread", self.size_spread, 0.0..=0.9)?;
        require("aspect", self.aspect, 0.1..=2.0)?;
        require("bend_deg", self.bend_deg, -90.0..=90.0)?;
        require("fold_deg", self.fold_deg, -80.0..=80.0)?;
        require("angle_deg", self.angle_deg, 0.0..=150.0)?;
        require("roll_deg", self.roll_deg, -360.0..=360.0)?;
        require("roll_spread_deg", self.roll_spread_deg, 0.0..=180.0)?;
        require("droop", self.droop, -2.0..=2.0)?;
        require("skyward", self.skyward, 0.0..=1.0)?;
        require("disorder", self.disorder, 0.0..=3.0)?;
        require("extinction", self.extinction, 0.0..=6.0)?;
        require("translucency", self.translucency, 0.0..=1.0)?;
        require("mass_per_area_kg_m2", self.mass_per_area_kg_m2, 0.0..=10.0)?;
        require("drag_coefficient", self.drag_coefficient, 0.0..=2.0)?;
        require("drag_exponent", self.drag_exponent, -1.0..=0.0)?;
        self.response.validate().map_err(|error| error.inside("response"))?;
        if let LeafKind::Ellipsoids(ellipsoids) = &self.kind {
            ellipsoids.validate().map_err(|error| error.inside("kind"))?;
        }
        self.leaf.validate().map_err(|error| error.inside("leaf"))
    }

    /// Share of the sky's light that reaches a depth in the crown, 0 to 1.
    #[must_use]
    pub fn light(&self, depth: f32) -> f32 {
        (-self.extinction * depth).exp()
    }
}
