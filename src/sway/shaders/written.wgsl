// What the prepass writes of a fragment that is not cut out: as Bevy's own, with the normals of the vertices.

#define_import_path bevy_windwood::written

#import bevy_pbr::pbr_prepass_functions
#import bevy_pbr::prepass_io

#ifdef PREPASS_FRAGMENT
fn of_fragment(in: prepass_io::VertexOutput) -> prepass_io::FragmentOutput {
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
#endif
