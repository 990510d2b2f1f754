// What the prepass and the shadow pass show of a far tree.

#import bevy_pbr::prepass_io
#import bevy_windwood::{beam, far, level, season, written}

@group(#{MATERIAL_BIND_GROUP}) @binding(103) var<storage, read> frame: beam::Frame;

fn cut_out(in: prepass_io::VertexOutput) {
    if level::leaves_out(in.position, in.visibility_range_dither) {
        discard;
    }
    let rank = far::leaf_rank(in.color.xyz);
    let state = season::leaves(frame.year, in.uv_b.y - 0.5, rank);
    if !far::spot_at(in.color.a, in.uv, in.color.xyz, rank < state.size).is_there {
        discard;
    }
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
