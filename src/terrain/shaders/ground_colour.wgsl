// What the ground looks like: grass, earth, rock and snow by slope and height, and woods.

#import bevy_pbr::forward_io::{FragmentOutput, VertexOutput}
#import bevy_pbr::mesh_view_bindings::view
#import bevy_pbr::pbr_fragment::pbr_input_from_standard_material
#import bevy_pbr::pbr_functions::{apply_pbr_lighting, main_pass_post_lighting_processing}

#ifdef VISIBILITY_RANGE_DITHER
#import bevy_pbr::pbr_functions::visibility_range_dither
#endif

// `LookUniform` of `terrain/material.rs`. Colours are linear.
struct Look {
    grass: vec4<f32>,
    dry_grass: vec4<f32>,
    earth: vec4<f32>,
    rock: vec4<f32>,
    snow: vec4<f32>,
    litter: vec4<f32>,
    canopy: vec4<f32>,
    // 1 - cosine of the slopes between which the ground grows bare.
    bare_from: f32,
    bare_to: f32,
    grass_line_m: f32,
    snow_line_m: f32,
    line_blur_m: f32,
    per_texture_m: f32,
    canopy_from_m: f32,
    padding: f32,
}

@group(#{MATERIAL_BIND_GROUP}) @binding(100) var<uniform> look: Look;
// Red: blades; green: clods; blue: seams in rock; alpha: patches. All are light and dark about 1/2.
@group(#{MATERIAL_BIND_GROUP}) @binding(101) var detail: texture_2d<f32>;
@group(#{MATERIAL_BIND_GROUP}) @binding(102) var detail_sampler: sampler;

// Repeats of the texture: no two have a common measure, and they are turned against one another, so that the eye finds no
// period.
const NEAR: mat2x2<f32> = mat2x2(0.891, 0.454, -0.454, 0.891);
const TURNED: mat2x2<f32> = mat2x2(0.201, -0.246, 0.246, 0.201);
const MIDDLE: mat2x2<f32> = mat2x2(0.0257, 0.0175, -0.0175, 0.0257);
const WIDE: mat2x2<f32> = mat2x2(0.00164, -0.00268, 0.00268, 0.00164);
const VAST: mat2x2<f32> = mat2x2(0.00033, 0.00012, -0.00012, 0.00033);

// The colour and the light on it that gets lost between blades and clods.
fn ground_colour(place: vec3<f32>, normal: vec3<f32>, covered: f32, distance: f32) -> vec3<f32> {
    let uv = place.xz * look.per_texture_m;
    let near = textureSample(detail, detail_sampler, NEAR * uv);
    let turned = textureSample(detail, detail_sampler, TURNED * uv);
    let middle = textureSample(detail, detail_sampler, MIDDLE * uv);
    let wide = textureSample(detail, detail_sampler, WIDE * uv);
    let vast = textureSample(detail, detail_sampler, VAST * uv);
    // Seams of rock follow the height, so that cliffs are not smeared.
    let strata = textureSample(detail, detail_sampler, vec2(0.044 * (uv.x + uv.y), 0.124 * place.y * look.per_texture_m));

    // What breaks up every border, some -1..1. From afar only what is large does: the eye would see repeats of the rest.
    let nearness = 1.0 / (1.0 + distance * distance / 90000.0);
    let ragged = (vast.a - 0.5) + 0.8 * (wide.a - 0.5) + 0.4 * (vast.b - 0.5) + nearness * ((middle.a - 0.5) + 0.3 * (middle.b - 0.5));
    let slope = 1.0 - normal.y;
    let span = look.bare_to - look.bare_from;

    // Fresh and dry blades grow side by side.
    let dryness = smoothstep(-0.5, 0.7, ragged + 0.4 * (wide.r - 0.5) + 0.45 * (near.r - 0.5) + 0.3 * (turned.b - 0.5))
        + smoothstep(-1.0, 1.0, (place.y - look.grass_line_m) / look.line_blur_m + ragged);
    let blades = 0.44 + 0.45 * near.r + 0.18 * turned.r * (0.4 + 0.6 * middle.a) + 0.15 * middle.r;
    var colour = mix(look.grass.rgb, look.dry_grass.rgb, saturate(dryness)) * blades;

    let floor = look.litter.rgb * (0.45 + 0.5 * near.g + 0.5 * turned.g);
    colour = mix(colour, floor, smoothstep(0.15, 0.75, covered + 0.35 * ragged * covered));

    let clods = 0.5 + 0.45 * turned.g + 0.35 * near.g + 0.2 * middle.g;
    let bare = smoothstep(look.bare_from - 0.25 * span, look.bare_from + 0.5 * span, slope + 0.35 * span * ragged + 0.15 * span * (near.g - 0.5));
    colour = mix(colour, look.earth.rgb * clods, bare);

    let seams = 0.45 + 0.45 * strata.b + nearness * (0.3 * turned.b + 0.25 * middle.b - 0.2) + 0.25 * (wide.b - 0.3);
    let stony = smoothstep(look.bare_to - 0.5 * span, look.bare_to + 0.25 * span, slope + 0.3 * span * ragged + 0.2 * span * (strata.b - 0.5));
    colour = mix(colour, look.rock.rgb * seams, stony);

    // Crowns far away: dark between, light on top. They hide what is under them, and are all there before the last trees go.
    let crowns = 0.3 + 0.8 * mix(0.5, middle.g, 0.35 + 0.65 * nearness) * (0.6 + 0.4 * turned.g) + 0.3 * (wide.r - 0.5) + 0.25 * (vast.b - 0.5);
    let closed = smoothstep(0.12, 0.5, covered * (1.0 + 0.6 * ragged)) * smoothstep(0.55, 0.8, distance / max(look.canopy_from_m, 1e-3));
    colour = mix(colour, look.canopy.rgb * crowns, closed);

    let steep = smoothstep(look.bare_to - span, look.bare_to + span, slope + 0.2 * span * (strata.b - 0.5));
    let snowy = smoothstep(-0.5, 0.5, (place.y - look.snow_line_m) / look.line_blur_m + 0.8 * ragged - 2.0 * steep);
    return mix(colour, look.snow.rgb * (0.9 + 0.1 * near.g), snowy);
}

@fragment
fn fragment(in: VertexOutput, @builtin(front_facing) is_front: bool) -> FragmentOutput {
#ifdef VISIBILITY_RANGE_DITHER
    visibility_range_dither(in.position, in.visibility_range_dither);
#endif
    var pbr_input = pbr_input_from_standard_material(in, is_front);
    let place = in.world_position.xyz;
    let colour = ground_colour(place, normalize(in.world_normal), in.color.a, distance(place, view.world_position));
    pbr_input.material.base_color = vec4(colour, 1.0);
    var out: FragmentOutput;
    out.color = apply_pbr_lighting(pbr_input);
    out.color = main_pass_post_lighting_processing(pbr_input, out.color);
    return out;
}
