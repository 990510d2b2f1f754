//! Textures as PNG.

use super::error::ExportError;
use crate::texture::TextureData;
use image::{
    ExtendedColorType, ImageEncoder,
    codecs::png::{CompressionType, FilterType, PngEncoder},
};

/// What of the texels of a texture is kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Channels {
    /// Red, green and blue of four channels.
    Rgb,
    /// All four.
    Rgba,
    /// The only one.
    Grey,
}

/// The first mip of a texture as a PNG. `name` is for errors.
pub(super) fn png(name: &str, texture: &TextureData, channels: Channels) -> Result<Vec<u8>, ExportError> {
    let texels = texture.mips.first().map_or(&[][..], Vec::as_slice);
    let opaque: Vec<u8>;
    let (texels, kind) = match channels {
        Channels::Grey => (texels, ExtendedColorType::L8),
        Channels::Rgba => (texels, ExtendedColorType::Rgba8),
        Channels::Rgb => {
            opaque = texels.chunks_exact(4).flat_map(|texel| &texel[..3]).copied().collect();
            (opaque.as_slice(), ExtendedColorType::Rgb8)
        }
    };
    let mut bytes = Vec::new();
    PngEncoder::new_with_quality(&mut bytes, CompressionType::Default, FilterType::Adaptive)
        .write_image(texels, texture.width, texture.height, kind)
        .map_err(|source| ExportError::Picture { name: name.to_owned(), source })?;
    Ok(bytes)
}
