//! What the pipelines of all our materials have in common: their vertex layout, and the definitions of their shaders.

use bevy::{
    mesh::{MeshVertexBufferLayoutRef, VertexAttributeDescriptor},
    pbr::MeshPipelineKey,
    render::render_resource::{CompareFunction, RenderPipelineDescriptor, SpecializedMeshPipelineError},
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

/// In the main pass after a depth prepass, shades only what is seen: the fragments at the very depth that the prepass left. That has left out
/// what is masked or faded, so the shaders' own tests, which would have every fragment run before its depth is compared, are not
/// needed (`WINDWOOD_DEPTH_IS_KNOWN`). Both passes have the same vertex stage, and with it the same depths.
pub(crate) fn shade_what_is_seen(descriptor: &mut RenderPipelineDescriptor, key: MeshPipelineKey) {
    let is_opaque = key.intersection(MeshPipelineKey::BLEND_RESERVED_BITS) == MeshPipelineKey::BLEND_OPAQUE;
    let is_prepass = descriptor.vertex.shader_defs.contains(&"PREPASS_PIPELINE".into());
    let Some(depth) = &mut descriptor.depth_stencil else { return };
    if is_opaque && !is_prepass && key.contains(MeshPipelineKey::DEPTH_PREPASS) {
        depth.depth_compare = Some(CompareFunction::Equal);
        depth.depth_write_enabled = Some(false);
        define(descriptor, "WINDWOOD_DEPTH_IS_KNOWN".into());
    }
}

/// Tells the shaders where they draw the shadows of a sun (`WINDWOOD_SUN_SHADOW`).
pub(crate) fn tell_of_sun_shadow(descriptor: &mut RenderPipelineDescriptor, key: MeshPipelineKey) {
    if key.contains(MeshPipelineKey::UNCLIPPED_DEPTH_ORTHO) {
        define(descriptor, "WINDWOOD_SUN_SHADOW".into());
    }
}

fn define(descriptor: &mut RenderPipelineDescriptor, definition: ShaderDefVal) {
    if let Some(fragment) = &mut descriptor.fragment {
        fragment.shader_defs.push(definition.clone());
    }
    descriptor.vertex.shader_defs.push(definition);
}
