// What a far tree looks like: its views, in the colours of the season, lit by their normals.

#import bevy_pbr::forward_io::{FragmentOutput, VertexOutput}
#import bevy_pbr::pbr_functions::main_pass_post_lighting_processing
#import bevy_windwood::{beam, far, level, light, season, surface}

@group(#{MATERIAL_BIND_GROUP}) @binding(103) var<storage, read> frame: beam::Frame;

@fragment
fn fragment(in: VertexOutput, @builtin(front_facing) is_front: bool) -> FragmentOutput {
    if level::leaves_out(in.position, in.visibility_range_dither) {
        discard;
    }
    let tint = in.uv_b.y;
    // Leaves come and go, and turn, at a place of the crown's own time.
    let rank = far::leaf_rank(in.color.xyz);
    let state = season::leaves(frame.year, tint - 0.5, rank);
    let spot = far::spot_at(in.color.a, in.uv, in.color.xyz, rank < state.size);
    if !spot.is_there {
        discard;
    }
    let seen = far::seen_at(spot);
    var colour = seen.colour;
    if seen.leaf > 0.3 {
        let own = tint - 0.5;
        colour = season::recoloured(colour, state.autumn - state.youth, saturate(0.5 + 1.5 * own));
        colour *= vec3(1.0 + 0.2 * own, 1.0 + 0.06 * own, 1.0 - 0.25 * own);
    }
    var pbr_input = surface::plain(in, is_front, vec4(colour, 1.0));
    let agreement = min(length(seen.normal), 1.0);
    let normal = far::turned(normalize(seen.normal + vec3(0.0, 1e-4, 0.0)), in.uv_b.x);
    pbr_input.N = normal;
    pbr_input.world_normal = normal;
    // What faces all ways is lit from behind as much as from before.
    pbr_input.material.diffuse_transmission = mix(0.5, far::views.translucency * seen.leaf, agreement);
    surface::occlude(&pbr_input);
    var out: FragmentOutput;
    out.color = light::lit(pbr_input);
    out.color = main_pass_post_lighting_processing(pbr_input, out.color);
    return out;
}
