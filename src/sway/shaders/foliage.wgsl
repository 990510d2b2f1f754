// The colour of leaves over the year; wood is shaded as any standard material. The prepass and the shadow pass need only
// the mask: see `mask.wgsl`.

#import bevy_pbr::forward_io::{FragmentOutput, VertexOutput}
#import bevy_pbr::pbr_fragment::pbr_input_from_standard_material
#import bevy_pbr::pbr_functions::{alpha_discard, main_pass_post_lighting_processing}
#import bevy_windwood::light

#ifdef WINDWOOD_LEAVES
#import bevy_pbr::mesh_view_bindings::view
#import bevy_pbr::pbr_bindings::{base_color_sampler, base_color_texture}
#import bevy_windwood::{leaf, season}
#ifdef STANDARD_MATERIAL_NORMAL_MAP
#import bevy_pbr::pbr_bindings::{normal_map_sampler, normal_map_texture}
#endif
#endif

#ifdef WINDWOOD_ENVELOPE
#import bevy_windwood::season
#endif

#import bevy_pbr::pbr_functions::visibility_range_dither

@fragment
fn fragment(in: VertexOutput, @builtin(front_facing) is_front: bool) -> FragmentOutput {
    visibility_range_dither(in.position, in.visibility_range_dither);
    var pbr_input = pbr_input_from_standard_material(in, is_front);
#ifdef WINDWOOD_ENVELOPE
    if !season::is_left(in.uv, in.color.a) {
        discard;
    }
    pbr_input.material.base_color.a /= max(in.color.a, 1e-3);
#endif
#ifdef WINDWOOD_LEAVES
    if !leaf::is_billow() {
        // The alpha of the vertices is no transparency here, and is taken out again.
        let texel = textureSampleBias(base_color_texture, base_color_sampler, in.uv, view.mip_bias);
        let span = fwidth(in.uv) * f32(textureDimensions(base_color_texture).x);
        if !season::is_there(texel.rgb, in.uv, in.color.a, max(span.x, span.y)) {
            discard;
        }
        pbr_input.material.base_color.a = texel.a;
    }
#endif
    pbr_input.material.base_color = alpha_discard(pbr_input.material, pbr_input.material.base_color);
#ifdef WINDWOOD_LEAVES
#ifdef STANDARD_MATERIAL_NORMAL_MAP
    // Veins and twigs let less light through.
    let veil = textureSample(normal_map_texture, normal_map_sampler, in.uv).a;
    pbr_input.material.diffuse_transmission *= veil;
#endif
    let summer = pbr_input.material.base_color.rgb;
    pbr_input.material.base_color = vec4(season::recoloured(summer, in.uv_b.x, in.uv_b.y), pbr_input.material.base_color.a);
#endif
#ifdef WINDWOOD_ENVELOPE
    let summer = pbr_input.material.base_color.rgb;
    pbr_input.material.base_color = vec4(season::recoloured(summer, in.uv_b.x, in.uv_b.y), 1.0);
#endif
    var out: FragmentOutput;
    out.color = light::lit(pbr_input);
    out.color = main_pass_post_lighting_processing(pbr_input, out.color);
    return out;
}
