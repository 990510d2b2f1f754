//! The materials of a fire: emissive, additive, without light from elsewhere.

use super::{
    components::Flames,
    mesh::{ATTRIBUTE_FLAME, ATTRIBUTE_FLAME_OWN},
};
use crate::{
    render::{SwayBuffers, pipeline::specialize},
    sway::FLUTTER_PERIOD_S,
};
use bevy::{
    mesh::MeshVertexBufferLayoutRef,
    pbr::{Material, MaterialPipeline, MaterialPipelineKey},
    prelude::*,
    render::{
        render_resource::{AsBindGroup, RenderPipelineDescriptor, ShaderType, SpecializedMeshPipelineError},
        storage::ShaderBuffer,
    },
    shader::ShaderRef,
};

/// A fire that leans with the wind.
#[derive(Asset, AsBindGroup, Reflect, Clone, Debug)]
pub(super) struct FireMaterial {
    #[uniform(100)]
    fire: FireUniform,
    #[storage(103, read_only)]
    frame: Handle<ShaderBuffer>,
    #[storage(105, read_only)]
    wind_a: Handle<ShaderBuffer>,
    #[storage(106, read_only)]
    wind_b: Handle<ShaderBuffer>,
}

/// A fire where vertex shaders cannot read the wind: it burns upright.
#[derive(Asset, AsBindGroup, Reflect, Clone, Debug)]
pub(super) struct ShelteredFireMaterial {
    #[uniform(100)]
    fire: FireUniform,
}

/// `Fire` of the shader.
#[derive(ShaderType, Reflect, Clone, Copy, Debug, Default)]
pub(super) struct FireUniform {
    inner_colour: Vec4,
    outer_colour: Vec4,
    /// Cycles and phases of the flicker; w: its depth, and its period, s.
    cycles_and_depth: Vec4,
    phases_and_period: Vec4,
    luminance_cd_m2: f32,
    height_m: f32,
    exposure: f32,
    glow: f32,
    /// Cycles of the rise of tongues in the period.
    rise_cycles: f32,
    size_m: f32,
    padding: Vec2,
}

impl From<&Flames> for FireUniform {
    fn from(flames: &Flames) -> Self {
        let look = &flames.fire.look;
        let opaque = |colour: [f32; 3]| Vec3::from_array(colour).extend(1.0);
        let flicker = &flames.flicker;
        Self {
            inner_colour: opaque(look.inner_colour),
            outer_colour: opaque(look.outer_colour),
            cycles_and_depth: Vec3::from_array(flicker.cycles).extend(flicker.depth),
            phases_and_period: Vec3::from_array(flicker.phases).extend(FLUTTER_PERIOD_S as f32),
            luminance_cd_m2: look.luminance_cd_m2,
            height_m: flames.height_m,
            exposure: look.exposure,
            glow: look.glow,
            rise_cycles: (look.flicker_hz * FLUTTER_PERIOD_S as f32).round(),
            size_m: flames.fire.shape.size_m,
            padding: Vec2::ZERO,
        }
    }
}

impl FireMaterial {
    pub fn new(flames: &Flames, buffers: &SwayBuffers) -> Self {
        let [wind_a, wind_b] = buffers.winds.clone();
        Self { fire: FireUniform::from(flames), frame: buffers.frame.clone(), wind_a, wind_b }
    }
}

impl ShelteredFireMaterial {
    pub fn new(flames: &Flames) -> Self {
        Self { fire: FireUniform::from(flames) }
    }
}

const FIRE_SHADER: &str = "embedded://bevy_windwood/fire/shaders/fire.wesl";

fn specialize_fire(
    descriptor: &mut RenderPipelineDescriptor,
    layout: &MeshVertexBufferLayoutRef,
    flags: &[&'static str],
) -> Result<(), SpecializedMeshPipelineError> {
    descriptor.primitive.cull_mode = None;
    let attributes = [
        Mesh::ATTRIBUTE_POSITION.at_shader_location(0),
        Mesh::ATTRIBUTE_UV_0.at_shader_location(2),
        ATTRIBUTE_FLAME.at_shader_location(8),
        ATTRIBUTE_FLAME_OWN.at_shader_location(9),
    ];
    specialize(descriptor, layout, &attributes, flags)
}

macro_rules! fire_material {
    ($material:ty, $flags:expr) => {
        impl Material for $material {
            fn vertex_shader() -> ShaderRef {
                FIRE_SHADER.into()
            }

            fn fragment_shader() -> ShaderRef {
                FIRE_SHADER.into()
            }

            fn alpha_mode(&self) -> AlphaMode {
                AlphaMode::Add
            }

            fn enable_prepass() -> bool {
                false
            }

            fn enable_shadows() -> bool {
                false
            }

            fn specialize(
                _: &MaterialPipeline,
                descriptor: &mut RenderPipelineDescriptor,
                layout: &MeshVertexBufferLayoutRef,
                _: MaterialPipelineKey<Self>,
            ) -> Result<(), SpecializedMeshPipelineError> {
                specialize_fire(descriptor, layout, &$flags)
            }
        }
    };
}

fire_material!(FireMaterial, ["WINDWOOD_FIRE", "WINDWOOD_WIND"]);
fire_material!(ShelteredFireMaterial, ["WINDWOOD_FIRE"]);
