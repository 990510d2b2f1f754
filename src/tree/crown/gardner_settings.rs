//! The settings of a crown of textured ellipsoids; see [`gardner`](super::gardner).

use bevy::reflect::Reflect;
use serde::{Deserialize, Serialize};

use super::clamped_scale;
use crate::{
    setting::{SettingError, require},
    texture::fourier::FourierTexture,
    tree::{
        ellipsoid::EllipsoidSurface,
        growth::{
            envelope::{Envelope, EnvelopeShape},
            trunk::Trunk,
        },
    },
};

/// Most ellipsoids of a crown.
pub const ELLIPSOIDS_LIMIT: u32 = 64;

/// Settings of a crown of textured ellipsoids. Lengths are those of a grown individual.
#[derive(Clone, Copy, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct GardnerCrown {
    /// Height of the tree, m: 0.5 to 120.
    pub height_m: f32,
    /// Diameter of the crown, m: 0.2 to 120.
    pub diameter_m: f32,
    /// Height of the crown as a share of the tree's, 0.1 to 1.
    pub crown_size: f32,
    /// Number of ellipsoids, 1 to 64.
    pub ellipsoids: u32,
    /// Semi-axes of an ellipsoid as a share of the crown's, 0.05 to 1.
    pub size: f32,
    /// Random part of that, 0 to 0.9.
    pub size_spread: f32,
    /// How far from the crown's middle the ellipsoids sit, as a share of the room there is: 0 all in the middle, 1 all
    /// at the rim.
    pub spread: f32,
    /// Solid texture that cuts and dapples them; its unit of place is an ellipsoid's semi-axis.
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
    /// Radius of the trunk, m: 0.01 to 5.
    pub trunk_radius_m: f32,
}

impl Default for GardnerCrown {
    /// A broad-leaved tree standing free.
    fn default() -> Self {
        Self {
            height_m: 13.0,
            diameter_m: 10.0,
            crown_size: 0.84,
            ellipsoids: 26,
            size: 0.33,
            size_spread: 0.4,
            spread: 0.95,
            texture: FourierTexture { terms: 6, first_frequency_rad: 6.0, offset: 0.7, ..FourierTexture::default() },
            cover: 0.88,
            outline_cover: 0.04,
            facets: 5,
            colour: [0.40, 0.50, 0.19],
            shade_colour: [0.12, 0.19, 0.06],
            trunk_radius_m: 0.28,
        }
    }
}

impl GardnerCrown {
    /// Checks every field.
    ///
    /// # Errors
    /// [`SettingError`] for the first field outside its domain, NaN included.
    pub fn validate(&self) -> Result<(), SettingError> {
        require("height_m", self.height_m, 0.5..=120.0)?;
        require("diameter_m", self.diameter_m, 0.2..=120.0)?;
        require("crown_size", self.crown_size, 0.1..=1.0)?;
        require("ellipsoids", self.ellipsoids as f32, 1.0..=ELLIPSOIDS_LIMIT as f32)?;
        require("size", self.size, 0.05..=1.0)?;
        require("size_spread", self.size_spread, 0.0..=0.9)?;
        require("spread", self.spread, 0.0..=1.0)?;
        self.surface().validate()?;
        require("trunk_radius_m", self.trunk_radius_m, 0.01..=5.0)
    }

    /// How its ellipsoids are textured.
    #[must_use]
    pub fn surface(&self) -> EllipsoidSurface {
        EllipsoidSurface {
            texture: self.texture,
            cover: self.cover,
            outline_cover: self.outline_cover,
            facets: self.facets,
            colour: self.colour,
            shade_colour: self.shade_colour,
        }
    }

    /// The same crown `scale` (0.02 to 50) times as large: younger, where less than 1.
    #[must_use]
    pub fn scaled(self, scale: f32) -> Self {
        let scale = clamped_scale(scale);
        Self {
            height_m: self.height_m * scale,
            diameter_m: self.diameter_m * scale,
            trunk_radius_m: self.trunk_radius_m * scale,
            ..self
        }
    }

    /// The ellipsoid that holds all others.
    #[must_use]
    pub fn envelope(&self) -> Envelope {
        let base_m = (self.height_m * (1.0 - self.crown_size)).min(0.95 * self.height_m);
        Envelope { shape: EnvelopeShape::Ellipsoid, base_m, top_m: self.height_m, radius_m: 0.5 * self.diameter_m }
    }

    /// Height of an ellipsoid for each metre of its width: that of the crown.
    pub(super) fn slenderness(&self) -> f32 {
        let envelope = self.envelope();
        (envelope.top_m - envelope.base_m) / (2.0 * envelope.radius_m)
    }

    /// The trunk as the mesh of the wood wants it.
    #[must_use]
    pub fn trunk(&self) -> Trunk {
        Trunk { height_m: self.height_m, radius_m: self.trunk_radius_m, segments: 2, lean_deg: 0.0, ..Trunk::default() }
    }
}
