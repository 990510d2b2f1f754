//! The material of impostors.

use super::{
    mesh::{ATTRIBUTE_IMPOSTOR, MAX_SIZE, MAX_VARIANTS},
    near_mask::{CANOPY_BLOCKS, HEADER},
};
use crate::{
    lod::{ImpostorAtlas, ImpostorFrame, ImpostorSway},
    render::{
        buffers::sway_buffers::SwayBuffers,
        instances::rows::sway_vectors,
        lighting::{LitAsTrees, TreeLights},
        pipeline::{set_constants, shade_what_is_seen, specialize, tell_of_sun_shadow},
        species::tree_material::SeasonUniform,
        texture_image::{ALL_MIPS, Channels, device_image},
    },
    texture::TextureData,
    tree::Species,
};
use bevy::{
    image::ImageAddressMode,
    material::OpaqueRendererMethod,
    mesh::MeshVertexBufferLayoutRef,
    pbr::{ExtendedMaterial, MaterialExtension, MaterialExtensionKey, MaterialExtensionPipeline},
    prelude::*,
    render::{
        render_resource::{AsBindGroup, RenderPipelineDescriptor, ShaderType, SpecializedMeshPipelineError},
        storage::ShaderBuffer,
    },
    shader::ShaderRef,
};

/// A standard material on impostors that show the views of an atlas.
pub type ImpostorMaterial = ExtendedMaterial<StandardMaterial, ImpostorExtension>;

/// The atlas of a species, and the tables that all impostors share.
#[derive(Asset, AsBindGroup, Reflect, Clone, Debug)]
#[bind_group_data(TreeLights)]
pub struct ImpostorExtension {
    #[texture(100)]
    #[sampler(102)]
    colour: Handle<Image>,
    #[texture(101)]
    surface: Handle<Image>,
    #[texture(109)]
    outline: Handle<Image>,
    /// The values of the frame.
    #[storage(103, read_only)]
    frame: Handle<ShaderBuffer>,
    #[uniform(104)]
    atlas: AtlasUniform,
    #[uniform(107)]
    season: SeasonUniform,
    /// Winds of slot A and B.
    #[storage(105, read_only)]
    wind_a: Handle<ShaderBuffer>,
    #[storage(106, read_only)]
    wind_b: Handle<ShaderBuffer>,
    /// Cells whose trees are entities.
    #[storage(108, read_only)]
    near_masks: Handle<ShaderBuffer>,
    lights: TreeLights,
}

impl From<&ImpostorExtension> for TreeLights {
    fn from(extension: &ImpostorExtension) -> Self {
        extension.lights
    }
}

/// `ImpostorAtlas` of the shader.
#[derive(ShaderType, Reflect, Clone, Copy, Debug, Default)]
struct AtlasUniform {
    centre: Vec3,
    radius_m: f32,
    half_height_m: f32,
    across: f32,
    translucency: f32,
    blocks: f32,
    first_bare: f32,
    outline_texels: Vec2,
    /// How each variant's stem sways.
    stems: [StemUniform; MAX_VARIANTS as usize],
}

/// `Stem` of the shader: an [`ImpostorSway`].
#[derive(ShaderType, Reflect, Clone, Copy, Debug, Default)]
struct StemUniform {
    in_leaf: Vec4,
    bare: Vec4,
    loads: UVec4,
    leaf_season: UVec4,
}

impl From<&ImpostorSway> for StemUniform {
    fn from(sway: &ImpostorSway) -> Self {
        let (sways, loads) = sway_vectors(&sway.in_leaf, &sway.bare);
        let ([in_leaf, bare], loads) = (sways.map(Vec4::from_array), UVec4::from_array(loads));
        Self { in_leaf, bare, loads, leaf_season: UVec4::new(sway.leaf_season.bits(), 0, 0, 0) }
    }
}

/// An atlas as Bevy images: megabytes, laid out in the background.
pub(crate) struct AtlasImages {
    colour: Image,
    surface: Image,
    outline: Image,
    pub frame: ImpostorFrame,
    pub variants: u32,
    has_bare: bool,
    blocks: u32,
    across: u32,
    /// Width and height of a view's outline, texels.
    outline_texels: Vec2,
    /// How each variant sways.
    sways: Vec<ImpostorSway>,
    /// The colour of the leaves.
    summer: [f32; 3],
}

impl AtlasImages {
    pub fn new(atlas: &ImpostorAtlas, sways: Vec<ImpostorSway>, summer: [f32; 3], compresses_textures: bool) -> Self {
        let image = |texture: &TextureData, channels| {
            device_image(texture, channels, compresses_textures, ImageAddressMode::ClampToEdge, ALL_MIPS)
        };
        let colour = image(&atlas.colour, Channels::Rgb);
        let surface = image(&atlas.surface, Channels::Rgba);
        let outline = image(&atlas.coverage, Channels::Red);
        Self {
            colour,
            surface,
            outline,
            frame: atlas.frame,
            variants: atlas.trees,
            has_bare: atlas.has_bare,
            blocks: atlas.view_grids(),
            across: atlas.views_per_side,
            outline_texels: (atlas.tile_texels * atlas.coverage.width / atlas.colour.width).as_vec2(),
            sways,
            summer,
        }
    }
}

/// The material of a species' impostors.
pub(crate) fn impostor_material(
    species: &Species,
    atlas: AtlasImages,
    images: &mut Assets<Image>,
    buffers: &SwayBuffers,
    near_masks: Handle<ShaderBuffer>,
) -> ImpostorMaterial {
    let [wind_a, wind_b] = &buffers.winds;
    ImpostorMaterial {
        base: StandardMaterial {
            alpha_mode: AlphaMode::Mask(0.5),
            cull_mode: None,
            perceptual_roughness: 0.85,
            reflectance: 0.08,
            diffuse_transmission: species.foliage.translucency,
            opaque_render_method: OpaqueRendererMethod::Forward,
            ..default()
        },
        extension: ImpostorExtension {
            colour: images.add(atlas.colour),
            surface: images.add(atlas.surface),
            outline: images.add(atlas.outline),
            frame: buffers.frame.clone(),
            atlas: AtlasUniform {
                centre: atlas.frame.centre,
                radius_m: atlas.frame.radius_m,
                half_height_m: atlas.frame.half_height_m,
                across: atlas.across as f32,
                translucency: species.foliage.translucency,
                blocks: atlas.blocks as f32,
                first_bare: if atlas.has_bare { atlas.variants as f32 } else { 0.0 },
                outline_texels: atlas.outline_texels,
                stems: std::array::from_fn(|tree| atlas.sways.get(tree).map(StemUniform::from).unwrap_or_default()),
            },
            season: SeasonUniform::new(&species.phenology, atlas.summer),
            wind_a: wind_a.clone(),
            wind_b: wind_b.clone(),
            near_masks,
            lights: TreeLights::default(),
        },
    }
}

impl LitAsTrees for ImpostorExtension {
    fn lights_mut(&mut self) -> &mut TreeLights {
        &mut self.lights
    }
}

const VERTEX_SHADER: &str = "embedded://bevy_windwood/render/shaders/impostor_vertex.wesl";
const FRAGMENT_SHADER: &str = "embedded://bevy_windwood/render/shaders/impostor_fragment.wesl";
const PREPASS_SHADER: &str = "embedded://bevy_windwood/render/shaders/impostor_prepass.wesl";

impl MaterialExtension for ImpostorExtension {
    fn vertex_shader() -> ShaderRef {
        VERTEX_SHADER.into()
    }

    fn prepass_vertex_shader() -> ShaderRef {
        VERTEX_SHADER.into()
    }

    fn fragment_shader() -> ShaderRef {
        FRAGMENT_SHADER.into()
    }

    fn prepass_fragment_shader() -> ShaderRef {
        PREPASS_SHADER.into()
    }

    fn specialize(
        _: &MaterialExtensionPipeline,
        descriptor: &mut RenderPipelineDescriptor,
        layout: &MeshVertexBufferLayoutRef,
        key: MaterialExtensionKey<Self>,
    ) -> Result<(), SpecializedMeshPipelineError> {
        let attributes = [Mesh::ATTRIBUTE_POSITION.at_shader_location(0), ATTRIBUTE_IMPOSTOR.at_shader_location(8)];
        let constants = [
            ("MAX_IMPOSTOR_VARIANTS", MAX_VARIANTS),
            ("MAX_IMPOSTOR_SIZE", MAX_SIZE),
            ("NEAR_MASK_HEADER", HEADER),
            ("CANOPY_BLOCKS", CANOPY_BLOCKS),
        ];
        set_constants(descriptor, &constants);
        shade_what_is_seen(descriptor, key.mesh_key);
        tell_of_sun_shadow(descriptor, key.mesh_key);
        specialize(descriptor, layout, &attributes, key.bind_group_data.flags())
    }
}
