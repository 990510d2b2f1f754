// A chunk of ground: its lattice, and those of the upright triangles at its edges that close a gap at the moment. One vertex
// stage for the main pass, the prepass and the shadow pass, so that all three agree.

#import bevy_pbr::mesh_functions
#import bevy_pbr::view_transformations::position_world_to_clip

#ifdef PREPASS_PIPELINE
#import bevy_pbr::prepass_io::VertexOutput
#else
#import bevy_pbr::forward_io::VertexOutput
#endif

struct Vertex {
    @builtin(instance_index) instance_index: u32,
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    // x: code of the gap; y: share of the ground that is under trees, 0..1.
    @location(8) marks: vec2<f32>,
}

// `Seams::shows` of `terrain/chunk.rs`: the tag holds, for each edge, by how many levels the ground beyond is coarser.
fn shows(seams: u32, code: u32) -> bool {
    return ((seams >> (4u * (code >> 3u))) & 15u) >= (code & 7u);
}

@vertex
fn vertex(in: Vertex) -> VertexOutput {
    var out: VertexOutput;
    let world_from_local = mesh_functions::get_world_from_local(in.instance_index);
    out.world_position = world_from_local * vec4(in.position, 1.0);
    out.position = position_world_to_clip(out.world_position.xyz);
    // All three corners of a triangle have one code: it becomes a point, and is not drawn.
    if !shows(mesh_functions::get_tag(in.instance_index), u32(in.marks.x + 0.5)) {
        out.position = vec4(0.0, 0.0, 2.0, 1.0);
    }
#ifdef UNCLIPPED_DEPTH_ORTHO_EMULATION
    out.unclipped_depth = out.position.z;
    out.position.z = min(out.position.z, 1.0);
#endif

#ifdef PREPASS_PIPELINE
#ifdef NORMAL_PREPASS_OR_DEFERRED_PREPASS
    out.world_normal = in.normal;
#endif
#ifdef MOTION_VECTOR_PREPASS
    // The ground stands still.
    out.previous_world_position = out.world_position;
#endif
#else
    out.world_normal = in.normal;
#endif

#ifdef VERTEX_COLORS
    out.color = vec4(1.0, 1.0, 1.0, in.marks.y);
#endif
#ifdef VERTEX_OUTPUT_INSTANCE_INDEX
    out.instance_index = in.instance_index;
#endif
#ifdef VISIBILITY_RANGE_DITHER
    out.visibility_range_dither =
        mesh_functions::get_visibility_range_dither_level(in.instance_index, world_from_local[3]);
#endif
    return out;
}
