// Draws a fire: flames that rise, swell and lean, a bed of embers, sparks, and the glow around all. Everything is a pure
// function of time, place and seed, seamless over the period of our rhythms.
//
// `WINDWOOD_WIND` is defined where the wind tables can be read.

#import bevy_pbr::mesh_functions
#import bevy_pbr::mesh_view_bindings::{globals, view}
#import bevy_pbr::view_transformations::position_world_to_clip

#ifdef WINDWOOD_WIND
#import bevy_windwood::wind::{frame, velocity_at}
#endif

#ifdef TONEMAP_IN_SHADER
#import bevy_core_pipeline::tonemapping::tone_mapping
#endif

struct Vertex {
    @builtin(instance_index) instance_index: u32,
    // Start of the longest diagonal, m.
    @location(0) position: vec3<f32>,
    // x: across, -1..1; y: along, 0..1.
    @location(2) uv: vec2<f32>,
    // xyz: the longest diagonal, w: half of the shortest, m.
    @location(8) flame: vec4<f32>,
    // Kind; phase, 0..1; size as a share of the whole; order.
    @location(9) own: vec4<f32>,
}

struct VertexOutput {
    @builtin(position) position: vec4<f32>,
    @location(0) uv: vec2<f32>,
    // Kind, phase, strength, length over breadth.
    @location(1) own: vec4<f32>,
    // Height as a share of the fire's.
    @location(2) height: f32,
}

struct Fire {
    inner_colour: vec4<f32>,
    outer_colour: vec4<f32>,
    // Of the flicker: whole cycles in the period, w: depth; phases, w: the period, s.
    cycles_and_depth: vec4<f32>,
    phases_and_period: vec4<f32>,
    luminance_cd_m2: f32,
    height_m: f32,
    // Wind at the fire over the wind of the tables.
    exposure: f32,
    glow: f32,
    // Whole cycles of the rise in the period.
    rise_cycles: f32,
    size_m: f32,
    padding: vec2<f32>,
}

@group(#{MATERIAL_BIND_GROUP}) @binding(100) var<uniform> fire: Fire;

const BED: f32 = 0.0;
const TONGUE: f32 = 1.0;
const SPARK: f32 = 2.0;
const GLOW: f32 = 3.0;

const TURN: f32 = 6.283185307179586;
// Speed on the axis of a flame is this times the root of the height in metres (McCaffrey 1979), m^(1/2)/s.
const BUOYANT_SPEED: f32 = 6.8;
// `WEIGHTS` of `fire/flicker.rs`; a test holds them equal.
const WEIGHTS: vec3<f32> = vec3(0.3, 0.45, 0.25);
// Flames rise out of the fuel, in whose shelter they have gathered speed: from so far below, in heights of the fire.
const SHELTER: f32 = 0.12;
// Fuel lies about, so the fire is this much wider at its foot; air that is drawn in from all sides narrows it at its top.
const FOOT: f32 = 1.5;
const NECK: f32 = 0.5;
// Sparks fly so many heights of the fire, in so many seconds.
const SPARK_RISE: f32 = 2.6;
const SPARK_LIFE_S: f32 = 2.4;

// The share of the period that has gone by, 0..1.
fn clock() -> f32 {
#ifdef WINDWOOD_WIND
    return frame.leaf_time.x / fire.phases_and_period.w;
#else
    return fract(globals.time / fire.phases_and_period.w);
#endif
}

// `Flicker::level`.
fn flicker() -> f32 {
    let turns = fract(fire.cycles_and_depth.xyz * clock() + fire.phases_and_period.xyz);
    return 1.0 + fire.cycles_and_depth.w * dot(WEIGHTS, sin(TURN * turns));
}

// Turns of a rhythm that has about `ratio` cycles for each puff, 0..1.
fn turns(ratio: f32, phase: f32) -> f32 {
    return fract(round(ratio * fire.rise_cycles) * clock() + phase);
}

fn wind_here(world_from_local: mat4x4<f32>) -> vec3<f32> {
#ifdef WINDWOOD_WIND
    return fire.exposure * velocity_at(world_from_local[3].xyz, 0u);
#else
    return vec3(0.0);
#endif
}

// Where the flames carry what would be at `place` in still air that does not move: drawn in, waving, leaning.
// A parcel that rises with c sqrt(y) in a wind U has gone 2 U (sqrt(y) - sqrt(y_0)) / c to leeward since it was at y_0.
fn carried(place: vec3<f32>, wind: vec3<f32>, phase: f32) -> vec3<f32> {
    let share = max(place.y, 0.0) / fire.height_m;
    let drawn = place.xz * mix(FOOT, NECK, smoothstep(0.0, 1.0, share));
    let wave = 0.07 * fire.height_m * pow(share, 1.2);
    let slow = TURN * (1.3 * share - vec2(turns(0.9, 0.13), turns(0.7, 0.57)));
    let fast = TURN * (2.7 * share - vec2(turns(1.7, phase), turns(2.1, phase * 3.0)));
    let waving = wave * (sin(slow) + 0.8 * sin(fast));
    let origin = SHELTER * fire.height_m;
    let leaning = wind.xz * (2.0 * (sqrt(max(place.y, 0.0) + origin) - sqrt(origin)) / BUOYANT_SPEED);
    let flat = drawn + waving + leaning;
    return vec3(flat.x, place.y, flat.y);
}

struct Flame {
    // In the world.
    position: vec3<f32>,
    strength: f32,
    // Half the breadth, m.
    breadth: f32,
    // How it runs there, for the breadth to be square to.
    along: vec3<f32>,
}

// A tongue: the first ones stand and stretch, their copies rise out of them, swell and go.
fn tongue(in: Vertex, wind: vec3<f32>) -> Flame {
    let phase = in.own.y;
    let puff = 0.5 + 0.5 * sin(TURN * turns(0.8 + 0.6 * phase, phase));
    var foot = in.position;
    var along = in.flame.xyz;
    // There are only three of them, and they are large: they are the dim body in which the others burn.
    var strength = 0.35 + 0.25 * puff;
    var swell = 0.75 + 0.3 * puff;
    if in.own.w > 0.5 {
        let life = turns(0.55 + 0.5 * phase, phase * 5.0);
        let bow = sin(0.5 * TURN * life);
        foot += vec3(0.0, 1.0, 0.0) * (0.8 * length(along) * (life - 0.35));
        strength = bow * bow;
        swell = 0.45 + 0.65 * bow;
    }
    foot.y = max(foot.y, 0.0);
    // The first tongues stand about the bed, each where it leans; flames stand steeper than the rhombs they grow on.
    foot += vec3(along.x, 0.0, along.z) * select(0.1, 0.45, in.own.w < 0.5);
    along = mix(along, vec3(0.0, length(along), 0.0), 0.5) * swell;
    let here = carried(foot + along * in.uv.y, wind, phase);
    let ahead = carried(foot + along * (in.uv.y + 0.05), wind, phase);
    return Flame(here, strength * flicker(), in.flame.w * (0.6 + 0.5 * swell), ahead - here);
}

// A spark rises, is carried off by the wind, spirals, and dies.
fn spark(in: Vertex, wind: vec3<f32>) -> Flame {
    let phase = in.own.y;
    let cycles = round(fire.phases_and_period.w / (SPARK_LIFE_S * (0.7 + 0.6 * phase)));
    let life = fract(cycles * clock() + phase * 9.0);
    let age_s = life * fire.phases_and_period.w / cycles;
    let spin = TURN * (2.0 * life * (phase - 0.5) + phase * 31.0);
    let wide = fire.size_m * (0.1 + 0.3 * life);
    let up = SPARK_RISE * fire.height_m * life * (0.5 + 0.5 * fract(phase * 17.0));
    let place = in.position + vec3(cos(spin) * wide, up, sin(spin) * wide) + 0.6 * wind * age_s;
    let blink = 0.6 + 0.4 * sin(TURN * turns(6.0, phase));
    return Flame(place, (1.0 - life) * blink * smoothstep(0.0, 0.1, life), in.flame.w, vec3(0.0, 1.0, 0.0));
}

@vertex
fn vertex(in: Vertex) -> VertexOutput {
    let world_from_local = mesh_functions::get_world_from_local(in.instance_index);
    let scale = length(world_from_local[1].xyz);
    let wind = wind_here(world_from_local) * mat3x3(
        normalize(world_from_local[0].xyz),
        normalize(world_from_local[1].xyz),
        normalize(world_from_local[2].xyz),
    );
    let kind = in.own.x;
    var flame: Flame;
    if kind == BED {
        flame = Flame(in.position + in.flame.xyz * in.uv.y, flicker(), in.flame.w, vec3(0.0));
    } else if kind == TONGUE {
        flame = tongue(in, wind);
    } else if kind == SPARK {
        flame = spark(in, wind);
    } else {
        flame = Flame(carried(in.position, wind, 0.0), flicker(), in.flame.w, vec3(0.0));
    }

    let centre = world_from_local * vec4(flame.position, 1.0);
    let to_eye = normalize(view.world_position - centre.xyz);
    var corner = centre.xyz;
    if kind == BED {
        corner += (world_from_local * vec4(0.0, 0.0, in.uv.x * flame.breadth, 0.0)).xyz;
        corner += world_from_local[1].xyz * 0.02 * fire.size_m;
    } else if kind == TONGUE {
        let along = (world_from_local * vec4(flame.along, 0.0)).xyz;
        let side = cross(along, to_eye);
        corner += side * (in.uv.x * flame.breadth * scale / max(length(side), 1e-5));
    } else {
        // Sparks never become narrower than a pixel or so, or they would vanish.
        let pixel = 1.2 * distance(view.world_position, centre.xyz) * abs(view.view_from_clip[1][1]) / view.viewport.w;
        let breadth = max(flame.breadth * scale, select(0.0, pixel, kind == SPARK));
        let right = normalize(cross(vec3(0.0, 1.0, 0.0), to_eye));
        corner += breadth * (right * in.uv.x + cross(to_eye, right) * (2.0 * in.uv.y - 1.0));
    }

    var out: VertexOutput;
    out.position = position_world_to_clip(corner);
    out.uv = in.uv;
    out.own = vec4(kind, in.own.y, flame.strength, 0.5 * length(in.flame.xyz) / max(in.flame.w, 1e-5));
    out.height = flame.position.y / fire.height_m;
    return out;
}

// ---- what a flame looks like ----------------------------------------------------------------------------------------

// A well-mixed number from 0 to 1 for a cell of a lattice (the finaliser of Wellons' lowbias32).
fn hashed(cell: vec2<u32>) -> f32 {
    var x = cell.x * 0x9e3779b9u + cell.y * 0x85ebca6bu;
    x ^= x >> 16u;
    x *= 0x7feb352du;
    x ^= x >> 15u;
    x *= 0x846ca68bu;
    x ^= x >> 16u;
    return f32(x >> 8u) / 16777216.0;
}

// Smooth noise, 0..1, which repeats itself after `rows` in y.
fn noise(at: vec2<f32>, rows: f32) -> f32 {
    let cell = floor(at);
    let f = smoothstep(vec2(0.0), vec2(1.0), at - cell);
    let y0 = cell.y - rows * floor(cell.y / rows);
    let y1 = cell.y + 1.0 - rows * floor((cell.y + 1.0) / rows);
    let x = vec2<u32>(u32(cell.x + 4096.0), u32(cell.x + 4097.0));
    let low = mix(hashed(vec2(x.x, u32(y0))), hashed(vec2(x.y, u32(y0))), f.x);
    let high = mix(hashed(vec2(x.x, u32(y1))), hashed(vec2(x.y, u32(y1))), f.x);
    return mix(low, high, f.y);
}

// Two octaves that stream upward past a tongue.
fn streams(uv: vec2<f32>, phase: f32) -> f32 {
    let rows = max(round(1.6 * fire.rise_cycles), 1.0);
    let at = vec2(1.1 * uv.x + 61.0 * phase, 1.8 * uv.y - rows * clock() + 17.0 * phase);
    return 0.62 * noise(at, rows) + 0.38 * noise(2.0 * at + 7.0, 2.0 * rows);
}

@fragment
fn fragment(in: VertexOutput) -> @location(0) vec4<f32> {
    let kind = in.own.x;
    let u = in.uv.x;
    let v = in.uv.y;
    var amount = 0.0;
    var heat = 0.0;
    if kind < 0.5 {
        heat = min(1.0, abs(u) + abs(2.0 * v - 1.0));
        let coals = noise(vec2(5.0 * u + 40.0, 7.0 * v), 64.0) * noise(vec2(11.0 * u + 90.0, 13.0 * v), 64.0);
        amount = 1.6 * (1.0 - heat) * smoothstep(0.05, 0.5, coals);
        heat = 0.3 * heat;
    } else if kind < 1.5 {
        heat = v;
        // Broadest below the middle, pointed above: a rhomb with its corners rounded off.
        let outline = 1.75 * pow(v + 0.02, 0.5) * (1.0 - v);
        let body = smoothstep(0.0, 0.9, 1.0 - abs(u) / max(outline, 1e-3));
        let stream = streams(in.uv, in.own.y);
        amount = body * smoothstep(0.22 + 0.3 * v, 0.62 + 0.3 * v, stream + 0.12) * (1.0 - 0.6 * clamp(in.height, 0.0, 1.0));
    } else if kind < 2.5 {
        amount = 6.0 * max(0.0, 1.0 - length(vec2(u, 2.0 * v - 1.0)));
        heat = 0.6;
    } else {
        let r = length(vec2(u, 2.0 * v - 1.0));
        let fade = max(0.0, 1.0 - r);
        amount = 0.12 * fire.glow * fade * fade * fade;
        heat = 0.35;
    }
    let colour = mix(fire.inner_colour.rgb, fire.outer_colour.rgb, heat);
    let luminance = fire.luminance_cd_m2 * max(amount, 0.0) * in.own.z;
    // Additive: no alpha, so nothing of what is behind is taken away.
    var out = vec4(colour * (luminance * view.exposure), 0.0);
#ifdef TONEMAP_IN_SHADER
    out = tone_mapping(out, view.color_grading);
    out.a = 0.0;
#endif
    return out;
}
