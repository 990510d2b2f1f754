// What a fragment of a tree is made of, before it is lit. Bevy's own reading of a standard material asks for a dozen textures,
// of which ours have none to three, and a processor that draws samples every one of them.

#define_import_path bevy_windwood::surface

#import bevy_pbr::forward_io::VertexOutput
#import bevy_pbr::pbr_bindings::material
#import bevy_pbr::pbr_fragment::pbr_input_from_vertex_output
#import bevy_pbr::pbr_types::PbrInput

#ifdef SCREEN_SPACE_AMBIENT_OCCLUSION
#import bevy_pbr::lighting::perceptualRoughnessToRoughness
#import bevy_pbr::mesh_view_bindings::screen_space_ambient_occlusion_texture
#import bevy_pbr::ssao_utils::ssao_multibounce
#endif

// A standard material without textures, in `colour`, not yet occluded by what is near.
fn plain(in: VertexOutput, is_front: bool, colour: vec4<f32>) -> PbrInput {
    var input = pbr_input_from_vertex_output(in, is_front, false);
    input.material.flags = material.flags;
    input.material.alpha_cutoff = material.alpha_cutoff;
    input.material.base_color = colour;
    input.material.reflectance = material.reflectance;
    input.material.metallic = 0.0;
    input.material.perceptual_roughness = material.perceptual_roughness;
    input.material.diffuse_transmission = material.diffuse_transmission;
    input.clearcoat_N = input.N;
    return input;
}

// Takes account of what the camera's ambient occlusion has found, where it looks for it.
fn occlude(input: ptr<function, PbrInput>) {
#ifdef SCREEN_SPACE_AMBIENT_OCCLUSION
    // As in Bevy's `pbr_fragment.wgsl`, after Lagarde and de Rousiers.
    let open = textureLoad(screen_space_ambient_occlusion_texture, vec2<i32>((*input).frag_coord.xy), 0i).r;
    let roughness = perceptualRoughnessToRoughness((*input).material.perceptual_roughness);
    let n_dot_v = max(dot((*input).N, (*input).V), 0.0001);
    (*input).diffuse_occlusion = min((*input).diffuse_occlusion, ssao_multibounce(open, (*input).material.base_color.rgb));
    (*input).specular_occlusion = saturate(pow(n_dot_v + open, exp2(-16.0 * roughness - 1.0)) - 1.0 + open);
#endif
}
