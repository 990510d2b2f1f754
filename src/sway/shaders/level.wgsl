// Where one level of a tree fades into the next: `sway/detail.rs` explains it. Both are drawn pixel by pixel, as in Bevy's
// visibility ranges, but in so many steps that none is seen: of 16 each is, on crowns that hardly move. 0 is all there, NOTHING or -NOTHING nothing, and x and x - NOTHING complete each other.

#define_import_path bevy_windwood::level

const NOTHING: i32 = 1024;

// How much is gone, 0 to NOTHING, of what ends at `end_m`.
fn gone(distance_m: f32, end_m: f32, fade: f32) -> i32 {
    let share = (distance_m / max(end_m, 1e-3) - (1.0 - fade)) / (2.0 * fade);
    return i32(round(f32(NOTHING) * saturate(share)));
}

fn is_nothing(dither: i32) -> bool {
    return abs(dither) >= NOTHING;
}

// The place of a pixel in the ordered dither of 32 x 32: the bits of x ^ y and y, interleaved, lowest first.
fn rank(pixel: vec2<u32>) -> i32 {
    let y = pixel.y;
    let a = pixel.x ^ y;
    let high = ((a & 1u) << 9u) | ((y & 1u) << 8u) | ((a & 2u) << 6u) | ((y & 2u) << 5u) | ((a & 4u) << 3u);
    let low = ((y & 4u) << 2u) | (a & 8u) | ((y & 8u) >> 1u) | ((a & 16u) >> 3u) | ((y & 16u) >> 4u);
    return i32(high | low);
}

// Whether a level that is to be seen so much is not to be seen in this pixel.
fn leaves_out(frag_coord: vec4<f32>, dither: i32) -> bool {
    let rest = NOTHING - rank(vec2<u32>(frag_coord.xy));
    return select(dither >= rest, dither + NOTHING < rest, dither < 0);
}
