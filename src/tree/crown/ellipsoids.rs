//! Surfaces and texture of Gardner's ellipsoids; see [`gardner`](super::gardner).
//!
//! A sphere is charted by the octahedron that is unfolded onto the unit square, its upper half the diamond in the
//! middle, its lower half the four corners: with `d / (|x| + |y| + |z|) = (x, y, z)`,
//!
//! ```text
//! (u, v) = (x, z)                                      for y >= 0
//! (u, v) = ((1 - |z|) sign x, (1 - |x|) sign z)        below,             both brought from -1..1 to 0..1
//! ```
//!
//! The texture is a solid one, sampled on that chart as on the sphere: it has no seam where the square's edges meet.

use bevy::math::{Quat, Vec2, Vec3};

use super::gardner_settings::GardnerCrown;
use crate::{
    texture::{
        LinearImage, MASK_CUT_OFF, TextureData,
        fourier::{FourierTexture, threshold_above},
        linear, mix,
    },
    tree::{
        skeleton::{LeafCluster, Skeleton},
        vertices::LeafVertices,
    },
};

/// Side of the texture, texels.
const SIZE: usize = 512;
/// Least distance between the two thresholds, in ranks.
const LEAST_RISE: f32 = 1e-3;
/// Ambient light at the middle of the crown, and on the lower side of an ellipsoid, against that on top.
const DEEP_LIGHT: f32 = 0.3;
const UNDERSIDE_LIGHT: f32 = 0.45;

/// What a renderer multiplies the texture's alpha with where the cosine between normal and eye is `facing` (of either
/// sign): `w(u) = 1 / (2 - u^2)`, 1/2 on the outline to 1 in the middle.
#[must_use]
pub fn silhouette_alpha(facing: f32) -> f32 {
    1.0 / (2.0 - (facing * facing).min(1.0))
}

pub(super) fn leaves(crown: &GardnerCrown, skeleton: &Skeleton) -> LeafVertices {
    let mut out = LeafVertices::default();
    for cluster in &skeleton.clusters {
        push_ellipsoid(crown, skeleton, cluster, &mut out);
    }
    out
}

fn push_ellipsoid(crown: &GardnerCrown, skeleton: &Skeleton, cluster: &LeafCluster, out: &mut LeafVertices) {
    let first = out.positions.len() as u32;
    let steps = 2 * crown.facets;
    let centre = cluster.anchor + cluster.axis * (0.5 * cluster.size_m);
    let semi_axes = Vec3::new(1.0, crown.slenderness(), 1.0) * (0.5 * cluster.size_m);
    // Each ellipsoid is turned otherwise, so that they do not show the same leaves on the same side.
    let turn = Quat::from_rotation_y(std::f32::consts::TAU * cluster.phase);
    for row in 0..=steps {
        for column in 0..=steps {
            let uv = Vec2::new(column as f32, row as f32) / steps as f32;
            let sphere = turn * unfolded(uv);
            let position = centre + sphere * semi_axes;
            let normal = (sphere / semi_axes).try_normalize().unwrap_or(Vec3::Y);
            let light = light(skeleton, position, normal);
            out.positions.push(position.to_array());
            out.normals.push(normal.to_array());
            out.uvs.push(uv.to_array());
            out.sway.push([cluster.beam as f32, cluster.at, cluster.phase, light]);
            out.axis.push(cluster.axis.extend(cluster.tint).to_array());
            out.anchor.push(cluster.anchor.extend(0.0).to_array());
        }
    }
    for row in 0..steps {
        for column in 0..steps {
            out.indices.extend(cell(row, column, steps).map(|index| first + index));
        }
    }
}

/// The two triangles of a cell of the chart, split along the octahedron's edges, counter-clockwise from outside.
fn cell(row: u32, column: u32, steps: u32) -> [u32; 6] {
    let low = row * (steps + 1) + column;
    let (right, below, across) = (low + 1, low + steps + 1, low + steps + 2);
    let half = steps / 2;
    if (row < half) == (column < half) {
        [low, below, right, right, below, across]
    } else {
        [low, below, across, low, across, right]
    }
}

/// Light that reaches a point: less towards the crown's middle and from below.
fn light(skeleton: &Skeleton, point: Vec3, normal: Vec3) -> f32 {
    let outer = 1.0 - skeleton.envelope.depth(point);
    let open = DEEP_LIGHT + (1.0 - DEEP_LIGHT) * outer * outer;
    open * (UNDERSIDE_LIGHT + (1.0 - UNDERSIDE_LIGHT) * (0.5 + 0.5 * normal.y))
}

/// Direction of a place on the chart.
fn unfolded(uv: Vec2) -> Vec3 {
    let [x, z] = [2.0 * uv.x - 1.0, 2.0 * uv.y - 1.0];
    let y = 1.0 - x.abs() - z.abs();
    let fold = |along: f32, across: f32| if y < 0.0 { (1.0 - across.abs()) * 1.0_f32.copysign(along) } else { along };
    Vec3::new(fold(x, z), y, fold(z, x)).normalize()
}

pub(super) fn texture(crown: &GardnerCrown, seed: u64) -> TextureData {
    let colours = [linear(crown.shade_colour), linear(crown.colour)];
    let mut canvas = LinearImage::filled(SIZE, [0.0; 4]);
    let settings = FourierTexture { seed: crown.texture.seed ^ seed, ..crown.texture };
    // Valid crowns have valid textures.
    let Ok(waves) = settings.waves() else { return canvas.into_mask_texture() };
    let place = |index: usize| Vec2::new((index % SIZE) as f32 + 0.5, (index / SIZE) as f32 + 0.5) / SIZE as f32;
    let values: Vec<f32> = (0..SIZE * SIZE).map(|index| waves.at_solid(unfolded(place(index)))).collect();
    let threshold = |share: f32| threshold_above(values.clone(), share);
    let (middle, outline) = (threshold(crown.cover), threshold(crown.outline_cover));
    let (darkest, brightest) = (threshold(0.98), threshold(0.02));
    let rise = (outline - middle).max(LEAST_RISE);
    for (texel, value) in canvas.texels.iter_mut().zip(&values) {
        let tone = ((value - darkest) / (brightest - darkest).max(1e-6)).clamp(0.0, 1.0);
        let [red, green, blue] = mix(colours[0], colours[1], tone);
        let alpha = MASK_CUT_OFF * (1.0 + (value - middle) / rise);
        *texel = [red, green, blue, alpha.clamp(0.0, 1.0)];
    }
    canvas.into_mask_texture()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};

    /// The chart's other way, straight from the formulas.
    fn folded(direction: Vec3) -> Vec2 {
        let d = direction / direction.abs().element_sum();
        let flat = if d.y >= 0.0 {
            Vec2::new(d.x, d.z)
        } else {
            Vec2::new((1.0 - d.z.abs()) * d.x.signum(), (1.0 - d.x.abs()) * d.z.signum())
        };
        0.5 * flat + 0.5
    }

    #[test]
    fn the_chart_is_a_bijection() {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(3);
        for _ in 0..2000 {
            let uv = Vec2::new(random.random(), random.random());
            assert!((folded(unfolded(uv)) - uv).length() < 1e-4, "{uv}");
        }
    }

    #[test]
    fn the_chart_distorts_no_part_of_the_sphere_much() {
        let area = |uv: Vec2| {
            let step = 1e-3;
            let [a, b, c] = [uv, uv + Vec2::X * step, uv + Vec2::Y * step].map(unfolded);
            (b - a).cross(c - a).length() / (step * step)
        };
        let areas: Vec<f32> =
            (0..400).map(|n| area(Vec2::new((n % 20) as f32 + 0.4, (n / 20) as f32 + 0.45) / 20.0)).collect();
        let (least, greatest) = areas.iter().fold((f32::MAX, 0.0_f32), |(l, g), &a| (l.min(a), g.max(a)));
        // The density of the octahedral chart runs from 4 at its corners to 4 3^(3/2) in the middle of its faces.
        assert!(least > 3.5 && greatest < 22.0, "{least} to {greatest}");
    }

    /// The fixed cut-off with both alphas is Gardner's rising threshold.
    #[test]
    fn the_two_alphas_make_the_rising_threshold() {
        let (middle, outline) = (0.3_f32, 0.7_f32);
        for facing in [-1.0_f32, -0.6, 0.05, 0.3, 0.9, 1.0] {
            let threshold = middle + (outline - middle) * (1.0 - facing * facing);
            for step in 0..1000 {
                let value = step as f32 / 1000.0 + 0.0004;
                let alpha = (MASK_CUT_OFF * (1.0 + (value - middle) / (outline - middle))).clamp(0.0, 1.0);
                assert_eq!(alpha * silhouette_alpha(facing) > MASK_CUT_OFF, value > threshold, "{facing} {value}");
            }
        }
    }

    #[test]
    fn the_texture_covers_what_the_settings_say_in_the_middle_and_on_the_outline() {
        let crown = GardnerCrown::default();
        let texture = texture(&crown, 5);
        let passing = |mip: usize, weight: f32| {
            let texels = &texture.mips[mip];
            let pass = texels.chunks_exact(4).filter(|t| f32::from(t[3]) / 255.0 * weight > MASK_CUT_OFF).count();
            pass as f32 / (texels.len() / 4) as f32
        };
        assert!((passing(0, silhouette_alpha(1.0)) - crown.cover).abs() < 0.01);
        // Just inside the outline: alpha is cut at 1, which the outline itself turns into exactly the cut-off.
        assert!((passing(0, silhouette_alpha(0.05)) - crown.outline_cover).abs() < 0.01);
        (1..5).for_each(|mip| {
            assert!((passing(mip, 1.0) - crown.cover).abs() < 0.03, "mip {mip}: {}", passing(mip, 1.0));
        });
    }
}
