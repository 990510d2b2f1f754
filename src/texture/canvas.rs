//! Pixels with a full chain of mips, made on the CPU.
//!
//! Colours are averaged as light (linear), not as sRGB. In a mask's mips plain averaging thins the leaves with
//! distance, for the cut-off keeps only what is more than half covered; each mip's alpha is therefore scaled until
//! as many of its texels pass the cut-off as in the first (Castaño, "Computing alpha mipmaps", 2010).

use std::sync::LazyLock;

/// A texture of 8-bit channels with mips.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TextureData {
    /// Width of the first mip, texels, a power of two.
    pub width: u32,
    /// Height of the first mip, texels, a power of two.
    pub height: u32,
    /// Rows from the top, one `Vec` per mip.
    pub mips: Vec<Vec<u8>>,
    /// What a texel is.
    pub texels: Texels,
}

/// What a texel of a texture is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Texels {
    /// Red, green and blue as sRGB, and a linear alpha.
    Colour,
    /// Four linear channels, such as normals.
    Linear,
    /// One linear channel.
    Share,
}

/// Alpha above which a texel of a mask is drawn.
pub const MASK_CUT_OFF: f32 = 0.5;

/// A little more than half a step of an 8-bit channel: what keeps a value above the cut-off when it is rounded.
pub(crate) const HALF_A_STEP: f32 = 0.6 / 255.0;

/// An image in linear floats, before it is a texture.
#[derive(Clone, Debug)]
pub(crate) struct Canvas {
    pub width: usize,
    pub height: usize,
    /// Linear red, green, blue and alpha, 0..1 (normals: -1..1, alpha free for another measure, 0..1).
    pub texels: Vec<[f32; 4]>,
}

impl TextureData {
    /// A texture of no height, to which others of its width are to be added.
    pub(crate) fn empty(width: u32, texels: Texels) -> Self {
        Self { width, height: 0, mips: Vec::new(), texels }
    }

    /// Adds a texture of the same width, kind and number of mips, mip by mip, at the bottom.
    pub(crate) fn add_below(&mut self, other: &Self) {
        self.height += other.height;
        self.mips.resize_with(other.mips.len(), Vec::new);
        self.mips.iter_mut().zip(&other.mips).for_each(|(own, other)| own.extend(other));
    }
}

impl Canvas {
    /// A canvas of `size` x `size` texels of one colour.
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

    /// Share of texels that pass the cut-off.
    fn coverage(&self) -> f32 {
        let drawn = self.texels.iter().filter(|texel| texel[3] > MASK_CUT_OFF).count();
        drawn as f32 / self.texels.len() as f32
    }

    /// Scales alpha so that the given share of texels passes the cut-off: the faintest of them lands just on it.
    fn scale_alpha_to(&mut self, coverage: f32) {
        let mut alphas: Vec<f32> = self.texels.iter().map(|texel| texel[3]).collect();
        let drawn = (coverage * alphas.len() as f32).round() as usize;
        let Some(last) = drawn.checked_sub(1) else { return };
        let (_, &mut faintest, _) = alphas.select_nth_unstable_by(last, |a, b| b.total_cmp(a));
        let scale = (MASK_CUT_OFF + HALF_A_STEP) / faintest.max(1e-3);
        self.texels.iter_mut().for_each(|texel| texel[3] = (texel[3] * scale).min(1.0));
    }

    /// Half the size, for what was painted at twice the resolution; colour comes from what is covered.
    pub(crate) fn downsampled(&self) -> Self {
        self.halved(|texel| texel[3] + 1e-4)
    }

    /// Opaque colours.
    pub(crate) fn into_colour_texture(self) -> TextureData {
        self.into_texture(|canvas| canvas.halved(|_| 1.0), colour_bytes, Texels::Colour)
    }

    /// Colours with a mask whose coverage stays the same in every mip.
    pub(crate) fn into_mask_texture(self) -> TextureData {
        let coverage = self.coverage();
        let shrink = |canvas: &Self| {
            let mut half = canvas.downsampled();
            half.scale_alpha_to(coverage);
            half
        };
        self.into_texture(shrink, colour_bytes, Texels::Colour)
    }

    /// Measures that are no colours, each channel averaged by itself.
    pub(crate) fn into_linear_texture(self) -> TextureData {
        self.into_texture(|canvas| canvas.halved(|_| 1.0), linear_bytes, Texels::Linear)
    }

    /// Unit normals in tangent space; alpha is kept.
    pub(crate) fn into_normal_texture(self) -> TextureData {
        self.into_texture(|canvas| canvas.halved(|_| 1.0), normal_bytes, Texels::Linear)
    }

    fn into_texture(
        self,
        shrink: impl Fn(&Self) -> Self,
        bytes: fn(&[f32; 4]) -> [u8; 4],
        texels: Texels,
    ) -> TextureData {
        let (width, height) = (self.width as u32, self.height as u32);
        let mut mips = Vec::new();
        let mut canvas = self;
        loop {
            mips.push(canvas.texels.iter().flat_map(bytes).collect());
            if canvas.width * canvas.height <= 1 {
                break;
            }
            canvas = shrink(&canvas);
        }
        TextureData { width, height, mips, texels }
    }
}

pub(crate) fn colour_bytes(texel: &[f32; 4]) -> [u8; 4] {
    [srgb_byte(texel[0]), srgb_byte(texel[1]), srgb_byte(texel[2]), byte(texel[3])]
}

fn normal_bytes(texel: &[f32; 4]) -> [u8; 4] {
    let length = (texel[0] * texel[0] + texel[1] * texel[1] + texel[2] * texel[2]).sqrt().max(1e-6);
    let channel = |value: f32| byte(0.5 + 0.5 * value / length);
    [channel(texel[0]), channel(texel[1]), channel(texel[2]), byte(texel[3])]
}

pub(crate) fn linear_bytes(texel: &[f32; 4]) -> [u8; 4] {
    texel.map(byte)
}

pub(crate) fn byte(value: f32) -> u8 {
    (value.clamp(0.0, 1.0) * 255.0 + 0.5) as u8
}

/// The sRGB transfer function (IEC 61966-2-1), looked up: a power for each channel of each texel is what painting would
/// mostly cost.
fn srgb_byte(linear: f32) -> u8 {
    static BYTES: LazyLock<Vec<u8>> = LazyLock::new(|| {
        let encoded = |linear: f32| {
            if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
        };
        (0..=SRGB_STEPS).map(|step| byte(encoded(step as f32 / SRGB_STEPS as f32))).collect()
    });
    BYTES[(linear.clamp(0.0, 1.0) * SRGB_STEPS as f32 + 0.5) as usize]
}

/// Steps of linear light told apart: black's slope is 12.92, so that one step is a fifth of a byte there.
const SRGB_STEPS: usize = 16_384;

/// An sRGB colour as light.
pub(crate) fn linear(srgb: [f32; 3]) -> [f32; 3] {
    srgb.map(|value| if value <= 0.040_45 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) })
}

/// The colour `share` of the way from one to another.
pub(crate) fn mix(from: [f32; 3], to: [f32; 3], share: f32) -> [f32; 3] {
    std::array::from_fn(|channel| from[channel] + (to[channel] - from[channel]) * share)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Discs of many sizes on a clear ground: a mask that thins fast when it is merely averaged.
    fn spots() -> Canvas {
        let mut canvas = Canvas::filled(256, [0.1, 0.3, 0.05, 0.0]);
        for index in 0..canvas.texels.len() {
            let (x, y) = ((index % 256 % 16) as f32 - 8.0, (index / 256 % 16) as f32 - 8.0);
            let disc = index % 256 / 16 + 16 * (index / 4096);
            let radius = 2.0 + 4.0 * (disc * 37 % 256) as f32 / 256.0;
            canvas.texels[index][3] = (radius - x.hypot(y) + 0.5).clamp(0.0, 1.0);
        }
        canvas
    }

    fn drawn_share(mip: &[u8]) -> f32 {
        let drawn = mip.chunks_exact(4).filter(|texel| f32::from(texel[3]) / 255.0 > MASK_CUT_OFF).count();
        drawn as f32 / (mip.len() / 4) as f32
    }

    #[test]
    fn mips_run_down_to_one_texel() {
        let texture = spots().into_colour_texture();
        let sizes: Vec<usize> = texture.mips.iter().map(|mip| mip.len() / 4).collect();
        assert_eq!(sizes, [65_536, 16_384, 4096, 1024, 256, 64, 16, 4, 1]);
    }

    #[test]
    fn a_colour_is_the_mean_of_its_light() {
        let mut canvas = Canvas::filled(2, [0.0, 0.0, 0.0, 1.0]);
        canvas.texels[0] = [1.0, 1.0, 1.0, 1.0];
        canvas.texels[3] = [1.0, 1.0, 1.0, 1.0];
        let texture = canvas.into_colour_texture();
        // Half the light is sRGB 188, not 128.
        assert_eq!(texture.mips[1], [188, 188, 188, 255]);
    }

    #[test]
    fn what_is_clear_lends_no_colour() {
        let mut canvas = Canvas::filled(2, [1.0, 0.0, 0.0, 0.0]);
        canvas.texels[0] = [0.0, 1.0, 0.0, 1.0];
        let mean = canvas.downsampled().texels[0];
        assert!(mean[1] > 0.99 && mean[0] < 0.01);
    }

    #[test]
    fn normals_stay_unit_vectors() {
        let mut canvas = Canvas::filled(4, [0.0, 0.0, 3.0, 1.0]);
        canvas.texels[5] = [2.0, -1.0, 1.0, 1.0];
        for mip in canvas.into_normal_texture().mips {
            for texel in mip.chunks_exact(4) {
                let length: f32 = texel[..3].iter().map(|&b| (f32::from(b) / 127.5 - 1.0).powi(2)).sum::<f32>().sqrt();
                // Each channel is rounded to 1/255 of the range 2.
                assert!((length - 1.0).abs() < 0.01, "{length}");
            }
        }
    }

    #[test]
    fn discs_cover_as_much_in_every_mip() {
        let texture = spots().into_mask_texture();
        let full = drawn_share(&texture.mips[0]);
        // The smallest mip here has 16 x 16 texels, of which one is 0.4%; texels of equal alpha pass together.
        for mip in &texture.mips[1..5] {
            assert!((drawn_share(mip) - full).abs() < 0.02, "{} against {full}", drawn_share(mip));
        }
    }
}
