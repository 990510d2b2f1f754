// What the prepass and the shadow pass show of a far tree.

#import bevy_pbr::pbr_functions::visibility_range_dither
#import bevy_pbr::pbr_prepass_functions
#import bevy_pbr::prepass_io
#import bevy_windwood::{beam, far, season}

@group(#{MATERIAL_BIND_GROUP}) @binding(103) var<storage, read> frame: beam::Frame;

fn cut_out(in: prepass_io::VertexOutput) {
    visibility_range_dither(in.position, in.visibility_range_dither);
    let seen = far::seen_at(in.uv, in.color.xyz);
    let rank = far::leaf_rank(in.color.xyz);
    let state = season::leaves(frame.year, in.uv_b.y - 0.5, rank);
    if seen.alpha < 0.5 || (seen.leaf > 0.3 && rank > state.size) {
        discard;
    }
}

#ifdef PREPASS_FRAGMENT
@fragment
fn fragment(in: prepass_io::VertexOutput) -> prepass_io::FragmentOutput {
    cut_out(in);
    var out: prepass_io::FragmentOutput;
#ifdef UNCLIPPED_DEPTH_ORTHO_EMULATION
    out.frag_depth = in.unclipped_depth;
#endif
#ifdef NORMAL_PREPASS
    out.normal = vec4(in.world_normal * 0.5 + vec3(0.5), 1.0);
#endif
#ifdef MOTION_VECTOR_PREPASS
    out.motion_vector =
        pbr_prepass_functions::calculate_motion_vector(in.world_position, in.previous_world_position);
#endif
    return out;
}
#else
@fragment
fn fragment(in: prepass_io::VertexOutput) {
    cut_out(in);
}
#endif
