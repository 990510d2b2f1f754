//! The material that bends blades in the vertex shader.

use super::{
    components::GrassPatch,
    mesh::{ATTRIBUTE_BLADE, ATTRIBUTE_BLADE_TURN, ATTRIBUTE_UNDER_TREES},
    settings::GrassLook,
};
use crate::{
    render::{SwayBuffers, pipeline::specialize},
    sway::FLUTTER_PERIOD_S,
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

/// A standard material on blades that bend in the wind.
pub type GrassMaterial = ExtendedMaterial<StandardMaterial, GrassExtension>;

/// The wind tables, which all materials share, and what is this meadow's own.
#[derive(Asset, AsBindGroup, Reflect, Clone, Debug)]
pub struct GrassExtension {
    /// The values of the frame.
    #[storage(103, read_only)]
    frame: Handle<ShaderBuffer>,
    /// Winds of slot A and B.
    #[storage(105, read_only)]
    wind_a: Handle<ShaderBuffer>,
    #[storage(106, read_only)]
    wind_b: Handle<ShaderBuffer>,
    #[uniform(104)]
    grass: GrassUniform,
}

/// `Grass` of the shader.
#[derive(ShaderType, Reflect, Clone, Copy, Debug, Default)]
struct GrassUniform {
    root_colour: Vec4,
    tip_colour: Vec4,
    dry_colour: Vec4,
    half_bend_speed_m_s: f32,
    flutter_rad: f32,
    flutter_cycles: f32,
    period_s: f32,
    appears_from_m: f32,
    thins_from_m: f32,
    vanishes_at_m: f32,
    swing_hz: f32,
    swing_damping_ratio: f32,
    sky_under_trees: f32,
}

impl From<&GrassPatch> for GrassUniform {
    fn from(GrassPatch { look, response, .. }: &GrassPatch) -> Self {
        let opaque = |colour: [f32; 3]| Vec3::from_array(colour).extend(1.0);
        Self {
            root_colour: opaque(look.root_colour),
            tip_colour: opaque(look.tip_colour),
            dry_colour: opaque(look.dry_colour),
            half_bend_speed_m_s: response.half_bend_speed_m_s,
            flutter_rad: response.flutter_rad,
            flutter_cycles: (response.flutter_hz * FLUTTER_PERIOD_S as f32).round(),
            period_s: FLUTTER_PERIOD_S as f32,
            appears_from_m: look.appears_from_m,
            thins_from_m: look.thins_from_m,
            vanishes_at_m: look.vanishes_at_m,
            swing_hz: response.swing_hz,
            swing_damping_ratio: response.swing_damping_ratio,
            sky_under_trees: look.sky_under_trees,
        }
    }
}

/// The material of a patch.
pub(super) fn grass_material(patch: &GrassPatch, buffers: &SwayBuffers) -> GrassMaterial {
    let [wind_a, wind_b] = buffers.winds.clone();
    let extension = GrassExtension { frame: buffers.frame.clone(), wind_a, wind_b, grass: GrassUniform::from(patch) };
    GrassMaterial { base: base_material(&patch.look), extension }
}

/// What grass is like to the light, wherever its blades are.
pub(super) fn base_material(look: &GrassLook) -> StandardMaterial {
    StandardMaterial {
        // Normals lean to the sky for soft shading: flipping them for the back of a blade would spoil that.
        double_sided: false,
        cull_mode: None,
        perceptual_roughness: 0.85,
        // More gives white rims against the light, and the look of plastic.
        reflectance: 0.12,
        diffuse_transmission: look.translucency,
        ..default()
    }
}

const GRASS_SHADER: &str = "embedded://bevy_windwood/grass/shaders/grass.wesl";
const COLOUR_SHADER: &str = "embedded://bevy_windwood/grass/shaders/grass_colour.wesl";

impl MaterialExtension for GrassExtension {
    fn vertex_shader() -> ShaderRef {
        GRASS_SHADER.into()
    }

    fn fragment_shader() -> ShaderRef {
        COLOUR_SHADER.into()
    }

    fn prepass_vertex_shader() -> ShaderRef {
        GRASS_SHADER.into()
    }

    fn deferred_vertex_shader() -> ShaderRef {
        GRASS_SHADER.into()
    }

    /// Colours come out of the vertex stage instead of the mesh.
    fn specialize(
        _: &MaterialExtensionPipeline,
        descriptor: &mut RenderPipelineDescriptor,
        layout: &MeshVertexBufferLayoutRef,
        _: MaterialExtensionKey<Self>,
    ) -> Result<(), SpecializedMeshPipelineError> {
        let attributes = [
            Mesh::ATTRIBUTE_POSITION.at_shader_location(0),
            Mesh::ATTRIBUTE_UV_0.at_shader_location(2),
            ATTRIBUTE_BLADE.at_shader_location(8),
            ATTRIBUTE_BLADE_TURN.at_shader_location(9),
            ATTRIBUTE_UNDER_TREES.at_shader_location(10),
        ];
        specialize(descriptor, layout, &attributes, &["WINDWOOD_GRASS", "VERTEX_COLORS"])
    }
}
