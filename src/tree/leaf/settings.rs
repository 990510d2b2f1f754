//! The settings of a leaf: its shape, margin and colours, and how leaves are set on their twig.

use bevy::reflect::Reflect;
use serde::{Deserialize, Serialize};

use crate::setting::{SettingError, require, require_colour};

/// The leaves of a spray.
#[derive(Clone, Copy, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Leaf {
    /// Its shape.
    pub shape: LeafShape,
    /// Its margin; needles have none.
    pub margin: LeafMargin,
    /// How leaves are set on a shoot.
    pub arrangement: LeafArrangement,
    /// Colour of a grown leaf, sRGB 0 to 1.
    pub colour: [f32; 3],
    /// Colour of a young one, sRGB 0 to 1.
    pub young_colour: [f32; 3],
    /// Colour of the underside, sRGB 0 to 1.
    pub back_colour: [f32; 3],
    /// Colour of the twig, sRGB 0 to 1.
    pub twig_colour: [f32; 3],
    /// Length of a leaf as a share of the spray's, 0.01 to 0.6.
    pub length: f32,
    /// Width of a leaf as a share of its length, 0.02 to 1.2.
    pub width: f32,
    /// Stalk of a leaf as a share of its length, 0 to 1.
    pub stalk: f32,
    /// Pairs of side veins, 0 to 24.
    pub vein_pairs: u32,
    /// Angle of the side veins to the midrib, degrees: 10 to 90.
    pub vein_angle_deg: f32,
    /// How much leaves turn out of the spray's plane and bend sideways, 0 to 1.
    pub curl: f32,
    /// Side shoots of the spray, 0 to 40.
    pub shoots: u32,
    /// Side shoots of each of these, 0 to 12: without them, a spray of needles is a fern's frond.
    pub second_shoots: u32,
    /// Distance between leaves along a shoot as a share of a leaf's length, 0.05 to 2.
    pub spacing: f32,
    /// How mottled leaves are by a Fourier texture, as Zaharia colours his: 0 to 1.
    pub mottle: f32,
    /// Share of a shoot, from its root, that bears no leaves: 0 to 0.9.
    pub bare: f32,
}

/// How leaves are set on a shoot.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Reflect, Serialize, Deserialize)]
pub enum LeafArrangement {
    /// One at a node, left and right by turns: oak, beech, birch, willow.
    #[default]
    Alternate,
    /// Two at a node, face to face: maple, ash.
    Opposite,
    /// Three at a node: left, right and over the shoot.
    Whorled,
}

impl Default for Leaf {
    /// A pedunculate oak's.
    fn default() -> Self {
        Self {
            shape: LeafShape::Lobed,
            margin: LeafMargin::Entire,
            arrangement: LeafArrangement::Alternate,
            colour: [0.22, 0.36, 0.11],
            young_colour: [0.42, 0.52, 0.16],
            back_colour: [0.40, 0.48, 0.27],
            twig_colour: [0.30, 0.25, 0.17],
            length: 0.2,
            width: 0.56,
            stalk: 0.08,
            vein_pairs: 6,
            vein_angle_deg: 45.0,
            curl: 0.5,
            shoots: 7,
            second_shoots: 0,
            spacing: 0.42,
            mottle: 0.12,
            bare: 0.25,
        }
    }
}

impl Leaf {
    pub(in crate::tree) fn validate(&self) -> Result<(), SettingError> {
        require_colour("colour", self.colour)?;
        require_colour("young_colour", self.young_colour)?;
        require_colour("back_colour", self.back_colour)?;
        require_colour("twig_colour", self.twig_colour)?;
        require("length", self.length, 0.01..=0.6)?;
        require("width", self.width, 0.02..=1.2)?;
        require("stalk", self.stalk, 0.0..=1.0)?;
        require("vein_pairs", self.vein_pairs as f32, 0.0..=24.0)?;
        require("vein_angle_deg", self.vein_angle_deg, 10.0..=90.0)?;
        require("curl", self.curl, 0.0..=1.0)?;
        require("shoots", self.shoots as f32, 0.0..=40.0)?;
        require("second_shoots", self.second_shoots as f32, 0.0..=12.0)?;
        require("spacing", self.spacing, 0.05..=2.0)?;
        require("mottle", self.mottle, 0.0..=1.0)?;
        require("bare", self.bare, 0.0..=0.9)
    }
}

/// Outlines of leaves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Reflect, Serialize, Deserialize)]
pub enum LeafShape {
    /// Widest beyond the middle, with rounded lobes: an oak's.
    #[default]
    Lobed,
    /// Egg-shaped, widest a little below the middle: a beech's.
    Ovate,
    /// Triangular to egg-shaped, widest near the base, drawn out at the tip: a birch's.
    Triangular,
    /// Lance-shaped: a willow's.
    Lanceolate,
    /// Five lobes about the end of the stalk: a maple's.
    Palmate,
    /// Seven leaflets about the end of the stalk, each widest beyond its middle: a horse chestnut's.
    Digitate,
    /// A broad triangle with a straight base: a poplar's.
    Deltoid,
    /// Widest beyond the middle, blunt with a short tip: a hazel's or an alder's.
    Obovate,
    /// Single needles: a spruce's or a fir's.
    Needle,
    /// Needles in pairs: a Scots pine's.
    NeedlePair,
    /// Tufts of needles on short shoots: a larch's.
    NeedleRosette,
}

impl LeafShape {
    /// Whether it is one of the needles.
    #[must_use]
    pub fn is_needle(self) -> bool {
        matches!(self, Self::Needle | Self::NeedlePair | Self::NeedleRosette)
    }
}

/// Margins of leaves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Reflect, Serialize, Deserialize)]
pub enum LeafMargin {
    /// Smooth.
    #[default]
    Entire,
    /// In low waves: a beech's.
    Wavy,
    /// With teeth that point forward.
    Serrate,
    /// With teeth upon teeth: a birch's or a hazel's.
    DoublySerrate,
}
