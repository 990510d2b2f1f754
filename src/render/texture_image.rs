//! Textures with their mips as Bevy images.

use crate::texture::{Texels, TextureData};
use bevy::{
    asset::RenderAssetUsages,
    image::{Image, ImageAddressMode, ImageFilterMode, ImageSampler, ImageSamplerDescriptor},
    render::render_resource::{Extent3d, TextureDimension, TextureFormat},
    utils::default,
};
use texpresso::{Algorithm, COLOUR_WEIGHTS_PERCEPTUAL, COLOUR_WEIGHTS_UNIFORM, Format, Params};

/// A texture as an image with its mips. `coarsest_mip` is the last one that is sampled.
pub(crate) fn image(texture: &TextureData, address_mode: ImageAddressMode, coarsest_mip: f32) -> Image {
    let format = match texture.texels {
        Texels::Colour => TextureFormat::Rgba8UnormSrgb,
        Texels::Linear => TextureFormat::Rgba8Unorm,
        Texels::Share => TextureFormat::R8Unorm,
    };
    image_in(format, texture.mips.concat(), texture, address_mode, coarsest_mip)
}

/// The same in blocks of 4 x 4 texels (BC1 for colours, whose alpha is lost, BC3 and BC4): an eighth to a half as many bytes.
pub(crate) fn compressed_image(texture: &TextureData, address_mode: ImageAddressMode, coarsest_mip: f32) -> Image {
    let (format, blocks) = match texture.texels {
        Texels::Colour => (TextureFormat::Bc1RgbaUnormSrgb, Format::Bc1),
        Texels::Linear => (TextureFormat::Bc3RgbaUnorm, Format::Bc3),
        Texels::Share => (TextureFormat::Bc4RUnorm, Format::Bc4),
    };
    let sizes = (0..).map(|mip| [texture.width, texture.height].map(|texels| (texels >> mip).max(1) as usize));
    let data = texture.mips.iter().zip(sizes).flat_map(|(mip, size)| compressed(mip, size, texture.texels, blocks));
    image_in(format, data.collect(), texture, address_mode, coarsest_mip)
}

/// A mip in blocks.
fn compressed(mip: &[u8], [width, height]: [usize; 2], texels: Texels, format: Format) -> Vec<u8> {
    let rgba: Vec<u8> = match texels {
        // What is not opaque would be black.
        Texels::Colour => mip.chunks_exact(4).flat_map(|texel| [texel[0], texel[1], texel[2], u8::MAX]).collect(),
        Texels::Linear => mip.to_vec(),
        Texels::Share => mip.iter().flat_map(|share| [*share, 0, 0, u8::MAX]).collect(),
    };
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

    #[test]
    fn blocks_hold_what_texels_held() {
        for (texels, channels, format, compared) in [
            (Texels::Colour, 4, Format::Bc1, 3),
            (Texels::Linear, 4, Format::Bc3, 4),
            (Texels::Share, 1, Format::Bc4, 1),
        ] {
            let texture = texture(texels, channels);
            let blocks = compressed(&texture.mips[0], [32, 16], texels, format);
            let mut read_back = vec![0; 4 * 32 * 16];
            format.decompress(&blocks, 32, 16, &mut read_back);
            let pairs = texture.mips[0].chunks_exact(channels).zip(read_back.chunks_exact(4));
            let squares =
                pairs.flat_map(|(was, is)| (0..compared).map(|it| f32::from(was[it].abs_diff(is[it])).powi(2)));
            let rms = (squares.sum::<f32>() / (compared * 32 * 16) as f32).sqrt();
            // Within a block a channel rises by 37 at most, and four colours on a line stand for that: 6 at worst, and their ends have
            // five bits, 4 at worst.
            assert!(rms < 6.0, "{texels:?}: {rms} of 255");
        }
    }

    /// As many bytes as the device reads: whole blocks in every mip, also where a mip is narrower than a block.
    #[test]
    fn every_mip_has_whole_blocks() {
        for (texels, channels, bytes_a_block) in
            [(Texels::Colour, 4, 8), (Texels::Linear, 4, 16), (Texels::Share, 1, 8)]
        {
            let image = compressed_image(&texture(texels, channels), ImageAddressMode::Repeat, ALL_MIPS);
            assert_eq!(image.data.map(|data| data.len()), Some((8 * 4 + 4 * 2 + 2 + 1) * bytes_a_block));
            assert_eq!(image.texture_descriptor.mip_level_count, 4);
        }
    }
}
