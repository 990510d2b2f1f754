// What the prepass and the shadow pass show of a tree: as Bevy's own, but billows grow transparent towards their outline,
// and sprays show only those leaves that the season has. Normals are those of the vertices.

#import bevy_pbr::mesh_view_bindings::view
#import bevy_pbr::pbr_bindings::{base_color_sampler, base_color_texture, material}
#import bevy_pbr::prepass_io
#import bevy_windwood::{level, written}

#ifdef WINDWOOD_LEAVES
#import bevy_windwood::{leaf, season}
#endif

#ifdef WINDWOOD_ENVELOPE
#import bevy_windwood::season
#endif

fn cut_out(in: prepass_io::VertexOutput) {
    if level::leaves_out(in.position, in.visibility_range_dither) {
        discard;
    }
#ifdef VERTEX_UVS_A
#ifdef WINDWOOD_LEAVES
    let texel = textureSampleBias(base_color_texture, base_color_sampler, in.uv, view.mip_bias);
    let span = fwidth(in.uv) * f32(textureDimensions(base_color_texture).x);
    let is_billow = leaf::is_billow();
    let alpha = texel.a * select(1.0, in.color.a, is_billow);
    if alpha < material.alpha_cutoff || (!is_billow && !season::is_there(texel.rgb, in.uv, in.color.a, max(span.x, span.y))) {
        discard;
    }
#else
#ifdef WINDWOOD_ENVELOPE
    if !season::is_left(in.uv, in.color.a) {
        discard;
    }
#endif
#ifdef MAY_DISCARD
    if textureSampleBias(base_color_texture, base_color_sampler, in.uv, view.mip_bias).a < material.alpha_cutoff {
        discard;
    }
#endif
#endif
#endif
}

#ifdef PREPASS_FRAGMENT
@fragment
fn fragment(in: prepass_io::VertexOutput) -> prepass_io::FragmentOutput {
    cut_out(in);
    return written::of_fragment(in);
}
#else
@fragment
fn fragment(in: prepass_io::VertexOutput) {
    cut_out(in);
}
#endif
