//! What the pipelines of all our materials have in common: their vertex layout, and the definitions of their shaders.

use bevy::{
    mesh::{MeshVertexBufferLayoutRef, VertexAttributeDescriptor},
    render::render_resource::{RenderPipelineDescriptor, SpecializedMeshPipelineError},
    shader::ShaderDefVal,
};

/// Sets the vertex attributes of a pipeline, and flags (`@if(NAME)`) for its shaders. Bevy's own vertex locations differ between the
/// main pass, the prepass and the shadow pass; ours are the same in all.
pub(crate) fn specialize(
    descriptor: &mut RenderPipelineDescriptor,
    layout: &MeshVertexBufferLayoutRef,
    attributes: &[VertexAttributeDescriptor],
    flags: &[&'static str],
) -> Result<(), SpecializedMeshPipelineError> {
    descriptor.vertex.buffers = vec![layout.0.get_layout(attributes)?];
    flags.iter().for_each(|flag| define(descriptor, (*flag).into()));
    Ok(())
}

/// Sets constants (`constants::NAME`) for the shaders of a pipeline.
pub(crate) fn set_constants(descriptor: &mut RenderPipelineDescriptor, constants: &[(&'static str, u32)]) {
    constants.iter().for_each(|(name, value)| define(descriptor, ShaderDefVal::UInt((*name).into(), *value)));
}

fn define(descriptor: &mut RenderPipelineDescriptor, definition: ShaderDefVal) {
    if let Some(fragment) = &mut descriptor.fragment {
        fragment.shader_defs.push(definition.clone());
    }
    descriptor.vertex.shader_defs.push(definition);
}
