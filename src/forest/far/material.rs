//! The material of far trees.

use super::{
    mesh::{ATTRIBUTE_FAR, GREATEST_SIZE, MOST_TREES},
    near::SIDE,
};
use crate::{
    lod::{Lean, ViewAtlas, ViewFrame},
    shading::{ALL_MIPS, define, image, lay_out, pass_constants},
    sway::{LitAsTrees, SeasonUniform, StandTables, TreeLights},
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

/// A standard material on cards that wear the views of a tree.
pub type FarMaterial = ExtendedMaterial<StandardMaterial, FarExtension>;

/// The views of a species, and what all far trees share.
#[derive(Asset, AsBindGroup, Reflect, Clone, Debug)]
#[bind_group_data(TreeLights)]
pub struct FarExtension {
    #[texture(100)]
    #[sampler(102)]
    colour: Handle<Image>,
    #[texture(101)]
    surface: Handle<Image>,
    #[texture(109)]
    outline: Handle<Image>,
    /// The clock of the frame.
    #[storage(103, read_only)]
    frame: Handle<ShaderBuffer>,
    #[uniform(104)]
    views: ViewsUniform,
    #[uniform(107)]
    season: SeasonUniform,
    /// Winds of slot A and B.
    #[storage(105, read_only)]
    wind_a: Handle<ShaderBuffer>,
    #[storage(106, read_only)]
    wind_b: Handle<ShaderBuffer>,
    /// Cells whose trees stand near.
    #[storage(108, read_only)]
    near: Handle<ShaderBuffer>,
    lights: TreeLights,
}

impl From<&FarExtension> for TreeLights {
    fn from(extension: &FarExtension) -> Self {
        extension.lights
    }
}

/// `Views` of the shader.
#[derive(ShaderType, Reflect, Clone, Copy, Debug, Default)]
struct ViewsUniform {
    centre: Vec3,
    radius_m: f32,
    half_height_m: f32,
    across: f32,
    translucency: f32,
    blocks: f32,
    first_bare: f32,
    outline_texels: Vec2,
    /// Gain and class of each tree's [`Lean`].
    leans: [Vec4; MOST_TREES as usize],
}

/// The views of some trees as the renderer takes them: megabytes, laid out in the background.
pub(super) struct FarViews {
    colour: Image,
    surface: Image,
    outline: Image,
    pub frame: ViewFrame,
    pub trees: u32,
    has_bare: bool,
    blocks: u32,
    across: u32,
    /// Width and height of a view's outline, texels.
    outline_texels: Vec2,
    /// How each tree leans.
    leans: Vec<Lean>,
    /// The colour of the leaves.
    summer: [f32; 3],
}

impl FarViews {
    pub fn new(atlas: &ViewAtlas, leans: Vec<Lean>, summer: [f32; 3]) -> Self {
        let [colour, surface, outline] = [&atlas.colour, &atlas.surface, &atlas.outline]
            .map(|texture| image(texture, ImageAddressMode::ClampToEdge, ALL_MIPS));
        Self {
            colour,
            surface,
            outline,
            frame: atlas.frame,
            trees: atlas.trees,
            has_bare: atlas.has_bare,
            blocks: atlas.blocks(),
            across: atlas.across,
            outline_texels: (atlas.view_texels * atlas.outline.width / atlas.colour.width).as_vec2(),
            leans,
            summer,
        }
    }
}

/// The material of a species' far trees.
pub(super) fn far_material(
    species: &Species,
    views: FarViews,
    images: &mut Assets<Image>,
    tables: &StandTables,
    near: Handle<ShaderBuffer>,
) -> FarMaterial {
    let [wind_a, wind_b] = &tables.winds;
    FarMaterial {
        base: StandardMaterial {
            alpha_mode: AlphaMode::Mask(0.5),
            cull_mode: None,
            perceptual_roughness: 0.85,
            reflectance: 0.08,
            diffuse_transmission: species.foliage.translucency,
            opaque_render_method: OpaqueRendererMethod::Forward,
            ..default()
        },
        extension: FarExtension {
            colour: images.add(views.colour),
            surface: images.add(views.surface),
            outline: images.add(views.outline),
            frame: tables.frame.clone(),
            views: ViewsUniform {
                centre: views.frame.centre,
                radius_m: views.frame.radius_m,
                half_height_m: views.frame.half_height_m,
                across: views.across as f32,
                translucency: species.foliage.translucency,
                blocks: views.blocks as f32,
                first_bare: if views.has_bare { views.trees as f32 } else { 0.0 },
                outline_texels: views.outline_texels,
                leans: std::array::from_fn(|tree| {
                    let Lean { gain, class } = views.leans.get(tree).copied().unwrap_or_default();
                    Vec4::new(gain, class, 0.0, 0.0)
                }),
            },
            season: SeasonUniform::new(&species.phenology, views.summer),
            wind_a: wind_a.clone(),
            wind_b: wind_b.clone(),
            near,
            lights: TreeLights::default(),
        },
    }
}

impl LitAsTrees for FarExtension {
    fn lights_mut(&mut self) -> &mut TreeLights {
        &mut self.lights
    }
}

const CARD_SHADER: &str = "embedded://bevy_windwood/render/shaders/impostor_vertex.wesl";
const COLOUR_SHADER: &str = "embedded://bevy_windwood/render/shaders/impostor_fragment.wesl";
const MASK_SHADER: &str = "embedded://bevy_windwood/render/shaders/impostor_prepass.wesl";

impl MaterialExtension for FarExtension {
    fn vertex_shader() -> ShaderRef {
        CARD_SHADER.into()
    }

    fn prepass_vertex_shader() -> ShaderRef {
        CARD_SHADER.into()
    }

    fn fragment_shader() -> ShaderRef {
        COLOUR_SHADER.into()
    }

    fn prepass_fragment_shader() -> ShaderRef {
        MASK_SHADER.into()
    }

    fn specialize(
        _: &MaterialExtensionPipeline,
        descriptor: &mut RenderPipelineDescriptor,
        layout: &MeshVertexBufferLayoutRef,
        key: MaterialExtensionKey<Self>,
    ) -> Result<(), SpecializedMeshPipelineError> {
        let attributes = [Mesh::ATTRIBUTE_POSITION.at_shader_location(0), ATTRIBUTE_FAR.at_shader_location(8)];
        // Coordinates and colour carry the place on the tree and the direction to the eye to the fragments.
        let names = ["VERTEX_UVS_A", "VERTEX_UVS_B", "VERTEX_COLORS", "VISIBILITY_RANGE_DITHER"];
        define(descriptor, key.bind_group_data.names());
        let sizes = [
            ("MAX_IMPOSTOR_VARIANTS", MOST_TREES),
            ("MAX_IMPOSTOR_SIZE", GREATEST_SIZE as u32),
            ("NEAR_MASK_SIDE", SIDE.cast_unsigned()),
        ];
        pass_constants(descriptor, &sizes);
        lay_out(descriptor, layout, &attributes, &names)
    }
}
