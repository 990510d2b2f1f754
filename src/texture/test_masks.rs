//! Masks as they are seen, for tests.

use super::texture_data::{MASK_CUT_OFF, TextureData};

/// Places each way, over the whole mip.
const PLACES: usize = 701;

/// Share of a mip that passes the cut-off, between texels as well.
pub(crate) fn drawn_share(texture: &TextureData, mip: usize) -> f32 {
    let [width, height] = [texture.width, texture.height].map(|across| (across as usize >> mip).max(1));
    let alpha = |x: f32, y: f32| {
        let [x, y] = [(x, width), (y, height)].map(|(at, across)| at.clamp(0.0, across as f32 - 1.0) as usize);
        f32::from(texture.mips[mip][4 * (y * width + x) + 3]) / 255.0
    };
    let is_drawn = |place: usize| {
        let [x, y] = [(place % PLACES, width), (place / PLACES, height)]
            .map(|(place, across)| (place as f32 + 0.5) / PLACES as f32 * across as f32 - 0.5);
        let ([left, top], [u, v]) = ([x.floor(), y.floor()], [x - x.floor(), y - y.floor()]);
        let row = |y: f32| (1.0 - u) * alpha(left, y) + u * alpha(left + 1.0, y);
        (1.0 - v) * row(top) + v * row(top + 1.0) > MASK_CUT_OFF
    };
    (0..PLACES * PLACES).filter(|place| is_drawn(*place)).count() as f32 / (PLACES * PLACES) as f32
}
