// A bent beam and what rides on it: the twin of `dynamics/pose.rs`, which derives the formulas.
//
// NOTE FOR CONVENTIONS, for all our shaders
// - Tree-local space: y up, metres, the tree's root at the origin, its rest shape.
// - Wind coordinates: x along the mean wind, y up, z across (along x up).
// - `s`: position along a beam, 0 at its root, 1 at its tip.
// - A tip angle is a vector: its direction is where the tip leans (perpendicular to the beam), its length radians.
// - Rotations are unit quaternions, xyz and w.

#define_import_path bevy_windwood::beam

// One row of the beam table, see `BeamRow` in `sway/rows.rs`.
struct BeamRow {
    // Root of the beam at rest, m.
    base: vec3<f32>,
    length_m: f32,
    // Unit direction at rest.
    direction: vec3<f32>,
    // Place on the parent beam where this one starts, 0..1.
    attach: f32,
    // Tip deflection over length for one m^2/s^2 of wind pressure, s^2/m^2.
    gain: f32,
    // Frequency class as a real number, before rounding.
    class_coordinate: f32,
    // Row of the parent within the model, NO_PARENT for a trunk.
    parent: u32,
    padding: u32,
}

// One tree, see `TreeRow` in `sway/rows.rs`.
struct TreeRow {
    // Turn of the tree in the world.
    rotation: vec4<f32>,
    position: vec3<f32>,
    scale: f32,
    // First row of its model in the beam table, and their number: 0 while it is not posed, has no poses and is at rest.
    first_beam: u32,
    beam_count: u32,
    // First of its poses; one a beam, and one more that holds the wind at the tree.
    first_pose: u32,
    // Low half: how far it is ahead of the season; high half: its height. See `season_shift` and `height_m`.
    season_and_height: u32,
}

// How a beam is bent, and the rigid motion that its ancestors give to its rest frame.
struct BeamPose {
    tip_angle: vec4<f32>,
    rotation: vec4<f32>,
    translation: vec4<f32>,
}

// The pose of a beam at rest.
fn at_rest() -> BeamPose {
    return BeamPose(vec4(0.0), vec4(0.0, 0.0, 0.0, 1.0), vec4(0.0));
}

// The clock of one frame, see `FrameRow` in `sway/rows.rs`. A wind is one of two slots; `blend` fades from A to B.
struct Frame {
    // x, y: now in the periods of slot A and B; z, w: one frame ago; s.
    time: vec4<f32>,
    // x: now, y: one frame ago; 0 is all slot A, 1 all slot B.
    blend: vec2<f32>,
    // x: now, y: one frame ago, in the period of the leaves' flutter, s.
    leaf_time: vec2<f32>,
    // First pose of this frame's half and of the last frame's.
    poses_now: u32,
    poses_before: u32,
    // 0 until the first wind is there: trees stand at rest.
    ready: u32,
    // Of the beams that are posed: `PoseChunk` of `pose.wgsl`.
    chunk_count: u32,
    // Time of the year, 0..1.
    year: f32,
    // Where levels 0, 1 and 2 of a tree end, for each metre of its height.
    level_0_end: f32,
    level_1_end: f32,
    level_2_end: f32,
    // Nowhere nearer than this do cards stand for trees, m.
    cards_from_m: f32,
    // Over this share of a distance, to either side, levels fade.
    fade: f32,
    padding_a: f32,
    padding_b: f32,
}

// How far a tree is ahead of the season, in years.
fn season_shift(tree: TreeRow) -> f32 {
    return (f32(tree.season_and_height & 0xffffu) - 32768.0) / 65536.0;
}

// Its height, m.
fn height_m(tree: TreeRow) -> f32 {
    return f32(tree.season_and_height >> 16u) / 256.0;
}

// Where a level of a tree of that height ends, m.
fn level_end_m(frame: Frame, rung: u32, height_m: f32) -> f32 {
    var ends = vec4(frame.level_0_end, frame.level_1_end, frame.level_2_end, 1e30);
    return ends[rung] * height_m;
}

// Models have a ladder of ages, and cards any age: the heights of a tree and of its card differ by less than this.
const LADDER: f32 = 1.17;

// Where a tree of that height has a card behind it and ends, m: the card is whole before the tree begins to go.
fn tree_end_m(frame: Frame, height_m: f32) -> f32 {
    return min(frame.cards_from_m, frame.level_2_end * height_m * LADDER);
}

// Where a card begins that stands for a tree of that height, m.
fn card_begin_m(frame: Frame, height_m: f32) -> f32 {
    return min(frame.cards_from_m, frame.level_2_end * height_m) / (1.0 + frame.fade);
}

const NO_PARENT: u32 = 0xffffffffu;

// A point of rest space that has been moved, and the rotation there.
struct Motion {
    position: vec3<f32>,
    rotation: vec4<f32>,
}

fn rotate(rotation: vec4<f32>, v: vec3<f32>) -> vec3<f32> {
    return v + 2.0 * cross(rotation.xyz, cross(rotation.xyz, v) + rotation.w * v);
}

fn conjugate(rotation: vec4<f32>) -> vec4<f32> {
    return vec4(-rotation.xyz, rotation.w);
}

fn then(first: vec4<f32>, second: vec4<f32>) -> vec4<f32> {
    return vec4(
        second.w * first.xyz + first.w * second.xyz + cross(second.xyz, first.xyz),
        second.w * first.w - dot(second.xyz, first.xyz),
    );
}

// `SLOPE_TIP`, `TIP_ANGLE_LIMIT` and `MODE_SHAPE` of `dynamics/pose.rs`; a test holds them equal.
const SLOPE_TIP: f32 = 1.3765054;
const TIP_ANGLE_LIMIT: f32 = 1.1;
const MODE_SHAPE_0: vec4<f32> = vec4(2.546882, -1.6781346, -0.2758867, 0.4069252);
const MODE_SHAPE_1: vec4<f32> = vec4(1.2742649, -0.563412, -0.06274729, 0.07835665);
const MODE_SHAPE_2: vec4<f32> = vec4(2.1950821, -2.357947, 0.80684225, -0.03069512);
const MODE_SHAPE_3: vec4<f32> = vec4(4.209066, -7.150318, 4.4999294, -1.0119247);
const MODE_SHAPE_4: vec4<f32> = vec4(8.117791, -17.585144, 13.848035, -3.8794978);
const MODE_SHAPE_5: vec4<f32> = vec4(15.02049, -37.190565, 32.597094, -9.95987);
const MODE_SHAPE_6: vec4<f32> = vec4(26.27535, -70.26942, 65.27605, -20.841745);

// Tip angle of a beam from the wind pressure across it: linear for a breeze, saturating in a storm.
fn tip_angle(pressure: vec3<f32>, direction: vec3<f32>, gain: f32) -> vec3<f32> {
    let across = pressure - direction * dot(pressure, direction);
    let free = across * (SLOPE_TIP * gain);
    return free * inverseSqrt(1.0 + dot(free, free) / (TIP_ANGLE_LIMIT * TIP_ANGLE_LIMIT));
}

// How the cross-section at `s` carries with it what is bound there.
fn bend(row: BeamRow, angle: vec3<f32>, s: f32, before: Motion) -> Motion {
    let s2 = s * s;
    let powers = vec4(1.0, s, s2, s2 * s);
    let h = s * dot(MODE_SHAPE_0, powers);
    let h1 = s2 * dot(MODE_SHAPE_1, powers);
    let h2 = s2 * s * dot(MODE_SHAPE_2, powers);
    let h3 = s2 * s2 * dot(MODE_SHAPE_3, powers);
    let h4 = s2 * s2 * s * dot(MODE_SHAPE_4, powers);
    let h5 = s2 * s2 * s2 * dot(MODE_SHAPE_5, powers);
    let h6 = s2 * s2 * s2 * s * dot(MODE_SHAPE_6, powers);
    let t = dot(angle, angle);
    let forward = -t * (h2 / 2.0 - t * (h4 / 24.0 - t * h6 / 720.0));
    let sideways = h1 - t * (h3 / 6.0 - t * h5 / 120.0);
    let displacement = row.length_m * (row.direction * forward + angle * sideways);

    let half = cross(row.direction, angle) * (0.5 * h);
    let x = dot(half, half);
    let turn = normalize(vec4(
        half * (1.0 - x / 6.0 + x * x / 120.0),
        1.0 - x / 2.0 + x * x / 24.0 - x * x * x / 720.0,
    ));
    let arm = before.position - (row.base + row.length_m * s * row.direction);
    // What moves is added to the rest position, so that a calm leaves every vertex exactly at rest.
    return Motion(before.position + (rotate(turn, arm) - arm) + displacement, then(before.rotation, turn));
}

// Where a rest point bound at `s` is now, and the rotation there.
fn carry(row: BeamRow, pose: BeamPose, s: f32, point: vec3<f32>) -> Motion {
    let bent = bend(row, pose.tip_angle.xyz, s, Motion(point, vec4(0.0, 0.0, 0.0, 1.0)));
    return Motion(rotate(pose.rotation, bent.position) + pose.translation.xyz, then(bent.rotation, pose.rotation));
}
