//! The material of the ground.

use super::{components::GroundLook, ground_texture::ground_texture, litter_texture::litter_texture};
use crate::{
    render::{
        pipeline::specialize,
        texture_image::{ALL_MIPS, image},
    },
    texture::TextureData,
};
use bevy::{
    asset::InvalidGenerationError,
    image::ImageAddressMode,
    material::OpaqueRendererMethod,
    mesh::{MeshVertexAttribute, MeshVertexBufferLayoutRef, VertexFormat},
    pbr::{ExtendedMaterial, MaterialExtension, MaterialExtensionKey, MaterialExtensionPipeline},
    prelude::*,
    render::render_resource::{AsBindGroup, RenderPipelineDescriptor, ShaderType, SpecializedMeshPipelineError},
    shader::ShaderRef,
};

/// Gap code and share under trees: `marks` of [`ChunkVertices`](super::chunk::ChunkVertices).
pub(super) const ATTRIBUTE_MARKS: MeshVertexAttribute =
    MeshVertexAttribute::new("GroundMarks", 0x4752_4e44, VertexFormat::Float32x2);

/// A standard material in the colours of the ground.
pub type GroundMaterial = ExtendedMaterial<StandardMaterial, GroundExtension>;

/// What [`GroundMaterial`] adds to the standard material.
#[derive(Asset, AsBindGroup, Reflect, Clone, Debug)]
pub struct GroundExtension {
    #[uniform(100)]
    look: LookUniform,
    #[texture(101)]
    #[sampler(102)]
    detail: Handle<Image>,
    #[texture(103)]
    litter: Handle<Image>,
}

/// The textures of all ground.
#[derive(Resource, Clone)]
pub(super) struct GroundTextures {
    detail: Handle<Image>,
    litter: Handle<Image>,
}

impl FromWorld for GroundTextures {
    fn from_world(world: &mut World) -> Self {
        let mut images = world.resource_mut::<Assets<Image>>();
        let mut add = |texture: TextureData| images.add(tiled_image(&texture));
        Self { detail: add(ground_texture()), litter: add(litter_texture()) }
    }
}

impl GroundTextures {
    /// Puts them on the graphics device again.
    pub fn restore(&self, images: &mut Assets<Image>) -> Result<(), InvalidGenerationError> {
        images.insert(&self.detail, tiled_image(&ground_texture()))?;
        images.insert(&self.litter, tiled_image(&litter_texture()))
    }
}

fn tiled_image(texture: &TextureData) -> Image {
    image(texture, ImageAddressMode::Repeat, ALL_MIPS)
}

/// `Look` of the shader.
#[derive(ShaderType, Reflect, Clone, Copy, Debug, Default)]
struct LookUniform {
    grass: Vec4,
    dry_grass: Vec4,
    earth: Vec4,
    rock: Vec4,
    snow: Vec4,
    litter: Vec4,
    pale_litter: Vec4,
    canopy: Vec4,
    /// 1 - cosine of the slopes.
    bare_from: f32,
    bare_to: f32,
    grass_line_m: f32,
    snow_line_m: f32,
    line_blur_m: f32,
    per_texture_m: f32,
    canopy_from_m: f32,
    sky_under_trees: f32,
}

impl From<&GroundLook> for LookUniform {
    fn from(look: &GroundLook) -> Self {
        let light = |[r, g, b]: [f32; 3]| Color::srgb(r, g, b).to_linear().to_vec4();
        let steepness = |degrees: f32| 1.0 - degrees.to_radians().cos();
        Self {
            grass: light(look.grass),
            dry_grass: light(look.dry_grass),
            earth: light(look.earth),
            rock: light(look.rock),
            snow: light(look.snow),
            litter: light(look.litter),
            pale_litter: light(look.pale_litter),
            canopy: light(look.canopy),
            bare_from: steepness(look.bare_slope_deg[0]),
            bare_to: steepness(look.bare_slope_deg[1]),
            grass_line_m: look.grass_line_m,
            snow_line_m: look.snow_line_m,
            line_blur_m: look.line_blur_m,
            per_texture_m: 1.0 / look.texture_m,
            canopy_from_m: look.canopy_from_m,
            sky_under_trees: look.sky_under_trees,
        }
    }
}

/// The material of ground with that look.
pub(super) fn ground_material(look: &GroundLook, textures: GroundTextures) -> GroundMaterial {
    GroundMaterial {
        base: StandardMaterial {
            perceptual_roughness: 1.0,
            reflectance: 0.1,
            // Gaps are seen from the side that is open, whichever that is.
            cull_mode: None,
            // The colours are made in the forward pass.
            opaque_render_method: OpaqueRendererMethod::Forward,
            ..default()
        },
        extension: GroundExtension { look: look.into(), detail: textures.detail, litter: textures.litter },
    }
}

const SHADER: &str = "embedded://bevy_windwood/terrain/shaders/ground.wesl";
const COLOUR_SHADER: &str = "embedded://bevy_windwood/terrain/shaders/ground_colour.wesl";

impl MaterialExtension for GroundExtension {
    fn vertex_shader() -> ShaderRef {
        SHADER.into()
    }

    fn prepass_vertex_shader() -> ShaderRef {
        SHADER.into()
    }

    fn fragment_shader() -> ShaderRef {
        COLOUR_SHADER.into()
    }

    fn specialize(
        _: &MaterialExtensionPipeline,
        descriptor: &mut RenderPipelineDescriptor,
        layout: &MeshVertexBufferLayoutRef,
        _: MaterialExtensionKey<Self>,
    ) -> Result<(), SpecializedMeshPipelineError> {
        let attributes = [
            Mesh::ATTRIBUTE_POSITION.at_shader_location(0),
            Mesh::ATTRIBUTE_NORMAL.at_shader_location(1),
            ATTRIBUTE_MARKS.at_shader_location(8),
        ];
        // The colour of a vertex carries the woods to its fragments.
        specialize(descriptor, layout, &attributes, &["VERTEX_COLORS"])
    }
}
