//! Crowns of ellipsoids after Gardner, "Simulation of natural scenes using textured quadric surfaces" (SIGGRAPH 1984).
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
//! for `a w > 1/2` is `F > threshold(u)`. [`silhouette_alpha`](crate::tree::ellipsoid::silhouette_alpha) is `w`. The two
//! thresholds are chosen by the shares of the surface that they leave: `cover` and `outline_cover`.
//!
//! Ellipsoids are carried by their limbs and do not flutter: their species wants a leaf response with `turn` and
//! `flutter_angle_rad` 0.
//!
//! ```ron
//! Gardner(height_m: 12.0, diameter_m: 9.0, crown_size: 0.8, ellipsoids: 14, size: 0.42, size_spread: 0.3,
//!     cover: 0.85, outline_cover: 0.08)
//! ```

use bevy::math::Vec3;
use rand::{Rng, RngExt};

pub use super::gardner_settings::{ELLIPSOIDS_LIMIT, GardnerCrown};
use super::{crown_wood::CrownWood, ellipsoids};
use crate::{
    texture::TextureData,
    tree::{
        ellipsoid,
        growth::pipes,
        skeleton::{LeafCluster, Skeleton},
        vertices::LeafVertices,
    },
};

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
    let mut wood = CrownWood::with_trunk(envelope.base_m + TRUNK_TOP * height_m, lowest_m, LIMB_RISE);
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
            let limb = wood.limb(centre);
            let axis = wood.beams[limb as usize].direction;
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
    let mut beams = wood.beams;
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

/// The solid texture on the octahedral chart: colour, and the alpha `a(F)` of the module's formulas, whose share
/// above 1/2 is the `cover` in every mip.
#[must_use]
pub fn texture(crown: &GardnerCrown, seed: u64) -> TextureData {
    ellipsoid::texture(&crown.surface(), seed)
}
