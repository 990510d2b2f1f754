// Poses every beam of every tree from the response tables, once a frame, for all passes that draw.
//
// Two steps, one thread a beam: `find_tip_angles` reads the tables, `ride` walks from each beam down to the trunk and
// adds up what its ancestors do to it. Everything is a pure function of (time, place, tables).

#import bevy_windwood::beam::{BeamPose, BeamRow, Motion, NO_PARENT, TreeRow, bend, conjugate, rotate, tip_angle}
#import bevy_windwood::wind::{
    blows_in, first_slot, frame, place_of, pressure, response_at, slot_of, slot_time, slot_weight, to_world,
}

// The tables have the same binding numbers in every shader of ours, see `compute.rs`.
@group(#{MATERIAL_BIND_GROUP}) @binding(100) var<storage, read_write> poses: array<BeamPose>;
@group(#{MATERIAL_BIND_GROUP}) @binding(101) var<storage, read> beams: array<BeamRow>;
@group(#{MATERIAL_BIND_GROUP}) @binding(102) var<storage, read> trees: array<TreeRow>;
// What each workgroup poses: a tree's row in the low half, which of its chunks of beams in the high half. A place that is
// nobody's holds a chunk beyond the beams of any tree.
@group(#{MATERIAL_BIND_GROUP}) @binding(104) var<storage, read> chunks: array<u32>;

// Threads of a workgroup, and beams of a chunk; `CHUNK` in `sway/rows.rs`.
const WORKGROUP: u32 = 64u;
// Workgroups in the first dimension; `ACROSS` in `sway/compute.rs`.
const ACROSS: u32 = 256u;
// Deeper hierarchies are cut here rather than hang the graphics processor on a broken table.
const DEEPEST: u32 = 64u;

// What a thread works on: a tree, one of its beams (the one after the last stands for the wind), now or one frame ago.
struct Job {
    is_any: bool,
    tree: u32,
    beam: u32,
    frames_ago: u32,
    // First of the tree's poses in the half that belongs to `frames_ago`.
    first_pose: u32,
}

fn job_of(workgroup: vec3<u32>, thread: u32) -> Job {
    let number = workgroup.y * ACROSS + workgroup.x;
    let chunk = chunks[min(number, frame.chunk_count - 1u)];
    let tree = chunk & 0xffffu;
    let first = select(frame.poses_now, frame.poses_before, workgroup.z == 1u);
    let beam = (chunk >> 16u) * WORKGROUP + thread;
    return Job(number < frame.chunk_count, tree, beam, workgroup.z, first + trees[tree].first_pose);
}

@compute @workgroup_size(WORKGROUP)
fn find_tip_angles(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) thread: u32) {
    let job = job_of(workgroup, thread);
    let tree = trees[job.tree];
    if !job.is_any || tree.beam_count == 0u || job.beam > tree.beam_count {
        return;
    }
    let is_beam = job.beam < tree.beam_count;
    let row = beams[tree.first_beam + min(job.beam, tree.beam_count - 1u)];
    let direction = rotate(tree.rotation, row.direction);
    // In world axes: pressure for a beam, m^2/s^2; velocity for the wind, m/s.
    var felt = vec3(0.0);
    if frame.ready == 1u {
        var slot = first_slot(job.frames_ago);
        loop {
            let wind = slot_of(slot);
            let weight = slot_weight(slot, job.frames_ago);
            let place = place_of(wind, tree.position, slot_time(slot, job.frames_ago));
            if is_beam {
                // A tree scaled as a whole sways slower by its scale and bends by the same angles.
                let class_coordinate = row.class_coordinate - log(tree.scale) * wind.inverse_ln_class_ratio;
                felt += weight * pressure(slot, wind, place, direction, class_coordinate);
            } else {
                felt += weight * to_world(wind, response_at(slot, wind, wind.classes, place).xyz);
            }
            continuing {
                slot += 1u;
                break if !blows_in(slot, job.frames_ago);
            }
        }
    }
    let local = rotate(conjugate(tree.rotation), felt);
    let result = select(local, tip_angle(local, row.direction, row.gain), is_beam);
    poses[job.first_pose + job.beam].tip_angle = vec4(result, 0.0);
}

@compute @workgroup_size(WORKGROUP)
fn ride(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) thread: u32) {
    let job = job_of(workgroup, thread);
    let tree = trees[job.tree];
    if !job.is_any || job.beam >= tree.beam_count {
        return;
    }
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
