// The wind tables, and the wind that they hold anywhere at any time, as every shader of ours reads them.
//
// A material that imports this binds the tables of `StandTables` under the numbers below. The wind is that of one height
// (`SwaySettings::reference_height_m`, 10 m by default); nearer to the ground it is weaker, which is left to the reader.

#define_import_path bevy_windwood::wind

#import bevy_windwood::beam::Frame

@group(#{MATERIAL_BIND_GROUP}) @binding(103) var<storage, read> frame: Frame;
@group(#{MATERIAL_BIND_GROUP}) @binding(105) var<storage, read> wind_a: array<vec4<f32>>;
@group(#{MATERIAL_BIND_GROUP}) @binding(106) var<storage, read> wind_b: array<vec4<f32>>;

// Layout of a slot, in vec4: a header of HEADER rows, the direction map, the responses, the velocities.
// See `pack_slot` in `sway/rows.rs`.
const HEADER: u32 = 4u;

fn wind_row(slot: u32, index: u32) -> vec4<f32> {
    if slot == 0u {
        return wind_a[index];
    }
    return wind_b[index];
}

struct Slot {
    along: vec3<f32>,
    convective_speed_m_s: f32,
    across: vec3<f32>,
    column_spacing_m: f32,
    classes: u32,
    columns: u32,
    samples: u32,
    time_step_s: f32,
    map_size: u32,
    inverse_ln_class_ratio: f32,
}

fn slot_of(slot: u32) -> Slot {
    let a = wind_row(slot, 0u);
    let b = wind_row(slot, 1u);
    let c = wind_row(slot, 2u);
    let d = wind_row(slot, 3u);
    return Slot(a.xyz, a.w, b.xyz, b.w, u32(c.x), u32(c.y), u32(c.z), c.w, u32(d.x), d.y);
}

// The place of a tree in the periodic field: its lateral column, and its first sample and fraction in time.
struct Place {
    column: u32,
    sample: u32,
    fraction: f32,
}

fn place_of(wind: Slot, position: vec3<f32>, time_s: f32) -> Place {
    let columns = f32(wind.columns);
    let nearest = floor(dot(position, wind.across) / wind.column_spacing_m + 0.5);
    let column = nearest - columns * floor(nearest / columns);
    let samples = f32(wind.samples);
    let delayed = (time_s - dot(position, wind.along) / wind.convective_speed_m_s) / wind.time_step_s;
    let wrapped = delayed - samples * floor(delayed / samples);
    let sample = floor(wrapped);
    return Place(min(u32(column), wind.columns - 1u), u32(sample) % wind.samples, wrapped - sample);
}

// Periodic Catmull-Rom in time.
fn series_at(slot: u32, wind: Slot, first: u32, place: Place) -> vec4<f32> {
    let n = wind.samples;
    let p0 = wind_row(slot, first + (place.sample + n - 1u) % n);
    let p1 = wind_row(slot, first + place.sample);
    let p2 = wind_row(slot, first + (place.sample + 1u) % n);
    let p3 = wind_row(slot, first + (place.sample + 2u) % n);
    let f = place.fraction;
    return p1 + 0.5 * f * (p2 - p0 + f * (2.0 * p0 - 5.0 * p1 + 4.0 * p2 - p3 + f * (3.0 * (p1 - p2) + p3 - p0)));
}

// Responses of a class at a place; the class after the last holds the wind's velocity in wind coordinates, m/s.
fn response_at(slot: u32, wind: Slot, frequency_class: u32, place: Place) -> vec4<f32> {
    let map = HEADER + 4u * wind.map_size * wind.map_size;
    return series_at(slot, wind, map + (frequency_class * wind.columns + place.column) * wind.samples, place);
}

fn to_world(wind: Slot, v: vec3<f32>) -> vec3<f32> {
    return wind.along * v.x + vec3(0.0, v.y, 0.0) + wind.across * v.z;
}

// The texel of the hemi-octahedral map nearest to a unit direction in wind coordinates: see `direction_map.rs`.
fn direction_texel(size: u32, direction: vec3<f32>) -> u32 {
    let upward = select(direction, -direction, direction.y < 0.0);
    let flat = upward.xz / (abs(upward.x) + abs(upward.y) + abs(upward.z));
    let square = vec2(flat.x + flat.y, flat.x - flat.y);
    let place = vec2<u32>((square * 0.5 + 0.5) * f32(size - 1u) + 0.5);
    return min(place.y, size - 1u) * size + min(place.x, size - 1u);
}

// The static-equivalent wind pressure on a beam of that direction and class, m^2/s^2, in world axes.
fn pressure(slot: u32, wind: Slot, place: Place, direction: vec3<f32>, class_coordinate: f32) -> vec3<f32> {
    let seen = vec3(dot(direction, wind.along), direction.y, dot(direction, wind.across));
    let texel = HEADER + 4u * direction_texel(wind.map_size, seen);
    let c0 = wind_row(slot, texel);
    let c1 = wind_row(slot, texel + 1u);
    let c2 = wind_row(slot, texel + 2u);
    let c3 = wind_row(slot, texel + 3u);
    let frequency_class = u32(clamp(class_coordinate + 0.5, 0.0, f32(wind.classes - 1u)));
    let r = response_at(slot, wind, frequency_class, place);
    let q = vec3(c0.w, c1.w, c2.w) + c0.xyz * r.x + c1.xyz * r.y + c2.xyz * r.z + c3.xyz * r.w;
    return to_world(wind, q - seen * dot(q, seen));
}

fn slot_weight(slot: u32, frames_ago: u32) -> f32 {
    let blend = select(frame.blend.x, frame.blend.y, frames_ago == 1u);
    return select(1.0 - blend, blend, slot == 1u);
}

fn slot_time(slot: u32, frames_ago: u32) -> f32 {
    let time = select(frame.time.xy, frame.time.zw, frames_ago == 1u);
    return select(time.x, time.y, slot == 1u);
}

// Winds blow in one slot, or in two while one fades into another. Who reads them begins here and goes on while
// `blows_in` holds; such a loop, whose test is at its end, is run no more often than there are winds even by a processor
// that runs every branch. While there is no wind at all (`frame.ready` is 0) there is nothing to read.
fn first_slot(frames_ago: u32) -> u32 {
    return select(0u, 1u, slot_weight(0u, frames_ago) == 0.0);
}

fn blows_in(slot: u32, frames_ago: u32) -> bool {
    return slot < 2u && slot_weight(slot, frames_ago) > 0.0;
}

// Velocity of the air at a place in the world, m/s, in world axes, smooth across the wind; `frames_ago` is 0 or 1.
fn velocity_at(position: vec3<f32>, frames_ago: u32) -> vec3<f32> {
    var velocity = vec3(0.0);
    if frame.ready == 0u {
        return velocity;
    }
    var slot = first_slot(frames_ago);
    loop {
        let wind = slot_of(slot);
        let here = place_of(wind, position, slot_time(slot, frames_ago));
        // `here` is the nearest column: which side of it, and how far to that neighbour?
        let across = dot(position, wind.across) / wind.column_spacing_m;
        let offset = across - floor(across + 0.5);
        let step = select(1u, wind.columns - 1u, offset < 0.0);
        let there = Place((here.column + step) % wind.columns, here.sample, here.fraction);
        let share = smoothstep(0.0, 1.0, abs(offset));
        let near = response_at(slot, wind, wind.classes, here).xyz;
        let far = response_at(slot, wind, wind.classes, there).xyz;
        velocity += slot_weight(slot, frames_ago) * to_world(wind, mix(near, far, share));
        continuing {
            slot += 1u;
            break if !blows_in(slot, frames_ago);
        }
    }
    return velocity;
}
