// What leaves do over the year: the twin of `tree/phenology.rs`, which explains it.

#define_import_path bevy_windwood::season

// One species' `Phenology`, see `SeasonUniform` in `sway/material.rs`.
struct Phenology {
    flush: f32,
    flush_length: f32,
    turn: f32,
    turn_length: f32,
    fall: f32,
    fall_length: f32,
    patchiness: f32,
    // 1 if leaves stay over winter.
    evergreen: f32,
    // Light, and in w the luminance of the leaf in summer.
    spring: vec4<f32>,
    autumn_first: vec4<f32>,
    autumn_last: vec4<f32>,
}

struct LeafState {
    size: f32,
    youth: f32,
    autumn: f32,
    // Whether it has fallen so lately that its leaves still drift down now and then.
    drifting: bool,
}

@group(#{MATERIAL_BIND_GROUP}) @binding(107) var<uniform> phenology: Phenology;

// `DROP` and `YOUTH` of `tree/phenology.rs`; a test holds them equal.
const DROP: f32 = 0.014;
const YOUTH: f32 = 0.13;
const DRIFT: f32 = 0.04;

// A leaf in the air: how fast it sinks, m/s, how much of the wind's speed it takes, how far it may drift, m (trees are
// culled by a box around them), how often it is seen, s (a whole part of the flutter's period), and its size.
const SINK_M_S: f32 = 1.3;
const CARRIED: f32 = 0.25;
const FARTHEST_M: f32 = 5.0;
const CYCLE_S: f32 = 64.0;
const LEAF_SIZE: f32 = 0.22;

// Where a leaf is that has come off: in x, y, z the way from where it hung, in w its size, 0 while it is not seen.
fn drift(wind: vec3<f32>, height_m: f32, time_s: f32, phase: f32) -> vec4<f32> {
    let flown_s = fract(time_s / CYCLE_S + 7.0 * phase) * CYCLE_S;
    let sunk_m = SINK_M_S * flown_s;
    let swing = 0.35 * vec3(sin(2.1 * flown_s + 40.0 * phase), 0.2 * sin(4.2 * flown_s), cos(1.7 * flown_s + 23.0 * phase));
    let blown = wind * (CARRIED * flown_s);
    let way = blown * min(1.0, FARTHEST_M / max(length(blown), 1e-3)) + swing * min(flown_s, 1.0);
    return vec4(way - vec3(0.0, sunk_m, 0.0), select(0.0, LEAF_SIZE, sunk_m < height_m));
}

fn leaves(year: f32, lag: f32, rank: f32) -> LeafState {
    let own = year + phenology.patchiness * lag;
    let youth = 1.0 - smoothstep(phenology.flush, phenology.flush + YOUTH, own);
    if phenology.evergreen > 0.5 {
        return LeafState(1.0, youth * smoothstep(phenology.flush - 0.5 * phenology.flush_length, phenology.flush, own), 0.0, false);
    }
    let flush = 0.5 * phenology.flush_length;
    let unfolded = smoothstep(phenology.flush - flush, phenology.flush + flush, own);
    let falls = min(phenology.fall + phenology.fall_length * (rank - 0.5), 1.0 - DROP);
    let turn = 0.5 * phenology.turn_length;
    return LeafState(
        unfolded * (1.0 - smoothstep(falls, falls + DROP, year)),
        youth,
        smoothstep(phenology.turn - turn, phenology.turn + turn, own),
        year >= falls + DROP && year < falls + DROP + DRIFT,
    );
}

fn luminance(light: vec3<f32>) -> f32 {
    return dot(light, vec3(0.2126, 0.7152, 0.0722));
}

// How much of a texel is leaf and not twig: leaves are green.
fn leafness(light: vec3<f32>) -> f32 {
    let sum = light.r + light.g + light.b;
    return saturate(5.0 * (light.g - 0.5 * (light.r + light.b)) / max(sum, 1e-5));
}

// Leaves come and go one by one: a card is divided into so many cells each way, about a leaf each.
const LEAVES_ACROSS: f32 = 9.0;

fn cell_rank(uv: vec2<f32>) -> f32 {
    let cell = floor(uv * LEAVES_ACROSS);
    return fract(sin(dot(cell, vec2(12.9898, 78.233))) * 43758.547);
}

// Texels to a pixel up to which a bare twig is a line; beyond, only specks of it would pass the mask.
const TWIG_TEXELS: f32 = 4.5;

// Whether a texel of a spray is to be seen when that share of its leaves is there: the twigs of a bare one are, as long as
// it is near. `texels` is how many of them a pixel covers.
fn is_there(texel: vec3<f32>, uv: vec2<f32>, share: f32, texels: f32) -> bool {
    let is_twig = leafness(texel) < 0.35 && (texels < TWIG_TEXELS || share > 0.5);
    return share > 0.999 || is_twig || share > 0.02 + 0.96 * cell_rank(uv);
}

// Places of an envelope of leaves, each way, that go bare one by one.
const PLACES_ACROSS: f32 = 24.0;

// Whether a place of an envelope has leaves when that share of them is there.
fn is_left(uv: vec2<f32>, share: f32) -> bool {
    return share > 0.999 || share > 0.02 + 0.96 * cell_rank(uv * (PLACES_ACROSS / LEAVES_ACROSS));
}

// A texel of a leaf in summer, as it is in another season. `change` is youth (negative) or autumn (positive), `tone` where
// between the two autumn colours. Light and dark of the texel stay.
fn recoloured(summer: vec3<f32>, change: f32, tone: f32) -> vec3<f32> {
    var colour = phenology.spring.rgb;
    if change > 0.0 {
        colour = mix(phenology.autumn_first.rgb, phenology.autumn_last.rgb, tone);
    }
    let lightness = min(luminance(summer) / max(phenology.spring.w, 1e-4), 4.0);
    return mix(summer, colour * lightness, abs(change) * leafness(summer));
}
