//! Images in linear floats, from which textures with a full chain of mips are made.
//!
//! Colours are averaged as light (linear), not as sRGB. In a mask's mips plain averaging thins the leaves with
//! distance, for the cut-off keeps only what is more than half covered. Each mip's alpha is therefore scaled until
//! as much of it passes the cut-off as of the first (Castaño, "Computing alpha mipmaps", 2010): between texels, too, where few that pass
//! by themselves are interpolated with many that do not.

use super::{
    encoding::{HALF_A_STEP, colour_bytes, linear_bytes, normal_bytes},
    texture_data::{MASK_CUT_OFF, Texels, TextureData},
};

/// Places each way in a texel at which a mask is looked at.
const PLACES_A_TEXEL: usize = 2;

/// An image in linear floats, before it is a texture.
#[derive(Clone, Debug)]
pub(crate) struct LinearImage {
    pub width: usize,
    pub height: usize,
    /// Linear red, green, blue and alpha, 0..1 (normals: -1..1, alpha free for another measure, 0..1).
    pub texels: Vec<[f32; 4]>,
}

impl LinearImage {
    /// An image of `size` x `size` texels of one colour.
    pub(crate) fn filled(size: usize, texel: [f32; 4]) -> Self {
        Self { width: size, height: size, texels: vec![texel; size * size] }
    }

    /// Half the size: each texel the mean of four, colours weighted by `weight` of each texel.
    fn halved(&self, weight: impl Fn(&[f32; 4]) -> f32) -> Self {
        let (width, height) = ((self.width / 2).max(1), (self.height / 2).max(1));
        let mut texels = Vec::with_capacity(width * height);
        for y in 0..height {
            for x in 0..width {
                texels.push(self.mean_of_four(2 * x, 2 * y, &weight));
            }
        }
        Self { width, height, texels }
    }

    fn mean_of_four(&self, x: usize, y: usize, weight: impl Fn(&[f32; 4]) -> f32) -> [f32; 4] {
        let (right, below) = ((x + 1).min(self.width - 1), (y + 1).min(self.height - 1));
        let mut sum = [0.0; 4];
        let mut weights = 0.0;
        for (x, y) in [(x, y), (right, y), (x, below), (right, below)] {
            let texel = &self.texels[y * self.width + x];
            let weight = weight(texel);
            (0..3).for_each(|channel| sum[channel] += weight * texel[channel]);
            sum[3] += 0.25 * texel[3];
            weights += weight;
        }
        [sum[0] / weights, sum[1] / weights, sum[2] / weights, sum[3]]
    }

    /// Share of the image that passes the cut-off, between texels as well.
    pub(crate) fn coverage(&self) -> f32 {
        let alphas = self.interpolated_alphas();
        alphas.iter().filter(|alpha| **alpha > MASK_CUT_OFF).count() as f32 / alphas.len() as f32
    }

    /// Scales alpha so that the given share passes the cut-off, between texels as well. What is cut off at one lowers what is between, so
    /// that is done twice.
    fn scale_alpha_to(&mut self, coverage: f32) {
        for _ in 0..2 {
            let mut alphas = self.interpolated_alphas();
            let drawn = (coverage * alphas.len() as f32).round() as usize;
            let Some(last) = drawn.checked_sub(1) else { return };
            let (_, &mut faintest, _) = alphas.select_nth_unstable_by(last, |a, b| b.total_cmp(a));
            let scale = (MASK_CUT_OFF + HALF_A_STEP) / faintest.max(1e-3);
            self.texels.iter_mut().for_each(|texel| texel[3] = (texel[3] * scale).min(1.0));
        }
    }

    /// Alpha at evenly spaced places, as it is seen: interpolated between the nearest four texels, with that of the rim beyond it.
    fn interpolated_alphas(&self) -> Vec<f32> {
        let places = |across: usize| {
            (0..across * PLACES_A_TEXEL).map(move |place| {
                let at = ((place as f32 + 0.5) / PLACES_A_TEXEL as f32 - 0.5).clamp(0.0, across as f32 - 1.0);
                let low = at as usize;
                (low, (low + 1).min(across - 1), at - low as f32)
            })
        };
        let mut alphas = Vec::with_capacity(self.texels.len() * PLACES_A_TEXEL * PLACES_A_TEXEL);
        for (low_y, high_y, share_y) in places(self.height) {
            let alpha = |x: usize| {
                let [low, high] = [low_y, high_y].map(|y| self.texels[y * self.width + x][3]);
                low + (high - low) * share_y
            };
            alphas.extend(places(self.width).map(|(low_x, high_x, share_x)| {
                let [low, high] = [low_x, high_x].map(alpha);
                low + (high - low) * share_x
            }));
        }
        alphas
    }

    /// Half the size, for what was drawn at twice the resolution; colour comes from what is covered.
    pub(crate) fn downsampled(&self) -> Self {
        self.halved(|texel| texel[3] + 1e-4)
    }

    /// Opaque colours.
    pub(crate) fn into_colour_texture(self) -> TextureData {
        self.into_texture(|image| image.halved(|_| 1.0), colour_bytes, Texels::Colour)
    }

    /// Colours with a mask whose coverage stays the same in every mip.
    pub(crate) fn into_mask_texture(self) -> TextureData {
        Self::mask_texture(vec![self])
    }

    /// The same, of which the first mips are drawn, each of half the size of the one before.
    pub(crate) fn mask_texture(drawn: Vec<Self>) -> TextureData {
        let coverage = drawn.first().map_or(0.0, Self::coverage);
        let shrink = |image: &Self| {
            let mut half = image.downsampled();
            half.scale_alpha_to(coverage);
            half
        };
        Self::texture(drawn, shrink, colour_bytes, Texels::Colour)
    }

    /// Colours with an alpha that is weighed before it is cut off: in every mip all alphas have the shares that they have in the first, so that
    /// as much passes whatever the weight is.
    pub(crate) fn into_weighed_mask_texture(self) -> TextureData {
        let mut alphas: Vec<f32> = self.texels.iter().map(|texel| texel[3]).collect();
        alphas.sort_by(f32::total_cmp);
        let shrink = |image: &Self| {
            let mut half = image.downsampled();
            half.rank_alphas_as(&alphas);
            half
        };
        self.into_texture(shrink, colour_bytes, Texels::Colour)
    }

    /// Gives each alpha the one of its rank among others, which are sorted.
    fn rank_alphas_as(&mut self, alphas: &[f32]) {
        let count = self.texels.len();
        let mut order: Vec<usize> = (0..count).collect();
        order.sort_by(|a, b| self.texels[*a][3].total_cmp(&self.texels[*b][3]));
        for (rank, texel) in order.into_iter().enumerate() {
            self.texels[texel][3] = alphas[(2 * rank + 1) * alphas.len() / (2 * count)];
        }
    }

    /// Measures that are no colours, each channel averaged by itself.
    pub(crate) fn into_linear_texture(self) -> TextureData {
        self.into_texture(|image| image.halved(|_| 1.0), linear_bytes, Texels::Linear)
    }

    /// Unit normals in tangent space; alpha is kept.
    pub(crate) fn into_normal_texture(self) -> TextureData {
        self.into_texture(|image| image.halved(|_| 1.0), normal_bytes, Texels::Linear)
    }

    fn into_texture(
        self,
        shrink: impl Fn(&Self) -> Self,
        bytes: fn(&[f32; 4]) -> [u8; 4],
        texels: Texels,
    ) -> TextureData {
        Self::texture(vec![self], shrink, bytes, texels)
    }

    /// The texture of its first mips, one at least; the others are shrunk from the last of these.
    fn texture(
        mut drawn: Vec<Self>,
        shrink: impl Fn(&Self) -> Self,
        bytes: fn(&[f32; 4]) -> [u8; 4],
        texels: Texels,
    ) -> TextureData {
        while let Some(last) = drawn.last().filter(|last| last.width * last.height > 1) {
            drawn.push(shrink(last));
        }
        let [width, height] = drawn.first().map_or([0; 2], |first| [first.width as u32, first.height as u32]);
        let mips = drawn.iter().map(|image| image.texels.iter().flat_map(bytes).collect()).collect();
        TextureData { width, height, mips, texels }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::texture::test_masks::drawn_share;

    /// Discs of many sizes on a clear ground: a mask that thins fast when it is merely averaged.
    fn spots() -> LinearImage {
        let mut image = LinearImage::filled(256, [0.1, 0.3, 0.05, 0.0]);
        for index in 0..image.texels.len() {
            let (x, y) = ((index % 256 % 16) as f32 - 8.0, (index / 256 % 16) as f32 - 8.0);
            let disc = index % 256 / 16 + 16 * (index / 4096);
            let radius = 2.0 + 4.0 * (disc * 37 % 256) as f32 / 256.0;
            image.texels[index][3] = (radius - x.hypot(y) + 0.5).clamp(0.0, 1.0);
        }
        image
    }

    #[test]
    fn mips_run_down_to_one_texel() {
        let texture = spots().into_colour_texture();
        let sizes: Vec<usize> = texture.mips.iter().map(|mip| mip.len() / 4).collect();
        assert_eq!(sizes, [65_536, 16_384, 4096, 1024, 256, 64, 16, 4, 1]);
    }

    #[test]
    fn mips_average_linear_light() {
        let mut image = LinearImage::filled(2, [0.0, 0.0, 0.0, 1.0]);
        image.texels[0] = [1.0, 1.0, 1.0, 1.0];
        image.texels[3] = [1.0, 1.0, 1.0, 1.0];
        let texture = image.into_colour_texture();
        // Half the light is sRGB 188, not 128.
        assert_eq!(texture.mips[1], [188, 188, 188, 255]);
    }

    #[test]
    fn clear_texels_add_no_colour() {
        let mut image = LinearImage::filled(2, [1.0, 0.0, 0.0, 0.0]);
        image.texels[0] = [0.0, 1.0, 0.0, 1.0];
        let mean = image.downsampled().texels[0];
        assert!(mean[1] > 0.99 && mean[0] < 0.01);
    }

    #[test]
    fn normals_stay_unit_vectors() {
        let mut image = LinearImage::filled(4, [0.0, 0.0, 3.0, 1.0]);
        image.texels[5] = [2.0, -1.0, 1.0, 1.0];
        for mip in image.into_normal_texture().mips {
            for texel in mip.chunks_exact(4) {
                let length: f32 = texel[..3].iter().map(|&b| (f32::from(b) / 127.5 - 1.0).powi(2)).sum::<f32>().sqrt();
                // Each channel is rounded to 1/255 of the range 2.
                assert!((length - 1.0).abs() < 0.01, "{length}");
            }
        }
    }

    #[test]
    fn masks_keep_their_coverage_in_every_mip() {
        let texture = spots().into_mask_texture();
        let full = drawn_share(&texture, 0);
        // The smallest mip here has 8 x 8 texels.
        for mip in 1..6 {
            let share = drawn_share(&texture, mip);
            assert!((share - full).abs() < 0.02, "{share} against {full}");
        }
    }
}
