// The colour of a tree: of leaves over the year, and of bark. The prepass and the shadow pass need only the mask: see
// `mask.wgsl`.

#import bevy_pbr::forward_io::{FragmentOutput, VertexOutput}
#import bevy_pbr::mesh_view_bindings::view
#import bevy_pbr::pbr_bindings::{base_color_sampler, base_color_texture, material}
#import bevy_pbr::pbr_functions::{alpha_discard, main_pass_post_lighting_processing}
#import bevy_windwood::{level, light, surface}

#ifdef WINDWOOD_LEAVES
#import bevy_windwood::{leaf, season}
#endif

#ifdef WINDWOOD_ENVELOPE
#import bevy_windwood::season
#endif

#ifdef STANDARD_MATERIAL_NORMAL_MAP
#import bevy_pbr::pbr_bindings::{normal_map_sampler, normal_map_texture}
#import bevy_pbr::pbr_functions::{apply_normal_mapping, calculate_tbn_mikktspace}
#ifndef WINDWOOD_LEAVES
#import bevy_pbr::pbr_bindings::{metallic_roughness_sampler, metallic_roughness_texture}
#endif
#endif

@fragment
fn fragment(in: VertexOutput, @builtin(front_facing) is_front: bool) -> FragmentOutput {
    if level::leaves_out(in.position, in.visibility_range_dither) {
        discard;
    }
    let texel = textureSampleBias(base_color_texture, base_color_sampler, in.uv, view.mip_bias);
    var colour = in.color * material.base_color * texel;
#ifdef WINDWOOD_ENVELOPE
    // The alpha of the vertices is no transparency here, nor that of sprays.
    if !season::is_left(in.uv, in.color.a) {
        discard;
    }
    colour.a = texel.a;
#endif
#ifdef WINDWOOD_LEAVES
    if !leaf::is_billow() {
        let span = fwidth(in.uv) * f32(textureDimensions(base_color_texture).x);
        if !season::is_there(texel.rgb, in.uv, in.color.a, max(span.x, span.y)) {
            discard;
        }
        colour.a = texel.a;
    }
#endif
    var pbr_input = surface::plain(in, is_front, colour);
    pbr_input.material.base_color = alpha_discard(pbr_input.material, colour);
#ifdef STANDARD_MATERIAL_NORMAL_MAP
    let detail = textureSampleBias(normal_map_texture, normal_map_sampler, in.uv, view.mip_bias);
    let frame = calculate_tbn_mikktspace(in.world_normal, in.world_tangent);
    pbr_input.N = apply_normal_mapping(material.flags, frame, false, is_front, detail.rgb);
#ifdef WINDWOOD_LEAVES
    // Veins and twigs let less light through.
    pbr_input.material.diffuse_transmission *= detail.a;
#else
    let bark = textureSampleBias(metallic_roughness_texture, metallic_roughness_sampler, in.uv, view.mip_bias);
    pbr_input.material.perceptual_roughness *= bark.g;
    pbr_input.diffuse_occlusion = vec3(bark.r);
#endif
#endif
#ifdef WINDWOOD_LEAVES
    let summer = pbr_input.material.base_color.rgb;
    pbr_input.material.base_color = vec4(season::recoloured(summer, in.uv_b.x, in.uv_b.y), pbr_input.material.base_color.a);
#endif
#ifdef WINDWOOD_ENVELOPE
    let summer = pbr_input.material.base_color.rgb;
    pbr_input.material.base_color = vec4(season::recoloured(summer, in.uv_b.x, in.uv_b.y), 1.0);
#endif
    surface::occlude(&pbr_input);
    var out: FragmentOutput;
    out.color = light::lit(pbr_input);
    out.color = main_pass_post_lighting_processing(pbr_input, out.color);
    return out;
}
