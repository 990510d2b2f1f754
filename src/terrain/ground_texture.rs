//! The fine structure of the ground, as Fourier textures (Zaharia, section 2.4): four kinds of light and dark in the four
//! channels of one texture that tiles.

use crate::texture::{
    Canvas, TextureData,
    fourier::{Combination, FourierTexture, FourierWaves, InvalidFourierTexture, threshold_above},
};
use bevy::math::Vec2;
use std::f32::consts::TAU;

/// Texels on a side.
const SIZE: usize = 512;

/// Red: blades and tufts; green: clods of earth; blue: seams in rock; alpha: patches. Each is spread over 0 to 1 so that
/// a tenth lies at either end, with mips.
pub(super) fn ground_texture() -> TextureData {
    let waves = |cycles: f32, terms: u32, combination, seed| {
        let first_frequency_rad = cycles * TAU;
        FourierTexture { terms, first_frequency_rad, tiles: true, combination, seed, ..FourierTexture::default() }
            .waves()
    };
    let kinds = [
        waves(7.0, 5, Combination::Product, 3),
        waves(5.0, 6, Combination::Sum, 11),
        waves(3.0, 7, Combination::Product, 23),
        waves(2.0, 4, Combination::Sum, 31),
    ];
    let mut canvas = Canvas::filled(SIZE, [0.5; 4]);
    for (channel, waves) in kinds.into_iter().enumerate() {
        paint(&mut canvas, channel, waves);
    }
    canvas.into_linear_texture()
}

fn paint(canvas: &mut Canvas, channel: usize, waves: Result<FourierWaves, InvalidFourierTexture>) {
    // The settings above are valid; a plain ground would do if they were not.
    let Ok(waves) = waves else { return };
    let place = |index: usize| Vec2::new((index % SIZE) as f32, (index / SIZE) as f32) / SIZE as f32;
    let values: Vec<f32> = (0..SIZE * SIZE).map(|index| waves.at(place(index))).collect();
    let (dark, light) = (threshold_above(values.clone(), 0.9), threshold_above(values.clone(), 0.1));
    for (texel, value) in canvas.texels.iter_mut().zip(values) {
        texel[channel] = ((value - dark) / (light - dark).max(1e-6)).clamp(0.0, 1.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_channel_has_light_and_dark_about_the_middle() {
        let texture = ground_texture();
        for channel in 0..4 {
            let mean = f32::from(texture.mips.last().unwrap()[channel]) / 255.0;
            assert!((0.3..0.7).contains(&mean), "channel {channel}: {mean}");
            let values = texture.mips[0].iter().skip(channel).step_by(4);
            assert!(values.clone().any(|value| *value == 0) && values.clone().any(|value| *value == 255));
        }
    }

    /// The step across the border is no greater than steps inside.
    #[test]
    fn it_tiles() {
        let texture = ground_texture();
        let texel = |x: usize, y: usize, channel: usize| i32::from(texture.mips[0][4 * (y * SIZE + x) + channel]);
        for channel in 0..4 {
            let step = |x: usize, y: usize| (texel(x, y, channel) - texel((x + 1) % SIZE, y, channel)).abs();
            let inside = (0..SIZE).map(|y| step(SIZE / 3, y)).max().unwrap();
            let across = (0..SIZE).map(|y| step(SIZE - 1, y)).max().unwrap();
            assert!(across <= inside.max(8) * 2, "channel {channel}: {across} across, {inside} inside");
        }
    }
}
