//! The settings of the surface of an ellipsoid.

use bevy::reflect::Reflect;
use serde::{Deserialize, Serialize};

use crate::{
    setting::{SettingError, require, require_colour},
    texture::fourier::{Combination, FourierTexture},
};

/// How ellipsoids are textured, and how translucent they are.
#[derive(Clone, Copy, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct EllipsoidSurface {
    /// Solid texture that cuts and dapples them; its unit of place is a semi-axis.
    pub texture: FourierTexture,
    /// Share of an ellipsoid's surface that is drawn where it faces the eye, 0.05 to 1.
    pub cover: f32,
    /// Share that is drawn on its outline, 0 to the cover.
    pub outline_cover: f32,
    /// Facets along a quarter of an ellipsoid's girth, 1 to 16: it has 8 times their square triangles.
    pub facets: u32,
    /// Colour of the bright leaves, sRGB 0 to 1.
    pub colour: [f32; 3],
    /// Colour between them, sRGB 0 to 1.
    pub shade_colour: [f32; 3],
}

impl Default for EllipsoidSurface {
    /// Zaharia's sum of waves with his numbers, on octahedra: the least that an ellipsoid can be drawn with.
    fn default() -> Self {
        Self {
            texture: FourierTexture { combination: Combination::Sum, ..FourierTexture::default() },
            cover: 0.85,
            outline_cover: 0.25,
            facets: 1,
            colour: [0.38, 0.49, 0.18],
            shade_colour: [0.13, 0.21, 0.07],
        }
    }
}

impl EllipsoidSurface {
    pub(in crate::tree) fn validate(&self) -> Result<(), SettingError> {
        self.texture.validate().map_err(|error| error.inside("texture"))?;
        require("cover", self.cover, 0.05..=1.0)?;
        require("outline_cover", self.outline_cover, 0.0..=self.cover)?;
        require("facets", self.facets as f32, 1.0..=16.0)?;
        require_colour("colour", self.colour)?;
        require_colour("shade_colour", self.shade_colour)
    }
}
