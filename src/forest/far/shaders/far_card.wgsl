// A far tree as a card that faces the eye, or the light in the shadow pass. One vertex stage for all passes.

#import bevy_pbr::mesh_functions
#import bevy_pbr::mesh_view_bindings::view
#import bevy_pbr::view_transformations::position_world_to_clip
#import bevy_windwood::{beam, eye, far, level}
#import bevy_windwood::wind::{blows_in, first_slot, frame, place_of, pressure, slot_of, slot_time, slot_weight}

#ifdef PREPASS_PIPELINE
#import bevy_pbr::prepass_io::VertexOutput
#else
#import bevy_pbr::forward_io::VertexOutput
#endif

struct Vertex {
    @builtin(instance_index) instance_index: u32,
    // Where the stem leaves the ground.
    @location(0) position: vec3<f32>,
    // Corner, turn, size, tint and tree: `FarTree::code` of `forest/far/mesh.rs`.
    @location(8) code: u32,
}

// The cells whose trees stand near: first cell, side of a cell and farthest distance (bits), then a word of bits a row. See
// `near.rs`.
@group(#{MATERIAL_BIND_GROUP}) @binding(108) var<storage, read> near_cells: array<u32>;

const NEAR_SIDE: i32 = 32;
const TURN: f32 = 6.283185307179586;
const GREATEST_SIZE: f32 = 4.0;

fn stands_near(place: vec2<f32>) -> bool {
    let cell_m = bitcast<f32>(near_cells[2]);
    let first = vec2(bitcast<i32>(near_cells[0]), bitcast<i32>(near_cells[1]));
    let at = vec2<i32>(floor(place / max(cell_m, 1e-3))) - first;
    if any(at < vec2(0)) || any(at >= vec2(NEAR_SIDE)) {
        return false;
    }
    return ((near_cells[4 + at.y] >> u32(at.x)) & 1u) == 1u;
}

// How much of a card is to be seen from where the camera is: where its tree stands near, it comes as the tree goes; at the
// border of the far trees it goes.
fn dither_of(foot: vec3<f32>, height_m: f32) -> i32 {
    let distance_m = distance(view.lod_view_world_position, foot);
    if stands_near(foot.xz) {
        let coming = level::gone(distance_m, beam::card_begin_m(frame, height_m), frame.fade);
        if coming < level::NOTHING {
            return coming - level::NOTHING;
        }
    }
    let farthest_m = bitcast<f32>(near_cells[3]);
    return level::gone(distance_m, farthest_m / (1.0 + frame.fade), frame.fade);
}

// The sine of a tree's lean, as a vector downwind (x, z) in the world: what the wind tables have for its stem, as if that were
// one beam. A tree scaled as a whole sways slower by its scale and leans as much.
fn lean_of(foot: vec3<f32>, tree: u32, size: f32, frames_ago: u32) -> vec2<f32> {
    let own = far::views.leans[tree];
    var felt = vec2(0.0);
    if frame.ready == 0u {
        return felt;
    }
    var slot = first_slot(frames_ago);
    loop {
        let blowing = slot_of(slot);
        let place = place_of(blowing, foot, slot_time(slot, frames_ago));
        let frequency = own.y - log(max(size, 1e-3)) * blowing.inverse_ln_class_ratio;
        felt += slot_weight(slot, frames_ago) * pressure(slot, blowing, place, vec3(0.0, 1.0, 0.0), frequency).xz;
        continuing {
            slot += 1u;
            break if !blows_in(slot, frames_ago);
        }
    }
    let free = felt * own.x;
    let limit = sin(beam::TIP_ANGLE_LIMIT);
    return free * inverseSqrt(1.0 + dot(free, free) / (limit * limit));
}

// A place above the foot, where a lean has it: as high above the ground as keeps the stem's length.
fn leaning(above: vec3<f32>, lean: vec2<f32>) -> vec3<f32> {
    let upright = sqrt(1.0 - dot(lean, lean));
    return vec3(above.x + above.y * lean.x, above.y * upright, above.z + above.y * lean.y);
}

@vertex
fn vertex(in: Vertex) -> VertexOutput {
    var out: VertexOutput;
    let world_from_local = mesh_functions::get_world_from_local(in.instance_index);
    let foot = (world_from_local * vec4(in.position, 1.0)).xyz;
    let corner = vec2(f32(in.code & 1u), f32((in.code >> 1u) & 1u)) * 2.0 - 1.0;
    let turn = f32((in.code >> 2u) & 255u) / 256.0 * TURN;
    let size = f32((in.code >> 10u) & 4095u) / 4095.0 * GREATEST_SIZE;
    let tint = f32((in.code >> 22u) & 255u) / 255.0;
    let tree = in.code >> 30u;

    let centre = foot + far::turned(far::views.centre, turn) * size;
    let to_eye = far::above_horizon(far::turned(eye::direction_to_eye(centre), -turn));
    let facing = far::basis_towards(to_eye);
    let half = far::half_m(facing);
    let point = far::views.centre + facing.right * (corner.x * half.x) + facing.up * (corner.y * half.y);
    let above = far::turned(point, turn) * size;
    out.world_position = vec4(foot + leaning(above, lean_of(foot, tree, size, 0u)), 1.0);
    if eye::is_parallel() {
        // The card that casts the shadow stands behind the tree: else it would darken half of the card that is seen.
        out.world_position = vec4(out.world_position.xyz - view.world_from_view[2].xyz * (far::views.radius_m * size), 1.0);
    }
    out.position = position_world_to_clip(out.world_position.xyz);
    let dither = dither_of(foot, (far::views.centre.y + far::views.half_height_m) * size);
    out.visibility_range_dither = dither;
    if level::is_nothing(dither) {
        // All four corners are one point, and nothing is drawn.
        out.position = vec4(0.0, 0.0, 2.0, 1.0);
    }
#ifdef UNCLIPPED_DEPTH_ORTHO_EMULATION
    out.unclipped_depth = out.position.z;
    out.position.z = min(out.position.z, 1.0);
#endif

    out.uv = far::view_place(to_eye);
    out.uv_b = vec2(turn, tint);
    out.color = vec4(point, f32(tree));
    let normal = far::turned(to_eye, turn);
#ifdef PREPASS_PIPELINE
#ifdef NORMAL_PREPASS_OR_DEFERRED_PREPASS
    out.world_normal = normal;
#endif
#ifdef MOTION_VECTOR_PREPASS
    out.previous_world_position = vec4(foot + leaning(above, lean_of(foot, tree, size, 1u)), 1.0);
#endif
#else
    out.world_normal = normal;
#endif
#ifdef VERTEX_OUTPUT_INSTANCE_INDEX
    out.instance_index = in.instance_index;
#endif
    return out;
}
