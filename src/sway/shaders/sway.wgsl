// Draws a tree in the wind: one vertex stage for the main pass, the prepass and the shadow pass, so that all three agree.
//
// `WINDWOOD_LEAVES` is defined for leaf cards, which have a main axis and an anchor, and not for wood.

#import bevy_pbr::mesh_functions
#import bevy_pbr::mesh_view_bindings::view
#import bevy_pbr::view_transformations::position_world_to_clip
#import bevy_windwood::beam
#import bevy_windwood::eye
#import bevy_windwood::level

#ifdef WINDWOOD_LEAVES
#import bevy_windwood::leaf
#import bevy_windwood::season
#endif

#ifdef WINDWOOD_ENVELOPE
#import bevy_windwood::season
#endif

#ifdef PREPASS_PIPELINE
#import bevy_pbr::prepass_io::VertexOutput
#else
#import bevy_pbr::forward_io::VertexOutput
#endif

struct Vertex {
    @builtin(instance_index) instance_index: u32,
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) uv: vec2<f32>,
#ifdef WINDWOOD_ENVELOPE
    // x: images of the sequence, one below another in the texture.
    @location(3) sequence: vec2<f32>,
#endif
    // x: beam; y: place on it, 0..1; z: phase of the leaf, 0..1; w: light that reaches this depth of the crown, 0..1.
    @location(8) sway: vec4<f32>,
#ifdef WINDWOOD_LEAVES
    // xyz: main axis at rest; w: tint, 0..1.
    @location(9) axis: vec4<f32>,
    // xyz: where the leaf hangs at rest.
    @location(10) anchor: vec4<f32>,
#endif
}

@group(#{MATERIAL_BIND_GROUP}) @binding(100) var<storage, read> poses: array<beam::BeamPose>;
@group(#{MATERIAL_BIND_GROUP}) @binding(101) var<storage, read> beams: array<beam::BeamRow>;
@group(#{MATERIAL_BIND_GROUP}) @binding(102) var<storage, read> trees: array<beam::TreeRow>;
@group(#{MATERIAL_BIND_GROUP}) @binding(103) var<storage, read> frame: beam::Frame;

// The instance tag, see `Dress::put` in `sway/draw.rs`: the tree's row, its level, how that fades, and a tint.
const TREE_BITS: u32 = 16u;
const FADES_OUT: u32 = 1u << 18u;
const FADES_IN: u32 = 1u << 19u;
const CARDS_BEHIND: u32 = 1u << 20u;
const TINT_BIT: u32 = 24u;

fn tree_of(tag: u32) -> beam::TreeRow {
    return trees[tag & ((1u << TREE_BITS) - 1u)];
}

// How much of this level is to be seen from where the camera is, also in its shadow maps.
fn dither_of(tag: u32, tree: beam::TreeRow) -> i32 {
    let distance_m = distance(view.lod_view_world_position, tree.position);
    let height_m = beam::height_m(tree);
    let rung = (tag >> TREE_BITS) & 3u;
    if (tag & FADES_IN) != 0u && rung > 0u {
        let coming = level::gone(distance_m, beam::level_end_m(frame, rung - 1u, height_m), frame.fade);
        if coming < level::NOTHING {
            return coming - level::NOTHING;
        }
    }
    if (tag & FADES_OUT) != 0u {
        return level::gone(distance_m, beam::level_end_m(frame, rung, height_m), frame.fade);
    }
    if (tag & CARDS_BEHIND) != 0u {
        return level::gone(distance_m, beam::tree_end_m(frame, height_m), frame.fade);
    }
    return 0;
}

#ifdef WINDWOOD_LEAVES
// How early a cluster is in the year, -1..1: alike within a branch and, less so, within a tree.
fn lag_of(in: Vertex, tag: u32) -> f32 {
    return (in.axis.w - 0.5) + (f32(tag >> TINT_BIT) / 255.0 - 0.5);
}
#endif

// The wind at a tree, m/s, in tree-local axes; none where it is not posed.
fn wind_at(tree: beam::TreeRow, first_pose: u32) -> vec3<f32> {
    if tree.beam_count == 0u {
        return vec3(0.0);
    }
    return poses[first_pose + tree.first_pose + tree.beam_count].tip_angle.xyz;
}

// The vertex where the wind has it, in tree-local space.
fn swayed(
    in: Vertex,
    tree: beam::TreeRow,
    first_pose: u32,
    leaf_time_s: f32,
#ifdef WINDWOOD_LEAVES
    state: season::LeafState,
#endif
) -> beam::Motion {
    let index = u32(in.sway.x + 0.5);
    let row = beams[tree.first_beam + index];
    var pose = beam::at_rest();
    if tree.beam_count > 0u {
        pose = poses[first_pose + tree.first_pose + index];
    }
#ifdef WINDWOOD_LEAVES
    // The bough carries the anchor and the leaf as it rests; the leaf then turns about the anchor.
    let carried = beam::carry(row, pose, in.sway.y, in.anchor.xyz);
    let wind = wind_at(tree, first_pose);
    let turn = leaf::turn(beam::rotate(carried.rotation, in.axis.xyz), wind, leaf_time_s, in.sway.z);
    let rotation = beam::then(carried.rotation, turn);
    let reach = in.position - in.anchor.xyz;
    if state.drifting {
        let way = season::drift(wind, carried.position.y, leaf_time_s, in.sway.z);
        let tumbled = beam::then(rotation, leaf::from_scaled_axis(vec3(0.9, 0.3, 0.5) * (2.5 * way.y)));
        return beam::Motion(carried.position + way.xyz + beam::rotate(tumbled, reach * way.w), tumbled);
    }
    // Sprays keep their twigs and lose their leaves fragment by fragment; billows have none, and shrink.
    let scale = select(1.0, state.size, leaf::is_billow());
    return beam::Motion(carried.position + beam::rotate(rotation, reach * scale), rotation);
#else
    return beam::carry(row, pose, in.sway.y, in.position);
#endif
}

@vertex
fn vertex(in: Vertex) -> VertexOutput {
    var out: VertexOutput;
    let world_from_local = mesh_functions::get_world_from_local(in.instance_index);
    let tag = mesh_functions::get_tag(in.instance_index);
    let tree = tree_of(tag);
#ifdef WINDWOOD_LEAVES
    let state = season::leaves(fract(frame.year + beam::season_shift(tree)), lag_of(in, tag), in.sway.z);
    let now = swayed(in, tree, frame.poses_now, frame.leaf_time.x, state);
#else
    let now = swayed(in, tree, frame.poses_now, frame.leaf_time.x);
#endif

    out.world_position = world_from_local * vec4(now.position, 1.0);
    out.position = position_world_to_clip(out.world_position.xyz);
#ifdef UNCLIPPED_DEPTH_ORTHO_EMULATION
    out.unclipped_depth = out.position.z;
    out.position.z = min(out.position.z, 1.0);
#endif

#ifdef VERTEX_UVS_A
    out.uv = in.uv;
#ifdef WINDWOOD_ENVELOPE
    out.uv.y = (image_of(in, tag, tree) + mix(BORDER, 1.0 - BORDER, in.uv.y)) / in.sequence.x;
#endif
#endif

#ifdef WINDWOOD_ENVELOPE
    let own = f32(tag >> TINT_BIT) / 255.0 - 0.5;
    let state = season::leaves(fract(frame.year + beam::season_shift(tree)), own, 0.5);
#endif
#ifdef VERTEX_UVS_B
#ifdef WINDWOOD_ENVELOPE
    out.uv_b = vec2(state.autumn - state.youth, saturate(0.5 + 1.5 * own));
#endif
#ifdef WINDWOOD_LEAVES
    // Youth (negative) or autumn (positive), and where between the autumn's two colours.
    out.uv_b = vec2(state.autumn - state.youth, saturate(0.5 + 1.5 * lag_of(in, tag) + 0.5 * (in.sway.z - 0.5)));
#endif
#endif

    let normal = beam::rotate(beam::then(now.rotation, tree.rotation), in.normal);
#ifdef PREPASS_PIPELINE
#ifdef NORMAL_PREPASS_OR_DEFERRED_PREPASS
    out.world_normal = normal;
#ifdef VERTEX_TANGENTS
    out.world_tangent = tangent(in, tree, now, normal);
#endif
#endif
#else
    out.world_normal = normal;
#ifdef VERTEX_TANGENTS
    out.world_tangent = tangent(in, tree, now, normal);
#endif
#endif

#ifdef VERTEX_COLORS
    out.color = vec4(shade(in, tag), 1.0);
#ifdef WINDWOOD_ENVELOPE
    out.color.a = state.size;
#endif
#ifdef WINDWOOD_LEAVES
    // Billows: what the mask is multiplied with. Sprays: how much of the leaves is there.
    let outline = leaf::silhouette_alpha(dot(normal, eye::direction_to_eye(out.world_position.xyz)));
    out.color.a = select(select(state.size, 1.0, state.drifting), outline, leaf::is_billow());
#endif
#endif

// The main pass knows of the motion vectors, too, but does not write them.
#ifdef PREPASS_PIPELINE
#ifdef MOTION_VECTOR_PREPASS
    let before_from_local = mesh_functions::get_previous_world_from_local(in.instance_index);
#ifdef WINDWOOD_LEAVES
    let before = swayed(in, tree, frame.poses_before, frame.leaf_time.y, state);
#else
    let before = swayed(in, tree, frame.poses_before, frame.leaf_time.y);
#endif
    out.previous_world_position = before_from_local * vec4(before.position, 1.0);
#endif
#endif

#ifdef VERTEX_OUTPUT_INSTANCE_INDEX
    out.instance_index = in.instance_index;
#endif
    out.visibility_range_dither = dither_of(tag, tree);
    if level::is_nothing(out.visibility_range_dither) {
        // Every corner is one point out of sight, and no pixel is touched.
        out.position = vec4(0.0, 0.0, 2.0, 1.0);
    }
    return out;
}

#ifdef WINDWOOD_ENVELOPE
// Images a second, the least wind that moves them, m/s, and how far the texture keeps from the border of an image.
const IMAGES_PER_S: f32 = 4.0;
const LEAST_WIND_M_S: f32 = 0.5;
const BORDER: f32 = 0.02;

// The image of the sequence that a tree shows now: each tree begins with another.
fn image_of(in: Vertex, tag: u32, tree: beam::TreeRow) -> f32 {
    let wind = wind_at(tree, frame.poses_now);
    if length(wind) < LEAST_WIND_M_S {
        return 0.0;
    }
    return f32((u32(frame.leaf_time.x * IMAGES_PER_S) + (tag >> TINT_BIT)) % u32(in.sequence.x));
}
#endif

#ifdef VERTEX_TANGENTS
// The tangent needs no vertex attribute. Bark is wound around its beam: u runs around, v along. A spray's twig runs along
// the diagonal of its texture, so u is halfway between the twig and its side.
fn tangent(in: Vertex, tree: beam::TreeRow, now: beam::Motion, normal: vec3<f32>) -> vec4<f32> {
#ifdef WINDWOOD_LEAVES
    let along = beam::rotate(beam::then(now.rotation, tree.rotation), in.axis.xyz);
    let across = normalize(cross(along, normal) + 1e-6 * vec3(0.36, 0.48, 0.8));
    let diagonal = along + across;
    return vec4(normalize(diagonal - normal * dot(diagonal, normal)), 1.0);
#else
    let row = beams[tree.first_beam + u32(in.sway.x + 0.5)];
    let along = beam::rotate(beam::then(now.rotation, tree.rotation), row.direction);
    let around = cross(along, normal);
    let fallback = cross(along, vec3(0.36, 0.48, 0.8));
    let flat = dot(around, around) < 1e-6;
    return vec4(normalize(select(around, fallback, flat)), 1.0);
#endif
}
#endif

#ifdef VERTEX_COLORS
// Light lost in the crown, and the natural variation between trees and between leaves.
fn shade(in: Vertex, tag: u32) -> vec3<f32> {
#ifdef WINDWOOD_LEAVES
    let own = f32(tag >> TINT_BIT) / 255.0 - 0.5;
    let light = (0.25 + 0.75 * in.sway.w) * (0.85 + 0.35 * in.axis.w);
    let warmth = in.axis.w + own;
    return light * vec3(0.92 + 0.2 * warmth, 1.0 + 0.06 * own, 1.05 - 0.25 * warmth);
#else
    return vec3(0.5 + 0.5 * in.sway.w);
#endif
}
#endif
