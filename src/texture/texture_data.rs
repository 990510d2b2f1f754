//! Textures as the renderer takes them: bytes, with mips.

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
