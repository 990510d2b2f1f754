//! The texture of ellipsoids: a solid one, sampled on the chart as on the sphere, so that it has no seam.

use bevy::math::Vec2;

use super::{chart::unfolded, surface::EllipsoidSurface};
use crate::texture::{
    LinearImage, MASK_CUT_OFF, TextureData,
    fourier::{FourierTexture, threshold_above},
    linear, mix,
};

/// Side of the texture, texels.
const SIZE: usize = 512;
/// Least distance between the two thresholds, in ranks.
const LEAST_RISE: f32 = 1e-3;

/// What a renderer multiplies the texture's alpha with where the cosine between normal and eye is `facing` (of either
/// sign): `w(u) = 1 / (2 - u^2)`, 1/2 on the outline to 1 in the middle.
#[must_use]
pub fn silhouette_alpha(facing: f32) -> f32 {
    1.0 / (2.0 - (facing * facing).min(1.0))
}

/// The solid texture on the octahedral chart: colour, and the alpha of [`gardner`](crate::tree::crown::gardner)'s formulas,
/// which has the same shares in every mip, that above 1/2 being the `cover`.
pub(in crate::tree) fn texture(surface: &EllipsoidSurface, seed: u64) -> TextureData {
    let colours = [linear(surface.shade_colour), linear(surface.colour)];
    let mut canvas = LinearImage::filled(SIZE, [0.0; 4]);
    let settings = FourierTexture { seed: surface.texture.seed ^ seed, ..surface.texture };
    // Valid surfaces have valid textures.
    let Ok(waves) = settings.waves() else { return canvas.into_weighed_mask_texture() };
    let place = |index: usize| Vec2::new((index % SIZE) as f32 + 0.5, (index / SIZE) as f32 + 0.5) / SIZE as f32;
    let values: Vec<f32> = (0..SIZE * SIZE).map(|index| waves.at_solid(unfolded(place(index)))).collect();
    let threshold = |share: f32| threshold_above(values.clone(), share);
    let (middle, outline) = (threshold(surface.cover), threshold(surface.outline_cover));
    let (darkest, brightest) = (threshold(0.98), threshold(0.02));
    let rise = (outline - middle).max(LEAST_RISE);
    for (texel, value) in canvas.texels.iter_mut().zip(&values) {
        let tone = ((value - darkest) / (brightest - darkest).max(1e-6)).clamp(0.0, 1.0);
        let [red, green, blue] = mix(colours[0], colours[1], tone);
        let alpha = MASK_CUT_OFF * (1.0 + (value - middle) / rise);
        *texel = [red, green, blue, alpha.clamp(0.0, 1.0)];
    }
    canvas.into_weighed_mask_texture()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::texture::test_masks::drawn_share;

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
        let surface = EllipsoidSurface::default();
        let texture = texture(&surface, 5);
        let passing = |mip: usize, weight: f32| {
            let texels = &texture.mips[mip];
            let pass = texels.chunks_exact(4).filter(|t| f32::from(t[3]) / 255.0 * weight > MASK_CUT_OFF).count();
            pass as f32 / (texels.len() / 4) as f32
        };
        assert!((passing(0, silhouette_alpha(1.0)) - surface.cover).abs() < 0.01);
        // Just inside the outline: alpha is cut at 1, which the outline itself turns into exactly the cut-off.
        assert!((passing(0, silhouette_alpha(0.05)) - surface.outline_cover).abs() < 0.01);
        (1..5).for_each(|mip| {
            assert!((passing(mip, 1.0) - surface.cover).abs() < 0.03, "mip {mip}: {}", passing(mip, 1.0));
        });
        // Of those that are drawn the coarsest is the third.
        for mip in 1..4 {
            let outline = passing(mip, silhouette_alpha(0.05));
            assert!((outline - surface.outline_cover).abs() < 0.01, "mip {mip}: {outline}");
            let share = drawn_share(&texture, mip);
            assert!((share - surface.cover).abs() < 0.03, "mip {mip}: {share}");
        }
    }
}
