//! The material that poses trees in the vertex shader.

use super::packed_vertices::{ATTRIBUTE_LEAF_AXIS, ATTRIBUTE_LEAF_REACH, ATTRIBUTE_SWAY, PACKED_LAYOUT};
use crate::{
    dynamics::leaf::LeafResponse,
    render::{
        instances::tag::TAG_LAYOUT,
        lighting::{LitAsTrees, TreeLights},
        pipeline::{set_constants, shade_what_is_seen, specialize, tell_of_sun_shadow},
    },
    sway::FLUTTER_PERIOD_S,
    tree::{phenology::Phenology, species::Wood},
};
use bevy::{
    mesh::MeshVertexBufferLayoutRef,
    pbr::{ExtendedMaterial, MaterialExtension, MaterialExtensionKey, MaterialExtensionPipeline},
    prelude::*,
    render::{
        render_resource::{AsBindGroup, RenderPipelineDescriptor, ShaderType, SpecializedMeshPipelineError},
        storage::ShaderBuffer,
    },
    shader::ShaderRef,
};

/// A standard material whose vertices sway.
pub type SwayMaterial = ExtendedMaterial<StandardMaterial, SwayExtension>;

/// The tables that the vertex shader reads. They are shared and written in place, so that the material itself never changes: a changed
/// material would re-extract every tree that has it.
#[derive(Asset, AsBindGroup, Reflect, Clone, Debug)]
#[bind_group_data(TreeLights)]
pub struct SwayExtension {
    /// The poses of all beams of all trees.
    #[storage(100, read_only)]
    pub poses: Handle<ShaderBuffer>,
    /// The beams of every model.
    #[storage(101, read_only)]
    pub beams: Handle<ShaderBuffer>,
    /// The trees.
    #[storage(102, read_only)]
    pub trees: Handle<ShaderBuffer>,
    /// The values of the frame.
    #[storage(103, read_only)]
    pub frame: Handle<ShaderBuffer>,
    /// How the leaves turn.
    #[uniform(104)]
    pub leaf: LeafUniform,
    /// What they do over the year.
    #[uniform(107)]
    pub season: SeasonUniform,
    /// How green the smallest branches are.
    #[uniform(108)]
    pub green_wood: GreenWoodUniform,
    /// What its shaders are compiled for.
    pub lights: TreeLights,
}

impl From<&SwayExtension> for TreeLights {
    fn from(extension: &SwayExtension) -> Self {
        extension.lights
    }
}

/// `LeafResponse` of the shader.
#[derive(ShaderType, Reflect, Clone, Copy, Debug, Default)]
pub struct LeafUniform {
    turn: f32,
    onset_speed_m_s: f32,
    full_speed_m_s: f32,
    flutter_angle_rad: f32,
    flutter_frequency_hz: f32,
    period_s: f32,
    /// 1 where the foliage is ellipsoids.
    is_ellipsoid: f32,
    /// 1 for sprays without leaves.
    is_bare: f32,
}

impl LeafUniform {
    /// How leaves turn, and whether they are ellipsoids, which grow transparent towards their outline.
    pub fn new(leaf: &LeafResponse, is_ellipsoid: bool) -> Self {
        Self {
            turn: leaf.turn,
            onset_speed_m_s: leaf.onset_speed_m_s,
            full_speed_m_s: leaf.full_speed_m_s,
            flutter_angle_rad: leaf.flutter_angle_rad,
            flutter_frequency_hz: leaf.flutter_frequency_hz,
            period_s: FLUTTER_PERIOD_S as f32,
            is_ellipsoid: f32::from(u8::from(is_ellipsoid)),
            is_bare: 0.0,
        }
    }

    /// The same for sprays whose leaves have fallen: all that is on their texture is drawn.
    pub fn bare(self) -> Self {
        Self { is_bare: 1.0, ..self }
    }
}

/// `GreenWood` of the shader.
#[derive(ShaderType, Reflect, Clone, Copy, Debug, Default)]
pub struct GreenWoodUniform {
    tint: Vec4,
}

impl GreenWoodUniform {
    /// The green branches of a wood.
    pub fn new(wood: &Wood) -> Self {
        Self { tint: Vec3::from_array(wood.green.tint(wood.bark.colour)).extend(1.0) }
    }
}

/// `Phenology` of the shader.
#[derive(ShaderType, Reflect, Clone, Copy, Debug, Default)]
pub struct SeasonUniform {
    flush: f32,
    flush_length: f32,
    turn: f32,
    turn_length: f32,
    fall: f32,
    fall_length: f32,
    patchiness: f32,
    evergreen: f32,
    spring: Vec4,
    autumn_first: Vec4,
    autumn_last: Vec4,
}

impl SeasonUniform {
    /// The year of a species whose leaves are of that colour (sRGB) in summer.
    pub fn new(phenology: &Phenology, summer: [f32; 3]) -> Self {
        let light = |[r, g, b]: [f32; 3]| Color::srgb(r, g, b).to_linear().to_vec4();
        let luminance = light(summer).truncate().dot(Vec3::new(0.2126, 0.7152, 0.0722));
        let [first, last] = phenology.autumn_colours;
        Self {
            flush: phenology.flush,
            flush_length: phenology.flush_length,
            turn: phenology.turn,
            turn_length: phenology.turn_length,
            fall: phenology.fall,
            fall_length: phenology.fall_length,
            patchiness: phenology.patchiness,
            evergreen: f32::from(u8::from(phenology.evergreen)),
            spring: light(phenology.spring_colour).truncate().extend(luminance),
            autumn_first: light(first),
            autumn_last: light(last),
        }
    }
}

const FRAGMENT_SHADER: &str = "embedded://bevy_windwood/render/shaders/tree_fragment.wesl";
const PREPASS_SHADER: &str = "embedded://bevy_windwood/render/shaders/tree_prepass.wesl";
const VERTEX_SHADER: &str = "embedded://bevy_windwood/render/shaders/tree_vertex.wesl";

impl MaterialExtension for SwayExtension {
    fn fragment_shader() -> ShaderRef {
        FRAGMENT_SHADER.into()
    }

    fn vertex_shader() -> ShaderRef {
        VERTEX_SHADER.into()
    }

    fn prepass_fragment_shader() -> ShaderRef {
        PREPASS_SHADER.into()
    }

    fn prepass_vertex_shader() -> ShaderRef {
        VERTEX_SHADER.into()
    }

    fn deferred_vertex_shader() -> ShaderRef {
        VERTEX_SHADER.into()
    }

    /// Colour and tangent come out of the vertex stage instead of the mesh.
    fn specialize(
        _: &MaterialExtensionPipeline,
        descriptor: &mut RenderPipelineDescriptor,
        layout: &MeshVertexBufferLayoutRef,
        key: MaterialExtensionKey<Self>,
    ) -> Result<(), SpecializedMeshPipelineError> {
        let has_leaves = layout.0.contains(ATTRIBUTE_LEAF_AXIS);
        let is_envelope = layout.0.contains(Mesh::ATTRIBUTE_UV_1);
        let mut attributes = vec![
            Mesh::ATTRIBUTE_POSITION.at_shader_location(0),
            Mesh::ATTRIBUTE_NORMAL.at_shader_location(1),
            Mesh::ATTRIBUTE_UV_0.at_shader_location(2),
            ATTRIBUTE_SWAY.at_shader_location(8),
        ];
        // The cross-fade of levels takes the place, among the outputs of the vertex stage, of that of Bevy's own ranges.
        let mut flags = vec!["VERTEX_COLORS", "VERTEX_TANGENTS", "VISIBILITY_RANGE_DITHER"];
        if has_leaves {
            attributes.push(ATTRIBUTE_LEAF_AXIS.at_shader_location(9));
            attributes.push(ATTRIBUTE_LEAF_REACH.at_shader_location(10));
            flags.push("WINDWOOD_LEAVES");
        }
        if is_envelope {
            attributes.push(Mesh::ATTRIBUTE_UV_1.at_shader_location(3));
            flags.push("WINDWOOD_ENVELOPE");
        }
        if has_leaves || is_envelope {
            // The second coordinates carry the season of a leaf to its fragments.
            flags.push("VERTEX_UVS_B");
        }
        flags.extend(key.bind_group_data.flags());
        set_constants(descriptor, &TAG_LAYOUT);
        set_constants(descriptor, &PACKED_LAYOUT);
        shade_what_is_seen(descriptor, key.mesh_key);
        tell_of_sun_shadow(descriptor, key.mesh_key);
        specialize(descriptor, layout, &attributes, &flags)
    }
}

impl LitAsTrees for SwayExtension {
    fn lights_mut(&mut self) -> &mut TreeLights {
        &mut self.lights
    }
}
