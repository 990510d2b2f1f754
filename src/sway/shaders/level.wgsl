// Where one level of a tree fades into the next: `sway/detail.rs` explains it. The values are those of Bevy's
// `visibility_range_dither`: 0 is all there, 16 or -16 nothing, and x and x - 16 complete each other.

#define_import_path bevy_windwood::level

const NOTHING: i32 = 16;

// How much is gone, 0 to 16, of what ends at `end_m`.
fn gone(distance_m: f32, end_m: f32, fade: f32) -> i32 {
    let share = (distance_m / max(end_m, 1e-3) - (1.0 - fade)) / (2.0 * fade);
    return i32(round(16.0 * saturate(share)));
}

fn is_nothing(dither: i32) -> bool {
    return abs(dither) >= NOTHING;
}
