//! Textures with their mips as Bevy images.

use crate::texture::{Texels, TextureData};
use bevy::{
    asset::RenderAssetUsages,
    image::{Image, ImageAddressMode, ImageFilterMode, ImageSampler, ImageSamplerDescriptor},
    render::render_resource::{Extent3d, TextureDimension, TextureFormat},
    utils::default,
};

/// A texture as an image with its mips. `coarsest_mip` is the last one that is sampled.
pub(crate) fn image(texture: &TextureData, address_mode: ImageAddressMode, coarsest_mip: f32) -> Image {
    let format = match texture.texels {
        Texels::Colour => TextureFormat::Rgba8UnormSrgb,
        Texels::Linear => TextureFormat::Rgba8Unorm,
        Texels::Share => TextureFormat::R8Unorm,
    };
    let size = Extent3d { width: texture.width, height: texture.height, depth_or_array_layers: 1 };
    let mut image = Image::new_uninit(size, TextureDimension::D2, format, RenderAssetUsages::RENDER_WORLD);
    image.texture_descriptor.mip_level_count = texture.mips.len() as u32;
    image.data = Some(texture.mips.concat());
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
