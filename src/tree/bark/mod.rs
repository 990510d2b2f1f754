//! Bark: what a species' bark looks like, and its textures.
//!
//! [`BarkPattern`] decides how the surface is built; [`texture`] renders it as a height field that tiles.

mod noise;
mod pattern;
pub mod texture;

use bevy::reflect::Reflect;
use serde::{Deserialize, Serialize};

use crate::setting::{SettingError, require, require_colour};

pub use texture::{BarkTextures, bark_textures};

/// How bark is built.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Reflect, Serialize, Deserialize)]
pub enum BarkPattern {
    /// Long ridges parted by furrows: oak, willow, poplar.
    #[default]
    Furrows,
    /// Plates of thin flakes: large ones on a pine, small scales on a spruce.
    Plates,
    /// Long strips, each lifted at one edge: maple, larch.
    Strips,
    /// White sheets with dark dashes around the trunk and black scars: birch. `plates` count the scars' places.
    Peeling,
    /// Smooth with low wrinkles and spots of lichen: beech. `plates_along` counts the wrinkles by three.
    Smooth,
    /// Gardner's Fourier texture, as Zaharia colours his trunks: `plates_around` and `plates_along` are the periods of its
    /// first waves in the tile.
    Fourier,
}

/// What the bark of a species looks like.
#[derive(Clone, Copy, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Bark {
    /// How it is built.
    pub pattern: BarkPattern,
    /// Colour of the plates, sRGB 0 to 1.
    pub colour: [f32; 3],
    /// Colour in the furrows, sRGB 0 to 1.
    pub furrow_colour: [f32; 3],
    /// Second colour of the plates, sRGB 0 to 1: fresh flakes of a pine, algae on a beech, inner sheets of a birch.
    pub accent_colour: [f32; 3],
    /// Lichen and algae on the plates, sRGB 0 to 1.
    pub lichen_colour: [f32; 3],
    /// How much of the plates they cover, 0 to 1.
    pub lichen: f32,
    /// Side of the square that repeats, m: 0.05 to 10.
    pub tile_m: f32,
    /// Plates around that square, 1 to 32.
    pub plates_around: u32,
    /// Plates along it, 1 to 32.
    pub plates_along: u32,
    /// Width of the furrows as a share of a plate's, 0.02 to 1.
    pub furrow_width: f32,
    /// How much furrows wind, as a share of a plate, 0 to 2.
    pub winding: f32,
    /// Depth of the furrows as a share of a plate's width, 0 to 1.
    pub depth: f32,
    /// Roughness of the plates' faces, 0 to 1.
    pub roughness: f32,
}

impl Default for Bark {
    /// A pedunculate oak's: long ridges, deep furrows.
    fn default() -> Self {
        Self {
            pattern: BarkPattern::Furrows,
            colour: [0.46, 0.41, 0.35],
            furrow_colour: [0.15, 0.12, 0.10],
            accent_colour: [0.38, 0.31, 0.24],
            lichen_colour: [0.47, 0.49, 0.38],
            lichen: 0.35,
            tile_m: 0.9,
            plates_around: 11,
            plates_along: 4,
            furrow_width: 0.45,
            winding: 0.55,
            depth: 0.5,
            roughness: 0.5,
        }
    }
}

impl Bark {
    pub(super) fn validate(&self) -> Result<(), SettingError> {
        require_colour("colour", self.colour)?;
        require_colour("furrow_colour", self.furrow_colour)?;
        require_colour("accent_colour", self.accent_colour)?;
        require_colour("lichen_colour", self.lichen_colour)?;
        require("lichen", self.lichen, 0.0..=1.0)?;
        require("tile_m", self.tile_m, 0.05..=10.0)?;
        require("plates_around", self.plates_around as f32, 1.0..=32.0)?;
        require("plates_along", self.plates_along as f32, 1.0..=32.0)?;
        require("furrow_width", self.furrow_width, 0.02..=1.0)?;
        require("winding", self.winding, 0.0..=2.0)?;
        require("depth", self.depth, 0.0..=1.0)?;
        require("roughness", self.roughness, 0.0..=1.0)
    }
}
