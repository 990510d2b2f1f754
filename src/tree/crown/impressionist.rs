//! Impressionist crowns after Starling & Ashdown, "Impressionistic techniques for rendering woodland scenes".
//!
//! A crown is some hundred triangles to a few thousand, each standing for a group of leaves, on a partial ellipsoid
//! roughened by a 3-D texture:
//!
//! ```text
//! anchor      = surface + roughness T (core - surface)        T the texture's value at the surface, 0..1
//! normal      = inclined by 40 +- 8 degrees, away from the axis +- 20 degrees (both uniform)
//! size        = linear from the least at the top to the greatest at the widest point
//! brightness  = greatest + T (least - greatest)
//! drawn where   T < 1 - gaps
//! ```
//!
//! The paper draws where `T` is below a threshold and says that gaps grow with the threshold; here the slider does what
//! it says, and because `T` is evenly spread, `gaps` is the share of polygons left out. Its menu names TIP POINT, CURVE
//! and DISTORTION without a formula: here tip point and curve shape the outline, and the distortion is the number of
//! billows across the crown, to which roughness and gaps answer.
//!
//! Polygons come in a low-discrepancy order (Roberts' R2 sequence), so that the first `n` of a crown are a crown of `n`
//! polygons: with distance, fewer are drawn. None leaves the outline: one that would is moved inwards, or made smaller.
//!
//! In RON, a summer tree, a winter tree and a conifer:
//!
//! ```ron
//! Impressionist(form: Normal, height_m: 14.0, diameter_m: 10.0, crown_size: 0.8, roughness: 0.3, gaps: 0.15)
//! Impressionist(form: Winter, height_m: 14.0, diameter_m: 10.0, polygons: 900, limbs: 16, branches: 6, width: 0.6,
//!     hue_deg: 28.0, saturation: 0.3, greatest_brightness: 0.45, least_brightness: 0.25)
//! Impressionist(form: Conifer, height_m: 18.0, diameter_m: 6.0, crown_size: 0.93, widest_at: 0.06, tip_point: 1.0,
//!     hue_deg: 135.0, distortion: 7.0)
//! ```

use rand::Rng;

pub use super::impressionist_settings::{BRANCHES_LIMIT, CrownForm, ImpressionistCrown, LIMBS_LIMIT};
use super::{
    polygon_texture::{polygon_texture, rgb},
    polygons,
};
use crate::{
    texture::TextureData,
    tree::{skeleton::Skeleton, vertices::LeafVertices},
};

/// Grows one individual, `scale` (above 0) times as large as the settings say. Clusters are polygons: `anchor` the
/// corner that lies on the roughened surface, `axis` from there to the middle of the opposite side, `size_m` its
/// length, `depth` the texture's value, 0 outermost to 1.
#[must_use]
pub fn grow(crown: &ImpressionistCrown, scale: f32, random: &mut impl Rng) -> Skeleton {
    polygons::grow(&crown.scaled(scale), random)
}

/// The polygons of a skeleton from [`grow`], three vertices each, flat shaded (towards the way out in winter, when they
/// are twigs); ambient light is [`ImpressionistCrown::light`]. Texture coordinates: the anchor (0.5, 1), the others (0,
/// 0) and (1, 0).
#[must_use]
pub fn leaves(crown: &ImpressionistCrown, skeleton: &Skeleton) -> LeafVertices {
    leaves_at(crown, skeleton, 0.0)
}

/// The same for a grown crown seen from `distance_m`: fewer polygons, and larger ones. Of a younger one, the distance is that from
/// which the grown one looks as large.
#[must_use]
pub fn leaves_at(crown: &ImpressionistCrown, skeleton: &Skeleton, distance_m: f32) -> LeafVertices {
    let all = skeleton.clusters.len();
    let count = ((crown.polygon_share_at(distance_m) * all as f32).ceil() as usize).clamp(1, all.max(1));
    polygons::leaves(crown, skeleton, count, (all as f32 / count as f32).sqrt())
}

/// The texture of a polygon: a triangle with ragged edges, in winter a spray of bare twigs.
#[must_use]
pub fn texture(crown: &ImpressionistCrown, seed: u64) -> TextureData {
    polygon_texture(crown, seed)
}

/// The colour of a polygon by the texture's value at its anchor (0 outermost to 1), sRGB: hue and saturation of the crown, and a
/// brightness that falls towards the middle.
#[must_use]
pub fn polygon_colour(crown: &ImpressionistCrown, depth: f32) -> [f32; 3] {
    let (least, greatest) = (crown.least_brightness, crown.greatest_brightness);
    rgb(crown.hue_deg, crown.saturation, greatest + depth.clamp(0.0, 1.0) * (least - greatest))
}
