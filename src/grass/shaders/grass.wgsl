// Draws a meadow in the wind: one vertex stage for the main pass, the prepass and the shadow pass, so that all three agree.

#import bevy_pbr::mesh_functions
#import bevy_pbr::mesh_view_bindings::view
#import bevy_pbr::view_transformations::position_world_to_clip
#import bevy_windwood::blade
#import bevy_windwood::wind::{frame, velocity_at}

#ifdef PREPASS_PIPELINE
#import bevy_pbr::prepass_io::VertexOutput
#else
#import bevy_pbr::forward_io::VertexOutput
#endif

struct Vertex {
    @builtin(instance_index) instance_index: u32,
    // Root of the blade.
    @location(0) position: vec3<f32>,
    // x: side, -1 to 1, 0 at the tip; y: links up from the root.
    @location(2) uv: vec2<f32>,
    // Length and width at the base, m; dryness; rank. (Not `blade`: a name that is imported must not be used again.)
    @location(8) form: vec4<f32>,
    // Azimuth, lean, droop, rad; phase, 0..1.
    @location(9) turn: vec4<f32>,
}

struct Grass {
    // The spare components are padding.
    root_colour: vec4<f32>,
    tip_colour: vec4<f32>,
    dry_colour: vec4<f32>,
    half_bend_speed_m_s: f32,
    flutter_rad: f32,
    // Whole cycles of the flutter in its period, and that period, s.
    flutter_cycles: f32,
    period_s: f32,
    thins_from_m: f32,
    vanishes_at_m: f32,
    padding: vec2<f32>,
}

@group(#{MATERIAL_BIND_GROUP}) @binding(104) var<uniform> grass: Grass;

const TURN: f32 = 6.283185307179586;
// Below this share of what is drawn the blades nearest to the limit shrink, so that none pops.
const SOFT_RANKS: f32 = 0.15;
// Farther than this share of the distance where all have vanished, they shrink.
const SHRINKS_FROM: f32 = 0.7;
// A blade that lies over turns its smooth face to the sky: so much lighter at most. It is what makes gusts seen from afar.
const SHEEN: f32 = 1.2;
// Flutter is full from this share of the half-bend speed on.
const FULL_FLUTTER: f32 = 0.6;

// A vertex where the wind has it, in the patch's coordinates.
struct Swayed {
    position: vec3<f32>,
    axis: vec3<f32>,
    side: vec3<f32>,
}

fn patch_rotation(world_from_local: mat4x4<f32>) -> mat3x3<f32> {
    return mat3x3(
        normalize(world_from_local[0].xyz),
        normalize(world_from_local[1].xyz),
        normalize(world_from_local[2].xyz),
    );
}

fn flutter(phase: f32, time_s: f32, speed: f32) -> vec2<f32> {
    let cycles = grass.flutter_cycles * (time_s / grass.period_s);
    // The second sine has three fifths of the frequency, in whole cycles.
    let slow = round(0.6 * grass.flutter_cycles) * (time_s / grass.period_s);
    let full = smoothstep(0.0, FULL_FLUTTER, speed / grass.half_bend_speed_m_s);
    let angle = TURN * fract(vec2(cycles, slow) + phase * vec2(1.0, 7.0));
    return grass.flutter_rad * full * sin(angle);
}

// How far a blade is drawn out, 0 to 1, and how much wider it is for those that are left out.
fn presence(distance_m: f32, rank: f32) -> vec2<f32> {
    let share = min(1.0, grass.thins_from_m / max(distance_m, 1e-3));
    let kept = clamp((share * (1.0 + SOFT_RANKS) - rank) / SOFT_RANKS, 0.0, 1.0);
    let near = 1.0 - smoothstep(SHRINKS_FROM * grass.vanishes_at_m, grass.vanishes_at_m, distance_m);
    return vec2(kept * near, 1.0 / share);
}

fn swayed(in: Vertex, world_from_local: mat4x4<f32>, frames_ago: u32) -> Swayed {
    let root = (world_from_local * vec4(in.position, 1.0)).xyz;
    // The camera's place in the shadow pass, too.
    let present = presence(distance(root, view.lod_view_world_position), in.form.w);

    let wind = velocity_at(root, frames_ago) * patch_rotation(world_from_local);
    let time_s = select(frame.leaf_time.x, frame.leaf_time.y, frames_ago == 1u);
    let speed = length(wind.xz);
    let tip = blade::tip_bend(wind.xz, grass.half_bend_speed_m_s) + flutter(in.turn.w, time_s, speed);

    let shape = blade::Blade(in.position, in.form.x * present.x, in.turn.x, in.turn.y, in.turn.z);
    let joint = blade::joint_at(shape, tip, u32(in.uv.y + 0.5));
    let across = vec3(-sin(in.turn.x), 0.0, cos(in.turn.x));
    let side = normalize(across - joint.axis * dot(across, joint.axis));
    // Narrower towards the tip, first slowly.
    let s = in.uv.y / f32(blade::LINKS);
    let half_width = 0.5 * in.form.y * present.y * (1.0 - s * s) * min(1.0, 4.0 * present.x);
    return Swayed(joint.position + side * (in.uv.x * half_width), joint.axis, side);
}

// Soft: between the upper face of the blade, rounded to its sides, and the meadow as a whole.
fn soft_normal(in: Vertex, now: Swayed) -> vec3<f32> {
    let face = cross(now.axis, now.side);
    let upper = select(face, -face, face.y < 0.0);
    return normalize(vec3(0.0, 0.85, 0.0) + 0.8 * upper + 0.35 * in.uv.x * now.side);
}

fn colour(in: Vertex, now: Swayed) -> vec3<f32> {
    let s = in.uv.y / f32(blade::LINKS);
    let fresh = mix(grass.root_colour.rgb, grass.tip_colour.rgb, s);
    // Dry blades are dark at the root as well, where their neighbours shade them.
    let dry = grass.dry_colour.rgb * mix(0.2, 1.0, s);
    let own = 0.85 + 0.3 * fract(in.turn.w * 13.0);
    let sheen = 1.0 + SHEEN * s * (1.0 - now.axis.y);
    return own * sheen * mix(fresh, dry, in.form.z);
}

@vertex
fn vertex(in: Vertex) -> VertexOutput {
    var out: VertexOutput;
    let world_from_local = mesh_functions::get_world_from_local(in.instance_index);
    let now = swayed(in, world_from_local, 0u);

    out.world_position = world_from_local * vec4(now.position, 1.0);
    out.position = position_world_to_clip(out.world_position.xyz);
#ifdef UNCLIPPED_DEPTH_ORTHO_EMULATION
    out.unclipped_depth = out.position.z;
    out.position.z = min(out.position.z, 1.0);
#endif

#ifdef VERTEX_UVS_A
    out.uv = in.uv;
#endif

    let normal = patch_rotation(world_from_local) * soft_normal(in, now);
#ifdef PREPASS_PIPELINE
#ifdef NORMAL_PREPASS_OR_DEFERRED_PREPASS
    out.world_normal = normal;
#endif
#else
    out.world_normal = normal;
#endif

#ifdef VERTEX_COLORS
    out.color = vec4(colour(in, now), 1.0);
#endif

// The main pass knows of the motion vectors, too, but does not write them.
#ifdef PREPASS_PIPELINE
#ifdef MOTION_VECTOR_PREPASS
    let before_from_local = mesh_functions::get_previous_world_from_local(in.instance_index);
    let before = swayed(in, before_from_local, 1u);
    out.previous_world_position = before_from_local * vec4(before.position, 1.0);
#endif
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
