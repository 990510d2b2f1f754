//! The cubic step that shaders call `smoothstep`.

/// From 0 at `start` to 1 at `end`.
pub(in crate::wind::source) fn smoothstep(start: f32, end: f32, value: f32) -> f32 {
    let t = ((value - start) / (end - start)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}
