// The views of a far tree: the twin of `lod/chart.rs` and `lod/views.rs`, which explain it.

#define_import_path bevy_windwood::far

struct Views {
    // The middle of the upright cylinder that the views are of, tree-local, m.
    centre: vec3<f32>,
    radius_m: f32,
    half_height_m: f32,
    // Views each way.
    across: f32,
    translucency: f32,
    padding: f32,
}

@group(#{MATERIAL_BIND_GROUP}) @binding(100) var colours: texture_2d<f32>;
@group(#{MATERIAL_BIND_GROUP}) @binding(101) var surfaces: texture_2d<f32>;
@group(#{MATERIAL_BIND_GROUP}) @binding(102) var views_sampler: sampler;
@group(#{MATERIAL_BIND_GROUP}) @binding(104) var<uniform> views: Views;

// The axes of a view.
struct Basis {
    right: vec3<f32>,
    up: vec3<f32>,
    forward: vec3<f32>,
}

fn basis_towards(to_eye: vec3<f32>) -> Basis {
    let level = vec3(to_eye.z, 0.0, -to_eye.x);
    let extent = length(level);
    let right = select(vec3(1.0, 0.0, 0.0), level / max(extent, 1e-12), extent > 1e-6);
    return Basis(right, cross(to_eye, right), -to_eye);
}

fn half_m(basis: Basis) -> vec2<f32> {
    let sine = abs(basis.forward.y);
    let cosine = abs(basis.up.y);
    return vec2(views.radius_m, views.half_height_m * cosine + views.radius_m * sine);
}

// Below the horizon a tree is seen as from the horizon.
fn above_horizon(to_eye: vec3<f32>) -> vec3<f32> {
    return normalize(vec3(to_eye.x, max(to_eye.y, 0.0), to_eye.z) + vec3(1e-6, 0.0, 0.0));
}

fn view_place(to_eye: vec3<f32>) -> vec2<f32> {
    let d = to_eye / (abs(to_eye.x) + abs(to_eye.y) + abs(to_eye.z));
    return 0.5 + 0.5 * vec2(d.x + d.z, d.x - d.z);
}

fn view_direction(place: vec2<f32>) -> vec3<f32> {
    let p = 2.0 * place - 1.0;
    let x = 0.5 * (p.x + p.y);
    let z = 0.5 * (p.x - p.y);
    return normalize(vec3(x, 1.0 - abs(x) - abs(z), z));
}

fn normal_of(place: vec2<f32>) -> vec3<f32> {
    let p = 2.0 * place - 1.0;
    let y = 1.0 - abs(p.x) - abs(p.y);
    let folded = (1.0 - abs(p.yx)) * select(vec2(-1.0), vec2(1.0), p >= vec2(0.0));
    let flat = select(p, folded, y < 0.0);
    return normalize(vec3(flat.x, y, flat.y));
}

// Where a tree-local point is seen in the atlas, on the tile of a view.
fn atlas_place(view: vec2<f32>, point: vec3<f32>) -> vec2<f32> {
    let basis = basis_towards(above_horizon(view_direction(view / (views.across - 1.0))));
    let from_centre = point - views.centre;
    let seen = vec2(dot(from_centre, basis.right), -dot(from_centre, basis.up)) / half_m(basis);
    return (view + clamp(0.5 + 0.5 * seen, vec2(0.0), vec2(1.0))) / views.across;
}

// What is seen at a point of a card.
struct Seen {
    colour: vec3<f32>,
    alpha: f32,
    normal: vec3<f32>,
    // Share of leaf, 0 for wood.
    leaf: f32,
}

struct Three {
    a: vec2<f32>,
    b: vec2<f32>,
    c: vec2<f32>,
    weights: vec3<f32>,
}

// The three views around a place on the chart of directions.
fn views_around(place: vec2<f32>) -> Three {
    let grid = place * (views.across - 1.0);
    let low = clamp(floor(grid + 1e-4), vec2(0.0), vec2(views.across - 2.0));
    let within = clamp(grid - low, vec2(0.0), vec2(1.0));
    let beside = select(vec2(0.0, 1.0), vec2(1.0, 0.0), within.x > within.y);
    let more = max(within.x, within.y);
    let less = min(within.x, within.y);
    return Three(low, low + beside, low + 1.0, vec3(1.0 - more, more - less, less));
}

fn seen_at(place: vec2<f32>, point: vec3<f32>) -> Seen {
    let three = views_around(place);
    let uv_a = atlas_place(three.a, point);
    let uv_b = atlas_place(three.b, point);
    let uv_c = atlas_place(three.c, point);
    let a = textureSample(colours, views_sampler, uv_a);
    let b = textureSample(colours, views_sampler, uv_b);
    let c = textureSample(colours, views_sampler, uv_c);
    let surface_a = textureSample(surfaces, views_sampler, uv_a);
    let surface_b = textureSample(surfaces, views_sampler, uv_b);
    let surface_c = textureSample(surfaces, views_sampler, uv_c);
    let alpha = dot(three.weights, vec3(a.a, b.a, c.a));
    // What a view does not see has no say in the colour.
    let w = three.weights * (vec3(a.a, b.a, c.a) + 1e-3);
    let share = w / (w.x + w.y + w.z);
    let normal = share.x * normal_of(surface_a.xy) + share.y * normal_of(surface_b.xy) + share.z * normal_of(surface_c.xy);
    return Seen(
        share.x * a.rgb + share.y * b.rgb + share.z * c.rgb,
        alpha,
        normalize(normal + vec3(0.0, 1e-4, 0.0)),
        dot(share, vec3(surface_a.a, surface_b.a, surface_c.a)),
    );
}

// When in the year the leaves at a place of the crown come and go, 0..1 among all.
fn leaf_rank(point: vec3<f32>) -> f32 {
    return fract(sin(dot(floor(point * 2.0), vec3(12.9898, 78.233, 37.719))) * 43758.547);
}

// Turned about the vertical.
fn turned(v: vec3<f32>, turn: f32) -> vec3<f32> {
    let c = cos(turn);
    let s = sin(turn);
    return vec3(c * v.x + s * v.z, v.y, c * v.z - s * v.x);
}
