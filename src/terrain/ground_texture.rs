//! The fine structure of the ground, as Fourier textures (Zaharia, section 2.4): four kinds of light and dark in the four
//! channels of one texture that tiles.

use crate::setting::SettingError;
use crate::texture::{
    LinearImage, TextureData, blurred,
    fourier::{Combination, FourierTexture, threshold_above},
};
use bevy::math::{Mat2, Vec2};
use std::f32::consts::TAU;

/// Texels on a side.
const SIZE: usize = 512;

/// One of the four.
struct Kind {
    /// Waves of the first term along a side.
    cycles: f32,
    terms: u32,
    combination: Combination,
    seed: u64,
    /// Whether what is coarser than its waves is taken out: from afar it would look like scales.
    is_fine: bool,
}

const BLADES: Kind = Kind { cycles: 7.0, terms: 6, combination: Combination::Product, seed: 3, is_fine: true };

/// Red: blades and tufts; green: clods of earth; blue: seams in rock; alpha: patches. Each is spread over 0 to 1 so that
/// a tenth lies at either end, with mips.
pub(super) fn ground_texture() -> TextureData {
    let kind = |cycles, terms, combination, seed| Kind { cycles, terms, combination, seed, is_fine: false };
    let kinds = [
        BLADES,
        kind(5.0, 6, Combination::Sum, 11),
        kind(3.0, 7, Combination::Product, 23),
        kind(2.0, 4, Combination::Sum, 31),
    ];
    let mut image = LinearImage::filled(SIZE, [0.5; 4]);
    for (channel, kind) in kinds.iter().enumerate() {
        // The settings above are valid; a plain ground would do if they were not.
        if let Ok(values) = kind.values() {
            spread(&mut image, channel, values);
        }
    }
    image.into_linear_texture()
}

/// Turns by 27 degrees and shrinks by the square root of 5, so that what tiles before tiles after.
const TURN: Mat2 = Mat2::from_cols(Vec2::new(2.0, 1.0), Vec2::new(-1.0, 2.0));

impl Kind {
    /// Its value at each texel. The crests of one Fourier texture run along the axes, and a meadow of it looks like scales;
    /// two that are turned against one another have no direction that the eye would find.
    fn values(&self) -> Result<Vec<f32>, SettingError> {
        let waves = |cycles: f32, seed| {
            let first_frequency_rad = cycles * TAU;
            let Self { terms, combination, .. } = *self;
            FourierTexture { terms, first_frequency_rad, tiles: true, combination, seed, ..FourierTexture::default() }
                .waves()
        };
        let (straight, turned) = (waves(self.cycles, self.seed)?, waves(self.cycles / 5_f32.sqrt(), self.seed + 1)?);
        let place = |index: usize| Vec2::new((index % SIZE) as f32, (index / SIZE) as f32) / SIZE as f32;
        let mut values: Vec<f32> =
            (0..SIZE * SIZE).map(place).map(|place| straight.at(place) + turned.at(TURN * place)).collect();
        if self.is_fine {
            let coarse = blurred(&values, SIZE, (SIZE as f32 / (4.0 * self.cycles)) as usize);
            values.iter_mut().zip(coarse).for_each(|(value, coarse)| *value -= coarse);
        }
        Ok(values)
    }
}

fn spread(image: &mut LinearImage, channel: usize, values: Vec<f32>) {
    let (dark, light) = (threshold_above(values.clone(), 0.9), threshold_above(values.clone(), 0.1));
    for (texel, value) in image.texels.iter_mut().zip(values) {
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

    /// From afar it would show, repeat after repeat.
    #[test]
    fn fine_kinds_have_no_coarse_waves() {
        const BLOCKS: usize = 16;
        const SIDE: usize = SIZE / BLOCKS;
        // The deviation of the means of squares that are half as wide as the first waves.
        let unevenness = |is_fine: bool| {
            let kind = Kind { is_fine, ..BLADES };
            let mut image = LinearImage::filled(SIZE, [0.5; 4]);
            spread(&mut image, 0, kind.values().unwrap());
            let mut means = [0.0; BLOCKS * BLOCKS];
            for (index, texel) in image.texels.iter().enumerate() {
                means[index / SIZE / SIDE * BLOCKS + index % SIZE / SIDE] += texel[0] / (SIDE * SIDE) as f32;
            }
            let mean = means.iter().sum::<f32>() / means.len() as f32;
            (means.iter().map(|value| (value - mean).powi(2)).sum::<f32>() / means.len() as f32).sqrt()
        };
        let [fine, coarse] = [true, false].map(unevenness);
        assert!(coarse > 0.1 && fine < 0.7 * coarse, "{fine}, {coarse}");
    }

    /// The step across the border is no greater than steps inside.
    #[test]
    fn the_texture_tiles() {
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
