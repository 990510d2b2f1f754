// How a leaf turns into the wind and flutters: the twin of `dynamics/leaf.rs`, which explains it.

#define_import_path bevy_windwood::leaf

#import bevy_windwood::beam::then

// One species' `LeafResponse`.
struct LeafResponse {
    turn: f32,
    onset_speed_m_s: f32,
    full_speed_m_s: f32,
    flutter_angle_rad: f32,
    flutter_frequency_hz: f32,
    // Length after which the flutter repeats itself, s.
    period_s: f32,
    // 1 where the foliage grows transparent towards its outline: Gardner's ellipsoids.
    silhouette: f32,
    padding: f32,
}

@group(#{MATERIAL_BIND_GROUP}) @binding(104) var<uniform> response: LeafResponse;

// Whether the foliage is Gardner's ellipsoids and not sprays.
fn is_billow() -> bool {
    return response.silhouette > 0.5;
}

// What a billow's mask is multiplied with: `silhouette_alpha` of `tree/crown/ellipsoids.rs`.
fn silhouette_alpha(facing: f32) -> f32 {
    return 1.0 / (2.0 - min(facing * facing, 1.0));
}

const TURN: f32 = 6.283185307179586;
const FLUTTER_RATIOS: vec3<f32> = vec3(0.618, 1.0, 1.414);
const FIRST_PHASES: vec3<f32> = vec3(1.0, 7.0, 13.0);
const SECOND_PHASES: vec3<f32> = vec3(3.0, 11.0, 17.0);
const PARALLEL: f32 = 1e-4;

fn any_normal(axis: vec3<f32>) -> vec3<f32> {
    let helper = select(vec3(1.0, 0.0, 0.0), vec3(0.0, 1.0, 0.0), abs(axis.y) < 0.9);
    return normalize(cross(axis, helper));
}

fn from_scaled_axis(vector: vec3<f32>) -> vec4<f32> {
    let angle = length(vector);
    let axis = select(vec3(1.0, 0.0, 0.0), vector / max(angle, 1e-12), angle > 0.0);
    return vec4(axis * sin(0.5 * angle), cos(0.5 * angle));
}

fn smooth_between(start: f32, end: f32, value: f32) -> f32 {
    let t = clamp((value - start) / max(end - start, 1.1920929e-7), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

fn turn_towards(rest_axis: vec3<f32>, wind: vec3<f32>, speed: f32, turned: f32) -> vec4<f32> {
    if speed < 1e-6 {
        return vec4(0.0, 0.0, 0.0, 1.0);
    }
    let direction = wind / speed;
    let normal = cross(rest_axis, direction);
    let sine = length(normal);
    var axis = any_normal(rest_axis);
    if sine > PARALLEL {
        axis = normal / sine;
    }
    return from_scaled_axis(axis * (turned * atan2(sine, dot(rest_axis, direction))));
}

fn flutter_vector(rest_axis: vec3<f32>, time_s: f32, phase: f32) -> vec3<f32> {
    let first = any_normal(rest_axis);
    let second = cross(rest_axis, first);
    let cycles = round(FLUTTER_RATIOS * (response.flutter_frequency_hz * response.period_s)) * (time_s / response.period_s);
    let a = dot(sin(TURN * fract(cycles + FIRST_PHASES * phase)), vec3(1.0 / 3.0));
    let b = dot(sin(TURN * fract(cycles + SECOND_PHASES * phase)), vec3(1.0 / 3.0));
    return response.flutter_angle_rad * (a * first + b * second);
}

// The rotation of a leaf about its anchor; `rest_axis` and `wind` (m/s) in the same coordinates.
fn turn(rest_axis: vec3<f32>, wind: vec3<f32>, time_s: f32, phase: f32) -> vec4<f32> {
    let speed = length(wind);
    let turned = response.turn * smooth_between(response.onset_speed_m_s, response.full_speed_m_s, speed);
    let fluttering = smooth_between(0.5 * response.onset_speed_m_s, 0.5 * response.full_speed_m_s, speed);
    let flutter = flutter_vector(rest_axis, time_s, phase) * fluttering;
    return then(from_scaled_axis(flutter), turn_towards(rest_axis, wind, speed, turned));
}
