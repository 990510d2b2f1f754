//! What all our materials need: textures with their mips as images, and names for both stages of a shader.

use crate::texture::{Texels, TextureData};
use bevy::{
    asset::RenderAssetUsages,
    image::{Image, ImageAddressMode, ImageFilterMode, ImageSampler, ImageSamplerDescriptor},
    mesh::{MeshVertexBufferLayoutRef, VertexAttributeDescriptor},
    render::render_resource::{
        Extent3d, RenderPipelineDescriptor, SpecializedMeshPipelineError, TextureDimension, TextureFormat,
    },
    shader::ShaderDefVal,
    utils::default,
};

/// A texture as an image, with the mips that it brings. `coarsest_mip` is the last that is used.
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

/// A mip that no texture has: all are used.
pub(crate) const ALL_MIPS: f32 = 32.0;

/// Gives a pipeline vertices of these attributes, and defines names for its stages: one layout for the main pass, the prepass
/// and the shadow pass, whose own vertex locations differ.
pub(crate) fn lay_out(
    descriptor: &mut RenderPipelineDescriptor,
    layout: &MeshVertexBufferLayoutRef,
    attributes: &[VertexAttributeDescriptor],
    names: &[&'static str],
) -> Result<(), SpecializedMeshPipelineError> {
    descriptor.vertex.buffers = vec![layout.0.get_layout(attributes)?];
    define(descriptor, names);
    Ok(())
}

/// Passes constants to the vertex stage and, where there is one, the fragment stage: `constants::NAME` of the shaders.
pub(crate) fn pass_constants(descriptor: &mut RenderPipelineDescriptor, constants: &[(&'static str, u32)]) {
    for &(name, value) in constants {
        let define = ShaderDefVal::UInt(name.into(), value);
        descriptor.vertex.shader_defs.push(define.clone());
        if let Some(fragment) = &mut descriptor.fragment {
            fragment.shader_defs.push(define);
        }
    }
}

/// Defines names for the vertex stage and, where there is one, the fragment stage.
pub(crate) fn define(descriptor: &mut RenderPipelineDescriptor, names: &[&'static str]) {
    for &name in names {
        descriptor.vertex.shader_defs.push(name.into());
        if let Some(fragment) = &mut descriptor.fragment {
            fragment.shader_defs.push(name.into());
        }
    }
}
