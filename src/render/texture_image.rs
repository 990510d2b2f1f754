//! Textures with their mips as Bevy images.

use crate::texture::{Texels, TextureData};
use bevy::{
    asset::RenderAssetUsages,
    image::{Image, ImageAddressMode, ImageFilterMode, ImageSampler, ImageSamplerDescriptor},
    render::render_resource::{Extent3d, TextureDimension, TextureFormat},
    utils::default,
};
use texpresso::{Algorithm, COLOUR_WEIGHTS_PERCEPTUAL, COLOUR_WEIGHTS_UNIFORM, Format, Params};

/// A texture that repeats, as an image with all its mips: bark on a log, litter on a path.
#[must_use]
pub fn repeating_image(texture: &TextureData) -> Image {
    image(texture, ImageAddressMode::Repeat, ALL_MIPS)
}

/// A texture as an image with its mips. `coarsest_mip` is the last one that is sampled.
pub(crate) fn image(texture: &TextureData, address_mode: ImageAddressMode, coarsest_mip: f32) -> Image {
    let format = match texture.texels {
        Texels::Colour => TextureFormat::Rgba8UnormSrgb,
        Texels::Linear => TextureFormat::Rgba8Unorm,
        Texels::Share => TextureFormat::R8Unorm,
    };
    image_in(format, texture.mips.concat(), texture, address_mode, coarsest_mip)
}

/// A texture as an image for a device: in blocks where it reads these (`compresses`).
pub(crate) fn device_image(
    texture: &TextureData,
    channels: Channels,
    compresses: bool,
    address_mode: ImageAddressMode,
    coarsest_mip: f32,
) -> Image {
    if compresses {
        compressed_image(texture, channels, address_mode, coarsest_mip)
    } else {
        image(texture, address_mode, coarsest_mip)
    }
}

/// What the channels of a texture hold, for its blocks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Channels {
    /// Colours or measures in red, green and blue: BC1. Alpha is lost.
    Rgb,
    /// The same, and alpha: BC3.
    Rgba,
    /// Red and green of unit normals, from which blue follows: BC5.
    Normal,
    /// Red: BC4.
    Red,
}

impl Channels {
    fn formats(self, texels: Texels) -> (TextureFormat, Format) {
        let is_colour = texels == Texels::Colour;
        match self {
            Self::Rgb if is_colour => (TextureFormat::Bc1RgbaUnormSrgb, Format::Bc1),
            Self::Rgb => (TextureFormat::Bc1RgbaUnorm, Format::Bc1),
            Self::Rgba if is_colour => (TextureFormat::Bc3RgbaUnormSrgb, Format::Bc3),
            Self::Rgba => (TextureFormat::Bc3RgbaUnorm, Format::Bc3),
            Self::Normal => (TextureFormat::Bc5RgUnorm, Format::Bc5),
            Self::Red => (TextureFormat::Bc4RUnorm, Format::Bc4),
        }
    }

    /// A texel as the compressor takes it.
    fn rgba(self, texel: &[u8]) -> [u8; 4] {
        // Blocks mix each component by itself: none may be so great that two of them leave nothing for the third.
        let component = |byte: u8| byte.clamp(128 - STEEPEST, 128 + STEEPEST);
        match (self, texel) {
            (Self::Rgba, &[r, g, b, a]) => [r, g, b, a],
            // What is not opaque would be black.
            (Self::Rgb, &[r, g, b, _]) => [r, g, b, u8::MAX],
            (Self::Normal, &[r, g, ..]) => [component(r), component(g), 0, u8::MAX],
            (_, texel) => [texel.first().copied().unwrap_or_default(), 0, 0, u8::MAX],
        }
    }
}

/// Components of normals reach 0.7 in blocks, in steps of a 128th: two of them are shorter than 1.
const STEEPEST: u8 = 89;

/// An image in blocks of 4 x 4 texels: an eighth to a half as many bytes. A texture that is no whole number of blocks wide and high stays
/// as it is.
fn compressed_image(
    texture: &TextureData,
    channels: Channels,
    address_mode: ImageAddressMode,
    coarsest_mip: f32,
) -> Image {
    if !texture.width.is_multiple_of(BLOCK) || !texture.height.is_multiple_of(BLOCK) {
        return image(texture, address_mode, coarsest_mip);
    }
    let (format, blocks) = channels.formats(texture.texels);
    let sizes = (0..).map(|mip| [texture.width, texture.height].map(|texels| (texels >> mip).max(1) as usize));
    let mips = texture.mips.iter().zip(sizes);
    let data = mips.flat_map(|(mip, size)| compressed(mip, size, texture.texels, channels, blocks));
    image_in(format, data.collect(), texture, address_mode, coarsest_mip)
}

/// Texels along a side of a block.
const BLOCK: u32 = 4;

/// A mip in blocks.
fn compressed(mip: &[u8], [width, height]: [usize; 2], texels: Texels, channels: Channels, format: Format) -> Vec<u8> {
    let bytes_a_texel = if texels == Texels::Share { 1 } else { 4 };
    let rgba: Vec<u8> = mip.chunks_exact(bytes_a_texel).flat_map(|texel| channels.rgba(texel)).collect();
    let weights = if texels == Texels::Colour { COLOUR_WEIGHTS_PERCEPTUAL } else { COLOUR_WEIGHTS_UNIFORM };
    let params = Params { algorithm: Algorithm::RangeFit, weights, ..default() };
    let mut blocks = vec![0; format.compressed_size(width, height)];
    format.compress(&rgba, width, height, params, &mut blocks);
    blocks
}

fn image_in(
    format: TextureFormat,
    data: Vec<u8>,
    texture: &TextureData,
    address_mode: ImageAddressMode,
    coarsest_mip: f32,
) -> Image {
    let size = Extent3d { width: texture.width, height: texture.height, depth_or_array_layers: 1 };
    let mut image = Image::new_uninit(size, TextureDimension::D2, format, RenderAssetUsages::RENDER_WORLD);
    image.texture_descriptor.mip_level_count = texture.mips.len() as u32;
    image.data = Some(data);
    image.sampler = ImageSampler::Descriptor(ImageSamplerDescriptor {
        address_mode_u: address_mode,
        address_mode_v: address_mode,
        mag_filter: ImageFilterMode::Linear,
        min_filter: ImageFilterMode::Linear,
        mipmap_filter: ImageFilterMode::Linear,
        lod_max_clamp: coarsest_mip,
        ..default()
    });
    image
}

/// Coarser than any mip: all are sampled.
pub(crate) const ALL_MIPS: f32 = 32.0;

#[cfg(test)]
mod tests {
    use super::*;

    /// Slow waves of nearly one hue, as the mean colours of crowns are.
    fn texture(texels: Texels, channels: usize) -> TextureData {
        let mip = |width: usize, height: usize| -> Vec<u8> {
            let texel = |index: usize| {
                let (x, y) = ((index % width) as f32 / width as f32, (index / width) as f32 / height as f32);
                (0..channels)
                    .map(move |channel| (128.0 + 100.0 * (3.0 * x + 2.0 * y + 0.2 * channel as f32).sin()) as u8)
            };
            (0..width * height).flat_map(texel).collect()
        };
        TextureData { width: 32, height: 16, mips: vec![mip(32, 16), mip(16, 8), mip(8, 4), mip(4, 2)], texels }
    }

    /// Texels, what is kept of them, their bytes, and the channels that are compared.
    const KINDS: [(Texels, Channels, usize, usize); 6] = [
        (Texels::Colour, Channels::Rgb, 4, 3),
        (Texels::Colour, Channels::Rgba, 4, 4),
        (Texels::Linear, Channels::Rgb, 4, 3),
        (Texels::Linear, Channels::Rgba, 4, 4),
        (Texels::Linear, Channels::Normal, 4, 2),
        (Texels::Share, Channels::Red, 1, 1),
    ];

    fn read_back(mip: &[u8], texels: Texels, channels: Channels) -> Vec<u8> {
        let (_, format) = channels.formats(texels);
        let blocks = compressed(mip, [32, 16], texels, channels, format);
        let mut read_back = vec![0; 4 * 32 * 16];
        format.decompress(&blocks, 32, 16, &mut read_back);
        read_back
    }

    #[test]
    fn blocks_hold_what_texels_held() {
        for (texels, channels, bytes, compared) in KINDS {
            let texture = texture(texels, bytes);
            let read_back = read_back(&texture.mips[0], texels, channels);
            let expected = |byte: u8| if channels == Channels::Normal { byte.clamp(39, 217) } else { byte };
            let pairs = texture.mips[0].chunks_exact(bytes).zip(read_back.chunks_exact(4));
            let squares = pairs
                .flat_map(|(was, is)| (0..compared).map(|it| f32::from(expected(was[it]).abs_diff(is[it])).powi(2)));
            let rms = (squares.sum::<f32>() / (compared * 32 * 16) as f32).sqrt();
            // Within a block a channel rises by 37 at most, and four colours on a line stand for that: 6 at worst, and their ends have
            // five bits, 4 at worst.
            assert!(rms < 6.0, "{texels:?} {channels:?}: {rms} of 255");
        }
    }

    #[test]
    fn normals_in_blocks_leave_something_for_their_third_component() {
        let steep = |index: usize| match index % 3 {
            0 => [255, 128, 128, 255],
            1 => [128, 0, 128, 255],
            _ => [218, 218, 128, 255],
        };
        let mip: Vec<u8> = (0..32 * 16).flat_map(steep).collect();
        for texel in read_back(&mip, Texels::Linear, Channels::Normal).chunks_exact(4) {
            let [x, y] = [texel[0], texel[1]].map(|byte| f32::from(byte) / 127.5 - 1.0);
            assert!(x * x + y * y < 1.0, "{x} {y}");
        }
    }

    /// As many bytes as the device reads: whole blocks in every mip, also where a mip is narrower than a block.
    #[test]
    fn every_mip_has_whole_blocks() {
        for (texels, channels, bytes, _) in KINDS {
            let bytes_a_block = if matches!(channels, Channels::Rgb | Channels::Red) { 8 } else { 16 };
            let image = compressed_image(&texture(texels, bytes), channels, ImageAddressMode::Repeat, ALL_MIPS);
            assert_eq!(image.data.map(|data| data.len()), Some((8 * 4 + 4 * 2 + 2 + 1) * bytes_a_block));
            assert_eq!(image.texture_descriptor.mip_level_count, 4);
        }
    }

    #[test]
    fn textures_that_are_no_whole_number_of_blocks_wide_stay_as_they_are() {
        let odd = TextureData { width: 6, height: 4, mips: vec![vec![7; 6 * 4 * 4]], texels: Texels::Colour };
        let image = compressed_image(&odd, Channels::Rgb, ImageAddressMode::Repeat, ALL_MIPS);
        assert_eq!(image.texture_descriptor.format, TextureFormat::Rgba8UnormSrgb);
    }
}
