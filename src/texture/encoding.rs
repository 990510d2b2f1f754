//! Texels as bytes, and sRGB.

use std::sync::LazyLock;

/// A little more than half a step of an 8-bit channel: what keeps a value above the cut-off when it is rounded.
pub(crate) const HALF_A_STEP: f32 = 0.6 / 255.0;

pub(crate) fn colour_bytes(texel: &[f32; 4]) -> [u8; 4] {
    [srgb_byte(texel[0]), srgb_byte(texel[1]), srgb_byte(texel[2]), byte(texel[3])]
}

pub(crate) fn normal_bytes(texel: &[f32; 4]) -> [u8; 4] {
    let length = (texel[0] * texel[0] + texel[1] * texel[1] + texel[2] * texel[2]).sqrt().max(1e-6);
    let channel = |value: f32| byte(0.5 + 0.5 * value / length);
    [channel(texel[0]), channel(texel[1]), channel(texel[2]), byte(texel[3])]
}

pub(crate) fn linear_bytes(texel: &[f32; 4]) -> [u8; 4] {
    texel.map(byte)
}

pub(crate) fn byte(value: f32) -> u8 {
    (value.clamp(0.0, 1.0) * 255.0 + 0.5) as u8
}

/// The sRGB transfer function (IEC 61966-2-1), looked up: a power for each channel of each texel would take
/// most of the time.
fn srgb_byte(linear: f32) -> u8 {
    static BYTES: LazyLock<Vec<u8>> = LazyLock::new(|| {
        let encoded = |linear: f32| {
            if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
        };
        (0..=SRGB_STEPS).map(|step| byte(encoded(step as f32 / SRGB_STEPS as f32))).collect()
    });
    BYTES[(linear.clamp(0.0, 1.0) * SRGB_STEPS as f32 + 0.5) as usize]
}

/// Steps of linear light told apart: black's slope is 12.92, so that one step is a fifth of a byte there.
const SRGB_STEPS: usize = 16_384;

/// An sRGB colour as light.
pub(crate) fn linear(srgb: [f32; 3]) -> [f32; 3] {
    srgb.map(|value| if value <= 0.040_45 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) })
}

/// The colour `share` of the way from one to another.
pub(crate) fn mix(from: [f32; 3], to: [f32; 3], share: f32) -> [f32; 3] {
    std::array::from_fn(|channel| from[channel] + (to[channel] - from[channel]) * share)
}
