// How a blade of grass bends: the twin of `grass/spine.rs`, which derives the formulas. No bindings.

#define_import_path bevy_windwood::blade

// `LINKS`, `TIP_ANGLE_LIMIT_RAD` and `ANGLE_LIMIT_RAD` of `grass/spine.rs`; a test holds them equal.
const LINKS: u32 = 3;
const TIP_ANGLE_LIMIT_RAD: f32 = 1.2;
const ANGLE_LIMIT_RAD: f32 = 1.5;

struct Blade {
    root: vec3<f32>,
    length_m: f32,
    azimuth_rad: f32,
    lean_rad: f32,
    droop_rad: f32,
}

// A joint of the chain: where it is, and the direction of the blade there.
struct Joint {
    position: vec3<f32>,
    axis: vec3<f32>,
}

fn tip_bend(velocity: vec2<f32>, half_bend_speed_m_s: f32) -> vec2<f32> {
    let share = velocity / half_bend_speed_m_s;
    let load = share * length(share);
    return load * (TIP_ANGLE_LIMIT_RAD * inverseSqrt(1.0 + dot(load, load)));
}

fn angle_at(blade: Blade, s: f32, tip: vec2<f32>) -> vec2<f32> {
    let out = vec2(cos(blade.azimuth_rad), sin(blade.azimuth_rad));
    let rest = 1.0 - s;
    let slope = 1.0 - rest * rest * rest;
    let angle = out * blade.lean_rad + (out * blade.droop_rad + tip) * slope;
    return angle * (ANGLE_LIMIT_RAD / max(length(angle), ANGLE_LIMIT_RAD));
}

fn axis_of(angle: vec2<f32>) -> vec3<f32> {
    let size = length(angle);
    var sinc = 1.0;
    if size > 1e-6 {
        sinc = sin(size) / size;
    }
    return vec3(angle.x * sinc, cos(size), angle.y * sinc);
}

// The joint that many links up from the root.
fn joint_at(blade: Blade, tip: vec2<f32>, links: u32) -> Joint {
    var position = blade.root;
    for (var link = 0u; link < links; link += 1u) {
        let middle = (f32(link) + 0.5) / f32(LINKS);
        position += axis_of(angle_at(blade, middle, tip)) * (blade.length_m / f32(LINKS));
    }
    return Joint(position, axis_of(angle_at(blade, f32(links) / f32(LINKS), tip)));
}
