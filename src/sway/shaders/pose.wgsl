// The pose of a tree in the wind: the twin of `dynamics/pose.rs`, `dynamics/direction_map.rs` and `dynamics/leaf.rs`.
//
// NOTE FOR CONVENTIONS
// - Tree-local space: y up, metres, the tree's root at the origin, its rest shape.
// - Wind coordinates: x along the mean wind, y up, z across (along x up).
// - `s`: position along a beam, 0 at its root, 1 at its tip.
// - A tip angle is a vector: its direction is where the tip leans (perpendicular to the beam), its length radians.
// - Everything is a pure function of (time, place, tables), so that the pose one frame ago costs one more call.

#define_import_path bevy_windwood::pose

// One row of the beam table, see `BeamRow` in `sway/rows.rs`.
struct BeamRow {
    // xyz: root of the beam at rest, m; w: length, m.
    base: vec4<f32>,
    // xyz: unit direction at rest; w: place on the parent beam where this one starts, 0..1.
    direction: vec4<f32>,
    // Tip deflection over length for one m^2/s^2 of wind pressure, s^2/m^2.
    gain: f32,
    // Frequency class as a real number, before rounding.
    class_coordinate: f32,
    // Row of the parent within the model, NO_PARENT for a trunk.
    parent: u32,
    padding: u32,
}

// The clock of one frame, see `FrameRow` in `sway/rows.rs`. A wind is one of two slots; `blend` fades from A to B.
struct Frame {
    // x, y: now in the periods of slot A and B; z, w: one frame ago; s.
    time: vec4<f32>,
    // x: now, y: one frame ago; 0 is all slot A, 1 all slot B.
    blend: vec2<f32>,
    // x: now, y: one frame ago, in the period of the leaves' flutter, s.
    leaf_time: vec2<f32>,
    // 0 until the first wind is there: trees stand at rest.
    ready: f32,
    padding_x: f32,
    padding_y: f32,
    padding_z: f32,
}

@group(#{MATERIAL_BIND_GROUP}) @binding(100) var<storage, read> wind_a: array<vec4<f32>>;
@group(#{MATERIAL_BIND_GROUP}) @binding(101) var<storage, read> wind_b: array<vec4<f32>>;
@group(#{MATERIAL_BIND_GROUP}) @binding(102) var<storage, read> beams: array<BeamRow>;
@group(#{MATERIAL_BIND_GROUP}) @binding(103) var<storage, read> frame: Frame;

const NO_PARENT: u32 = 0xffffffffu;
// Deeper hierarchies are cut here rather than hang the graphics processor on a broken table.
const DEEPEST: u32 = 32u;

// One instance: where it stands and how the wind sees it.
struct Instance {
    // Columns: the tree's axes in the world, divided by its scale.
    rotation: mat3x3<f32>,
    position: vec3<f32>,
    scale: f32,
    // First row of its model in `beams`.
    first_beam: u32,
}

// A rigid motion of rest space.
struct Motion {
    position: vec3<f32>,
    rotation: vec4<f32>,
}

fn instance_from_matrix(world_from_local: mat4x4<f32>, first_beam: u32) -> Instance {
    let scale = max(length(world_from_local[1].xyz), 1e-6);
    let axes = mat3x3(world_from_local[0].xyz, world_from_local[1].xyz, world_from_local[2].xyz);
    return Instance(axes * (1.0 / scale), world_from_local[3].xyz, scale, first_beam);
}

fn rotate(rotation: vec4<f32>, v: vec3<f32>) -> vec3<f32> {
    return v + 2.0 * cross(rotation.xyz, cross(rotation.xyz, v) + rotation.w * v);
}

fn then(first: vec4<f32>, second: vec4<f32>) -> vec4<f32> {
    return vec4(
        second.w * first.xyz + first.w * second.xyz + cross(second.xyz, first.xyz),
        second.w * first.w - dot(second.xyz, first.xyz),
    );
}

// ---- the wind tables ------------------------------------------------------------------------------------------------

// Layout of a slot, in vec4: a header of HEADER rows, the direction map, the responses, the velocities.
// See `SlotRows` in `sway/rows.rs`.
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
    return Slot(
        a.xyz, a.w, b.xyz, b.w,
        u32(c.x), u32(c.y), u32(c.z), c.w,
        u32(d.x), d.y,
    );
}

// The place of an instance in the periodic field: its lateral column, and its first sample and fraction in time.
struct Place {
    column: u32,
    sample: u32,
    fraction: f32,
}

fn place_of(wind: Slot, position: vec3<f32>, time_s: f32) -> Place {
    let columns = f32(wind.columns);
    let nearest = round(dot(position, wind.across) / wind.column_spacing_m);
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

fn response_at(slot: u32, wind: Slot, frequency_class: u32, place: Place) -> vec4<f32> {
    let first = HEADER + 4u * wind.map_size * wind.map_size
        + (frequency_class * wind.columns + place.column) * wind.samples;
    return series_at(slot, wind, first, place);
}

// Wind velocity at the reference height in wind coordinates (xyz) and its speed (w), m/s.
fn velocity_at(slot: u32, wind: Slot, place: Place) -> vec4<f32> {
    let first = HEADER + 4u * wind.map_size * wind.map_size
        + (wind.classes * wind.columns + place.column) * wind.samples;
    return series_at(slot, wind, first, place);
}

// The texel of the hemi-octahedral map nearest to a unit direction in wind coordinates: see `direction_map.rs`.
fn direction_texel(size: u32, direction: vec3<f32>) -> u32 {
    let upward = select(direction, -direction, direction.y < 0.0);
    let flat = upward.xz / (abs(upward.x) + abs(upward.y) + abs(upward.z));
    let square = vec2(flat.x + flat.y, flat.x - flat.y);
    let place = vec2<u32>((square * 0.5 + 0.5) * f32(size - 1u) + 0.5);
    return min(place.y, size - 1u) * size + min(place.x, size - 1u);
}

// The static-equivalent wind pressure on a beam, m^2/s^2, in world axes, for one slot.
fn pressure_in_slot(slot: u32, wind: Slot, place: Place, direction: vec3<f32>, class_coordinate: f32) -> vec3<f32> {
    let seen = vec3(dot(direction, wind.along), direction.y, dot(direction, wind.across));
    let texel = HEADER + 4u * direction_texel(wind.map_size, seen);
    let c0 = wind_row(slot, texel);
    let c1 = wind_row(slot, texel + 1u);
    let c2 = wind_row(slot, texel + 2u);
    let c3 = wind_row(slot, texel + 3u);
    let frequency_class = u32(clamp(class_coordinate + 0.5, 0.0, f32(wind.classes - 1u)));
    let response = response_at(slot, wind, frequency_class, place);
    let q = vec3(c0.w, c1.w, c2.w)
        + c0.xyz * response.x + c1.xyz * response.y + c2.xyz * response.z + c3.xyz * response.w;
    return wind.along * q.x + vec3(0.0, q.y, 0.0) + wind.across * q.z;
}

// ---- a beam ---------------------------------------------------------------------------------------------------------

const SLOPE_TIP: f32 = 1.3765054;
const TIP_ANGLE_LIMIT: f32 = 1.1;
const MODE_SHAPE = array<vec4<f32>, 7>(
    vec4(2.546882, -1.6781346, -0.2758867, 0.4069252),
    vec4(1.2742649, -0.56341205, -0.06274729, 0.07835665),
    vec4(2.1950821, -2.357947, 0.80684225, -0.03069512),
    vec4(4.209066, -7.1503183, 4.4999294, -1.0119247),
    vec4(8.117791, -17.585144, 13.848035, -3.8794978),
    vec4(15.02049, -37.190565, 32.597094, -9.95987),
    vec4(26.275351, -70.26942, 65.27605, -20.841745),
);

// Tip angle of a beam from the wind pressure across it: linear for a breeze, saturating in a storm.
fn tip_angle(pressure: vec3<f32>, direction: vec3<f32>, gain: f32) -> vec3<f32> {
    let across = pressure - direction * dot(pressure, direction);
    let free = across * (SLOPE_TIP * gain);
    return free * inverseSqrt(1.0 + dot(free, free) / (TIP_ANGLE_LIMIT * TIP_ANGLE_LIMIT));
}

// How the cross-section at `s` carries a point of rest space with it.
fn bend(row: BeamRow, angle: vec3<f32>, s: f32, point: vec3<f32>, rotation: ptr<function, vec4<f32>>) -> vec3<f32> {
    let s2 = s * s;
    let powers = vec4(1.0, s, s2, s2 * s);
    let h = s * dot(MODE_SHAPE[0], powers);
    let h1 = s2 * dot(MODE_SHAPE[1], powers);
    let h2 = s2 * s * dot(MODE_SHAPE[2], powers);
    let h3 = s2 * s2 * dot(MODE_SHAPE[3], powers);
    let h4 = s2 * s2 * s * dot(MODE_SHAPE[4], powers);
    let h5 = s2 * s2 * s2 * dot(MODE_SHAPE[5], powers);
    let h6 = s2 * s2 * s2 * s * dot(MODE_SHAPE[6], powers);
    let t = dot(angle, angle);
    let forward = s - t * (h2 / 2.0 - t * (h4 / 24.0 - t * h6 / 720.0));
    let sideways = h1 - t * (h3 / 6.0 - t * h5 / 120.0);
    let direction = row.direction.xyz;
    let bent = row.base.xyz + row.base.w * (direction * forward + angle * sideways);

    let half = cross(direction, angle) * (0.5 * h);
    let x = dot(half, half);
    let turn = normalize(vec4(half * (1.0 - x / 6.0 + x * x / 120.0), 1.0 - x / 2.0 + x * x / 24.0 - x * x * x / 720.0));
    let arm = point - (row.base.xyz + row.base.w * s * direction);
    *rotation = then(*rotation, turn);
    return bent + rotate(turn, arm);
}

// ---- a tree ---------------------------------------------------------------------------------------------------------

// What the wind is at one moment for one instance; read once, used for every beam of the chain.
struct Moment {
    a: Slot,
    b: Slot,
    place_a: Place,
    place_b: Place,
    blend: f32,
}

// `frames_ago` is 0 for now, 1 for the frame before.
fn moment(instance: Instance, frames_ago: u32) -> Moment {
    let time = select(frame.time.xy, frame.time.zw, frames_ago == 1u);
    let blend = select(frame.blend.x, frame.blend.y, frames_ago == 1u);
    let a = slot_of(0u);
    let b = slot_of(1u);
    return Moment(a, b, place_of(a, instance.position, time.x), place_of(b, instance.position, time.y), blend);
}

fn pressure(at: Moment, scale: f32, direction: vec3<f32>, class_coordinate: f32) -> vec3<f32> {
    // A tree scaled as a whole sways slower by its scale and bends by the same angles.
    var q = vec3(0.0);
    if at.blend < 1.0 {
        let class_a = class_coordinate - log(scale) * at.a.inverse_ln_class_ratio;
        q += (1.0 - at.blend) * pressure_in_slot(0u, at.a, at.place_a, direction, class_a);
    }
    if at.blend > 0.0 {
        let class_b = class_coordinate - log(scale) * at.b.inverse_ln_class_ratio;
        q += at.blend * pressure_in_slot(1u, at.b, at.place_b, direction, class_b);
    }
    return q;
}

// Wind at the tree at the reference height, world axes, m/s.
fn wind_velocity(at: Moment) -> vec3<f32> {
    var velocity = vec3(0.0);
    if frame.ready == 0.0 {
        return velocity;
    }
    if at.blend < 1.0 {
        let v = velocity_at(0u, at.a, at.place_a);
        velocity += (1.0 - at.blend) * (at.a.along * v.x + vec3(0.0, v.y, 0.0) + at.a.across * v.z);
    }
    if at.blend > 0.0 {
        let v = velocity_at(1u, at.b, at.place_b);
        velocity += at.blend * (at.b.along * v.x + vec3(0.0, v.y, 0.0) + at.b.across * v.z);
    }
    return velocity;
}

// The clock of the leaves' flutter, s.
fn leaf_seconds(frames_ago: u32) -> f32 {
    return select(frame.leaf_time.x, frame.leaf_time.y, frames_ago == 1u);
}

// Carries a rest point bound at `s` on `beam` to where the wind bends it, with the rotation of its surroundings.
fn pose_point(instance: Instance, at: Moment, beam: u32, s: f32, point: vec3<f32>) -> Motion {
    var motion = Motion(point, vec4(0.0, 0.0, 0.0, 1.0));
    if frame.ready == 0.0 {
        return motion;
    }
    var index = beam;
    var place = s;
    for (var depth = 0u; depth < DEEPEST && index != NO_PARENT; depth += 1u) {
        let row = beams[instance.first_beam + index];
        let direction = instance.rotation * row.direction.xyz;
        let q = pressure(at, instance.scale, direction, row.class_coordinate);
        let angle = tip_angle(q * instance.rotation, row.direction.xyz, row.gain);
        motion.position = bend(row, angle, place, motion.position, &motion.rotation);
        place = row.direction.w;
        index = row.parent;
    }
    return motion;
}
