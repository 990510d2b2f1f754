// Poses every beam of every tree from the response tables, once a frame, for all passes that draw.
//
// Two steps, one thread a beam: `find_tip_angles` reads the tables, `ride` walks from each beam down to the trunk and
// adds up what its ancestors do to it. Everything is a pure function of (time, place, tables).

#import bevy_windwood::beam::{BeamPose, BeamRow, Frame, Motion, NO_PARENT, TreeRow, bend, conjugate, rotate, tip_angle}

@group(0) @binding(0) var<storage, read> wind_a: array<vec4<f32>>;
@group(0) @binding(1) var<storage, read> wind_b: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read> beams: array<BeamRow>;
@group(0) @binding(3) var<storage, read> trees: array<TreeRow>;
@group(0) @binding(4) var<storage, read> frame: Frame;
@group(0) @binding(5) var<storage, read_write> poses: array<BeamPose>;

// Threads of a workgroup; `WORKGROUP` in `sway/compute.rs`.
const WORKGROUP: u32 = 64u;
// Deeper hierarchies are cut here rather than hang the graphics processor on a broken table.
const DEEPEST: u32 = 64u;

// ---- the wind tables ------------------------------------------------------------------------------------------------

// Layout of a slot, in vec4: a header of HEADER rows, the direction map, the responses, the velocities.
// See `slot_rows` in `sway/rows.rs`.
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

// The texel of the hemi-octahedral map nearest to a unit direction in wind coordinates: see `direction_map.rs`.
fn direction_texel(size: u32, direction: vec3<f32>) -> u32 {
    let upward = select(direction, -direction, direction.y < 0.0);
    let flat = upward.xz / (abs(upward.x) + abs(upward.y) + abs(upward.z));
    let square = vec2(flat.x + flat.y, flat.x - flat.y);
    let place = vec2<u32>((square * 0.5 + 0.5) * f32(size - 1u) + 0.5);
    return min(place.y, size - 1u) * size + min(place.x, size - 1u);
}

fn to_world(wind: Slot, v: vec3<f32>) -> vec3<f32> {
    return wind.along * v.x + vec3(0.0, v.y, 0.0) + wind.across * v.z;
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

// ---- the two steps --------------------------------------------------------------------------------------------------

// What a thread works on: a tree, one of its beams (the one after the last stands for the wind), now or one frame ago.
struct Job {
    tree: u32,
    beam: u32,
    frames_ago: u32,
    // First of the tree's poses in the half that belongs to `frames_ago`.
    first_pose: u32,
}

fn job_of(id: vec3<u32>) -> Job {
    let first = select(frame.poses_now, frame.poses_before, id.z == 1u);
    return Job(id.y, id.x, id.z, first + trees[min(id.y, frame.tree_count - 1u)].first_pose);
}

fn slot_weight(slot: u32, frames_ago: u32) -> f32 {
    let blend = select(frame.blend.x, frame.blend.y, frames_ago == 1u);
    return select(1.0 - blend, blend, slot == 1u);
}

fn slot_time(slot: u32, frames_ago: u32) -> f32 {
    let time = select(frame.time.xy, frame.time.zw, frames_ago == 1u);
    return select(time.x, time.y, slot == 1u);
}

@compute @workgroup_size(WORKGROUP)
fn find_tip_angles(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.y >= frame.tree_count || id.x > trees[id.y].beam_count {
        return;
    }
    let job = job_of(id);
    let tree = trees[job.tree];
    let is_beam = job.beam < tree.beam_count;
    let row = beams[tree.first_beam + min(job.beam, tree.beam_count - 1u)];
    let direction = rotate(tree.rotation, row.direction);
    // In world axes: pressure for a beam, m^2/s^2; velocity for the wind, m/s.
    var felt = vec3(0.0);
    for (var slot = 0u; slot < 2u; slot += 1u) {
        let weight = slot_weight(slot, job.frames_ago) * f32(frame.ready);
        if weight > 0.0 {
            let wind = slot_of(slot);
            let place = place_of(wind, tree.position, slot_time(slot, job.frames_ago));
            if is_beam {
                // A tree scaled as a whole sways slower by its scale and bends by the same angles.
                let class_coordinate = row.class_coordinate - log(tree.scale) * wind.inverse_ln_class_ratio;
                felt += weight * pressure(slot, wind, place, direction, class_coordinate);
            } else {
                felt += weight * to_world(wind, response_at(slot, wind, wind.classes, place).xyz);
            }
        }
    }
    let local = rotate(conjugate(tree.rotation), felt);
    let result = select(local, tip_angle(local, row.direction, row.gain), is_beam);
    poses[job.first_pose + job.beam].tip_angle = vec4(result, 0.0);
}

@compute @workgroup_size(WORKGROUP)
fn ride(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.y >= frame.tree_count || id.x >= trees[id.y].beam_count {
        return;
    }
    let job = job_of(id);
    let tree = trees[job.tree];
    var motion = Motion(vec3(0.0), vec4(0.0, 0.0, 0.0, 1.0));
    var row = beams[tree.first_beam + job.beam];
    for (var depth = 0u; depth < DEEPEST && row.parent != NO_PARENT; depth += 1u) {
        let parent = beams[tree.first_beam + row.parent];
        motion = bend(parent, poses[job.first_pose + row.parent].tip_angle.xyz, row.attach, motion);
        row = parent;
    }
    poses[job.first_pose + job.beam].rotation = motion.rotation;
    poses[job.first_pose + job.beam].translation = vec4(motion.position, 0.0);
}
