// Draws a tree in the wind: one vertex stage for the main pass, the prepass and the shadow pass, so that all three agree.
//
// `WINDWOOD_LEAVES` is defined for leaf cards, which have a main axis and an anchor, and not for wood.

#import bevy_pbr::mesh_functions
#import bevy_pbr::view_transformations::position_world_to_clip
#import bevy_windwood::pose

#ifdef WINDWOOD_LEAVES
#import bevy_windwood::leaf
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
    // x: beam; y: place on it, 0..1; z: phase of the leaf, 0..1; w: light that reaches this depth of the crown, 0..1.
    @location(8) sway: vec4<f32>,
#ifdef WINDWOOD_LEAVES
    // xyz: main axis at rest; w: tint, 0..1.
    @location(9) axis: vec4<f32>,
    // xyz: where the leaf hangs at rest.
    @location(10) anchor: vec4<f32>,
#endif
}

// The instance tag: the first row of the model in the beam table, and a tint of its own above it.
const BEAM_BITS: u32 = 24u;

fn instance_at(world_from_local: mat4x4<f32>, tag: u32) -> pose::Instance {
    return pose::instance_from_matrix(world_from_local, tag & ((1u << BEAM_BITS) - 1u));
}

// The vertex where the wind has it, in tree-local space.
fn swayed(vertex: Vertex, instance: pose::Instance, frames_ago: u32) -> pose::Motion {
    let moment = pose::moment(instance, frames_ago);
    let beam = u32(vertex.sway.x + 0.5);
#ifdef WINDWOOD_LEAVES
    // The bough carries the anchor and the leaf as it rests; the leaf then turns about the anchor.
    let carried = pose::pose_point(instance, moment, beam, vertex.sway.y, vertex.anchor.xyz);
    let wind = pose::wind_velocity(moment) * instance.rotation;
    let axis = pose::rotate(carried.rotation, vertex.axis.xyz);
    let turn = leaf::turn(axis, wind, pose::leaf_seconds(frames_ago), vertex.sway.z);
    let rotation = pose::then(carried.rotation, turn);
    let arm = pose::rotate(rotation, vertex.position - vertex.anchor.xyz);
    return pose::Motion(carried.position + arm, rotation);
#else
    return pose::pose_point(instance, moment, beam, vertex.sway.y, vertex.position);
#endif
}

@vertex
fn vertex(vertex: Vertex) -> VertexOutput {
    var out: VertexOutput;
    let world_from_local = mesh_functions::get_world_from_local(vertex.instance_index);
    let tag = mesh_functions::get_tag(vertex.instance_index);
    let instance = instance_at(world_from_local, tag);
    let now = swayed(vertex, instance, 0u);

    out.world_position = world_from_local * vec4(now.position, 1.0);
    out.position = position_world_to_clip(out.world_position.xyz);
#ifdef UNCLIPPED_DEPTH_ORTHO_EMULATION
    out.unclipped_depth = out.position.z;
    out.position.z = min(out.position.z, 1.0);
#endif

#ifdef VERTEX_UVS_A
    out.uv = vertex.uv;
#endif

    let normal = instance.rotation * pose::rotate(now.rotation, vertex.normal);
#ifdef PREPASS_PIPELINE
#ifdef NORMAL_PREPASS_OR_DEFERRED_PREPASS
    out.world_normal = normal;
#ifdef VERTEX_TANGENTS
    out.world_tangent = bark_tangent(vertex, instance, now, normal);
#endif
#endif
#else
    out.world_normal = normal;
#ifdef VERTEX_TANGENTS
    out.world_tangent = bark_tangent(vertex, instance, now, normal);
#endif
#endif

#ifdef VERTEX_COLORS
    out.color = vec4(shade(vertex, tag), 1.0);
#endif

#ifdef MOTION_VECTOR_PREPASS
    let before_from_local = mesh_functions::get_previous_world_from_local(vertex.instance_index);
    let before = swayed(vertex, instance_at(before_from_local, tag), 1u);
    out.previous_world_position = before_from_local * vec4(before.position, 1.0);
#endif

#ifdef VERTEX_OUTPUT_INSTANCE_INDEX
    out.instance_index = vertex.instance_index;
#endif
#ifdef VISIBILITY_RANGE_DITHER
    out.visibility_range_dither =
        mesh_functions::get_visibility_range_dither_level(vertex.instance_index, world_from_local[3]);
#endif
    return out;
}

#ifdef VERTEX_TANGENTS
// Bark is wound around its beam: u runs around, v along, so the tangent needs no vertex attribute.
fn bark_tangent(vertex: Vertex, instance: pose::Instance, now: pose::Motion, normal: vec3<f32>) -> vec4<f32> {
    let row = pose::beams[instance.first_beam + u32(vertex.sway.x + 0.5)];
    let along = instance.rotation * pose::rotate(now.rotation, row.direction.xyz);
    let around = cross(along, normal);
    let fallback = cross(along, vec3(0.36, 0.48, 0.8));
    let flat = dot(around, around) < 1e-6;
    return vec4(normalize(select(around, fallback, flat)), 1.0);
}
#endif

#ifdef VERTEX_COLORS
// Light lost in the crown, and the natural variation between trees and between leaves.
fn shade(vertex: Vertex, tag: u32) -> vec3<f32> {
    let light = mix(0.35, 1.0, vertex.sway.w);
#ifdef WINDWOOD_LEAVES
    let own = f32(tag >> BEAM_BITS) / 255.0 - 0.5;
    let leaf_tint = vertex.axis.w - 0.5;
    let warm = vec3(1.0 + 0.35 * own + 0.22 * leaf_tint, 1.0 + 0.12 * own + 0.12 * leaf_tint, 1.0 - 0.25 * own);
    return light * warm;
#else
    return vec3(light);
#endif
}
#endif
