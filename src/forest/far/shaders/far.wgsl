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
    // How many times views of a tree there are, one below another, and with which those begin that have no leaves: 0 where
    // trees are evergreen.
    blocks: f32,
    first_bare: f32,
    // Width and height of a view's outline, texels.
    outline_texels: vec2<f32>,
    // Gain and class of each tree's lean: `lod/lean.rs`.
    leans: array<vec4<f32>, 4>,
}

@group(#{MATERIAL_BIND_GROUP}) @binding(100) var colours: texture_2d<f32>;
@group(#{MATERIAL_BIND_GROUP}) @binding(101) var surfaces: texture_2d<f32>;
@group(#{MATERIAL_BIND_GROUP}) @binding(109) var outlines: texture_2d<f32>;
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
    // The nearest view is drawn more often than its share: of fewer pictures at once, thin stems are less broken.
    let shares = vec3(1.0 - more, more - less, less);
    let weights = shares * shares;
    return Three(low, low + beside, low + 1.0, weights / (weights.x + weights.y + weights.z));
}

fn random(cell: vec2<i32>) -> f32 {
    var bits = bitcast<u32>(cell.x) * 0x9e3779b1u ^ bitcast<u32>(cell.y) * 0x85ebca77u;
    bits = (bits ^ (bits >> 15u)) * 0x2c1b3c6du;
    bits = (bits ^ (bits >> 12u)) * 0x297a2d39u;
    return f32((bits ^ (bits >> 15u)) >> 8u) / 16777216.0;
}

// A lot between 0 and 1, all equally likely, for each place on a card about as large as a pixel. It stays where it is on the
// tree: lots of the next finer and the next coarser grid, with sides of powers of two, are mixed, so that none jumps when
// the tree comes nearer. The mean of two lots is no longer equally likely everywhere, which its distribution makes up for.
fn lot(place_m: vec2<f32>, pixel_m: f32) -> f32 {
    let scale = log2(max(pixel_m, 1e-4));
    let fine = random(vec2<i32>(floor(place_m * exp2(-floor(scale)))));
    let coarse = random(vec2<i32>(floor(place_m * exp2(-floor(scale) - 1.0))));
    let share = fract(scale);
    let mixed = mix(fine, coarse, share);
    let less = min(share, 1.0 - share);
    let more = 1.0 - less;
    let rim = min(mixed, 1.0 - mixed);
    let below = select((rim - 0.5 * less) / more, rim * rim / max(2.0 * less * more, 1e-6), rim < less);
    return select(below, 1.0 - below, mixed > 0.5);
}

// What share of an outline's texel is an edge. Twigs are thinner than a texel: of one that stands alone, a filter leaves six
// tenths above a half, and nine tenths above two fifths.
const LINE: f32 = 0.5;
const TWIG_LINE: f32 = 0.4;

// A place in the atlas.
struct Spot {
    // Whether there is anything of the tree.
    is_there: bool,
    uv: vec2<f32>,
    // The mip in which to look for its colour.
    mip: f32,
}

// What is seen there.
struct Seen {
    colour: vec3<f32>,
    // The mean of unit normals: the shorter, the more they differ.
    normal: vec3<f32>,
    // Share of leaf, 0 for wood.
    leaf: f32,
}

// `point` lies on the card that faces the direction at `place` on the chart; whether there are leaves may differ from point
// to point.
fn spot_at(tree: f32, place: vec2<f32>, point: vec3<f32>, has_leaves: bool) -> Spot {
    let from_centre = point - views.centre;
    let along_x = dpdx(point);
    let along_y = dpdy(point);
    let facing = basis_towards(view_direction(place));
    let on_card = vec2(dot(from_centre, facing.right), dot(from_centre, facing.up));
    let pixel_m = max(length(along_x), length(along_y));
    let drawn = lot(on_card, pixel_m);
    // The lot picks a view, and what of it lies within the view's share is a lot again: whether there is anything.
    let three = views_around(place);
    let first = three.weights.x;
    let second = first + three.weights.y;
    var view = three.c;
    var start = second;
    if drawn < first {
        view = three.a;
        start = 0.0;
    } else if drawn < second {
        view = three.b;
        start = first;
    }
    let weight = select(select(three.weights.z, three.weights.y, drawn < second), first, drawn < first);

    let basis = basis_towards(above_horizon(view_direction(view / (views.across - 1.0))));
    let tiles = views.across * vec2(1.0, views.blocks);
    let block = round(tree) + select(views.first_bare, 0.0, has_leaves);
    let half = half_m(basis);
    let across = vec2(dot(from_centre, basis.right), -dot(from_centre, basis.up));
    let on_tile = clamp(0.5 + 0.5 * across / half, vec2(0.0), vec2(1.0));
    let uv = (view + vec2(0.0, views.across * block) + on_tile) / tiles;
    // Neighbours may have drawn other views: no derivatives of this place say how large a pixel is on it.
    let texel_m = 2.0 * half / views.outline_texels;
    let mip = max(log2(pixel_m / min(texel_m.x, texel_m.y)), 0.0);
    // Where texels are as large as pixels, the outline itself says whether there is anything; else the lot does.
    let line = select(TWIG_LINE, LINE, has_leaves);
    let threshold = mix((drawn - start) / max(weight, 1e-6), line, saturate(1.0 - mip));
    let outline = textureSampleLevel(outlines, views_sampler, uv, mip).r;
    // Of colours, half as large, one mip is enough: a lot picks that, too.
    return Spot(outline > threshold, uv, floor(max(mip - 1.0, 0.0) + fract(16.0 * drawn)));
}

fn seen_at(spot: Spot) -> Seen {
    let colour = textureSampleLevel(colours, views_sampler, spot.uv, spot.mip);
    let surface = textureSampleLevel(surfaces, views_sampler, spot.uv, spot.mip);
    return Seen(colour.rgb, 2.0 * surface.rgb - 1.0, surface.a);
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
