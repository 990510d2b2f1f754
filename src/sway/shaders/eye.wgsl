// Where whoever looks is: a camera, or the sun in its shadow maps.

#define_import_path bevy_windwood::eye

#import bevy_pbr::mesh_view_bindings::view

// Whether rays are parallel, as those of the sun are.
fn is_parallel() -> bool {
    return view.clip_from_view[3].w == 1.0;
}

fn direction_to_eye(place: vec3<f32>) -> vec3<f32> {
    if is_parallel() {
        return view.world_from_view[2].xyz;
    }
    return normalize(view.world_position - place);
}
