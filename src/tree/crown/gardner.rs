//! Impressionist trees after Gardner, "Simulation of natural scenes using textured quadric surfaces" (SIGGRAPH 1984).
//!
//! A crown is a cluster of ellipsoids. A solid Fourier texture ([`fourier`](crate::texture::fourier)) makes each
//! translucent where its value is below a threshold, and the threshold rises towards the outline, so that a smooth
//! solid ends in leaves. With `u = |n . v|` the cosine between the surface and the eye, Gardner's quadric is `u^2` in
//! the image of a sphere, 1 in its middle and 0 on its outline, and
//!
//! ```text
//! threshold(u) = t_middle + (t_outline - t_middle) (1 - u^2),     drawn where F > threshold(u)
//! ```
//!
//! A renderer with one fixed cut-off at 1/2 does exactly that if the texture's alpha is `a(F)` and is multiplied by
//! `w(u)`:
//!
//! ```text
//! a(F) = 1/2 + (F - t_middle) / (2 (t_outline - t_middle))   within 0..1
//! w(u) = 1 / (2 - u^2)                                       1 in the middle, 1/2 on the outline
//! ```
//!
//! for `a w > 1/2` is `F > threshold(u)`. [`silhouette_alpha`](super::silhouette_alpha) is `w`. The two thresholds are
//! chosen by the shares of the surface that they leave: `cover` and `outline_cover`.
//!
//! Ellipsoids are carried by their limbs and do not flutter: their species wants a leaf response with `turn` and
//! `flutter_angle_rad` 0.
//!
//! ```ron
//! Gardner(height_m: 12.0, diameter_m: 9.0, crown_size: 0.8, ellipsoids: 14, size: 0.42, size_spread: 0.3,
//!     cover: 0.85, outline_cover: 0.08)
//! ```

use bevy::{math::Vec3, reflect::Reflect};
use rand::{Rng, RngExt};
use serde::{Deserialize, Serialize};

use super::{ellipsoids, frame::Frame};
use crate::{
    texture::TextureData,
    texture::fourier::{FourierTexture, InvalidFourierTexture},
    tree::{
        growth::{
            envelope::{Envelope, EnvelopeShape},
            pipes,
            reeves::Trunk,
        },
        leaf_mesh::LeafVertices,
        skeleton::{LeafCluster, Skeleton},
        species::{SpeciesError, require, require_colour},
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
    /// Facets along a quarter of an ellipsoid's girth, 2 to 16: it has 8 times their square triangles.
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
    /// [`SpeciesError::OutOfRange`] for the first field outside its domain, NaN included.
    pub fn validate(&self) -> Result<(), SpeciesError> {
        require("height_m", self.height_m, 0.5..=120.0)?;
        require("diameter_m", self.diameter_m, 0.2..=120.0)?;
        require("crown_size", self.crown_size, 0.1..=1.0)?;
        require("ellipsoids", self.ellipsoids as f32, 1.0..=ELLIPSOIDS_LIMIT as f32)?;
        require("size", self.size, 0.05..=1.0)?;
        require("size_spread", self.size_spread, 0.0..=0.9)?;
        require("spread", self.spread, 0.0..=1.0)?;
        let named = |error: InvalidFourierTexture| {
            SpeciesError::out_of_range(error.field, error.value, error.allowed).inside("texture")
        };
        self.texture.validate().map_err(named)?;
        require("cover", self.cover, 0.05..=1.0)?;
        require("outline_cover", self.outline_cover, 0.0..=self.cover)?;
        require("facets", self.facets as f32, 2.0..=16.0)?;
        require_colour("colour", self.colour)?;
        require_colour("shade_colour", self.shade_colour)?;
        require("trunk_radius_m", self.trunk_radius_m, 0.01..=5.0)
    }

    /// The same crown `scale` (0.02 to 50) times as large: younger, where less than 1.
    #[must_use]
    pub fn scaled(self, scale: f32) -> Self {
        // What is no size becomes the nearest that is one, NaN the least.
        let scale = if scale > 0.02 { scale.min(50.0) } else { 0.02 };
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

/// Where the trunk ends and where limbs leave it first, as shares of the crown's height.
const TRUNK_TOP: f32 = 0.6;
const LOWEST_LIMB: f32 = 0.08;
/// Metres that a limb rises for each metre outwards.
const LIMB_RISE: f32 = 0.7;
/// Exponent of the pipe model, about Leonardo's 2.
const PIPE_EXPONENT: f32 = 2.2;
/// The golden angle, rad.
const GOLDEN_ANGLE_RAD: f32 = 2.399_963;

/// Grows one individual, `scale` times as large as the settings say. Clusters are ellipsoids: `anchor` is on the
/// underside towards the limb, `axis` the limb's direction, `size_m` the horizontal diameter, and the middle lies half
/// a size along the axis, at the limb's tip.
#[must_use]
pub fn grow(crown: &GardnerCrown, scale: f32, random: &mut impl Rng) -> Skeleton {
    let crown = &crown.scaled(scale);
    let envelope = crown.envelope();
    let height_m = envelope.top_m - envelope.base_m;
    let lowest_m = envelope.base_m + LOWEST_LIMB * height_m;
    let mut frame = Frame::with_trunk(envelope.base_m + TRUNK_TOP * height_m, lowest_m, LIMB_RISE);
    let semi_axes = Vec3::new(envelope.radius_m, 0.5 * height_m, envelope.radius_m);
    let start_rad = random.random_range(0.0..std::f32::consts::TAU);
    let clusters = (0..crown.ellipsoids)
        .map(|index| {
            // Evenly over the sphere: equal steps in height, the golden angle around.
            let up = 1.0 - (2.0 * index as f32 + 1.0) / crown.ellipsoids as f32;
            let azimuth_rad = start_rad + GOLDEN_ANGLE_RAD * index as f32;
            let across = (1.0 - up * up).max(0.0).sqrt();
            let out = Vec3::new(across * azimuth_rad.cos(), up, across * azimuth_rad.sin());
            let share = (crown.size * (1.0 + crown.size_spread * random.random_range(-1.0..1.0))).min(1.0);
            // Similar to the crown and this far out, an ellipsoid touches it from inside.
            let place = out * ((1.0 - share) * crown.spread * random.random_range(0.6..1.0));
            let centre = envelope.centre() + place * semi_axes;
            let limb = frame.limb(centre);
            let axis = frame.beams[limb as usize].direction;
            let size_m = 2.0 * share * envelope.radius_m;
            LeafCluster {
                beam: limb,
                at: 1.0,
                anchor: centre - axis * (0.5 * size_m),
                axis,
                normal: axis.any_orthonormal_vector(),
                size_m,
                phase: random.random(),
                depth: envelope.depth(centre + out * (0.5 * size_m)),
                tint: random.random(),
            }
        })
        .collect::<Vec<_>>();
    let mut beams = frame.beams;
    pipes::assign_radii(&mut beams, &clusters, crown.trunk_radius_m, PIPE_EXPONENT);
    Skeleton { beams, clusters, envelope, trunk: crown.trunk() }
}

/// The ellipsoids of a skeleton from [`grow`], each bound to the tip of its limb. Normals are those of the ellipsoids,
/// for the renderer's `u = |n . v|`; texture coordinates are an octahedral chart, which has no pole (Praun & Hoppe
/// 2003).
#[must_use]
pub fn leaves(crown: &GardnerCrown, skeleton: &Skeleton) -> LeafVertices {
    ellipsoids::leaves(crown, skeleton)
}

/// Paints the solid texture on the octahedral chart: colour, and the alpha `a(F)` of the module's formulas, whose share
/// above 1/2 is the `cover` in every mip.
#[must_use]
pub fn texture(crown: &GardnerCrown, seed: u64) -> TextureData {
    ellipsoids::texture(crown, seed)
}
