//! What lies under trees: a texture of fallen leaves, one over another, and twigs among them. It tiles.

use crate::texture::{LinearImage, TextureData};
use bevy::math::Vec2;
use rand::{Rng, RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};
use std::f32::consts::{PI, TAU};

/// Texels on a side. A side is [`GroundLook::texture_m`](super::GroundLook::texture_m) long, 2 m by default.
const SIZE: usize = 512;
/// Each place is covered by so many leaves, on average, so that no more than 1 in 50 is bare.
const LAYERS: f32 = 4.0;
/// Leaves are so long, texels: 5 to 11 cm at 2 m a side, as those of oaks and beeches.
const LONG_TEXELS: [f32; 2] = [13.0, 28.0];
/// Half the greatest width of a leaf, of its length.
const HALF_WIDTH: f32 = 0.27;
/// One in so many is a twig.
const LEAVES_A_TWIG: usize = 60;
/// Slope of a fallen leaf, and of its sides towards its midrib, at most. Chosen by eye.
const TILT: f32 = 0.35;
const FOLD: f32 = 0.3;

/// Red: light and dark; green: how pale a leaf is; blue and alpha: the slope towards the image's right and bottom, 1/2 where it is level.
pub(super) fn litter_texture() -> TextureData {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(5);
    let mut image = LinearImage::filled(SIZE, [0.12, 0.1, 0.5, 0.5]);
    let mean_texels = 0.5 * (LONG_TEXELS[0] + LONG_TEXELS[1]);
    // A leaf's outline is a sine, so its area is 2 / PI of the rectangle about it.
    let leaf_area = 2.0 * HALF_WIDTH * mean_texels * mean_texels * 2.0 / PI;
    let leaves = (LAYERS * (SIZE * SIZE) as f32 / leaf_area) as usize;
    for index in 0..leaves {
        let piece = if index % LEAVES_A_TWIG == 0 { Piece::twig(&mut random) } else { Piece::leaf(&mut random) };
        piece.lay_on(&mut image);
    }
    image.into_linear_texture()
}

/// A leaf or a twig that lies on the ground.
struct Piece {
    middle: Vec2,
    along: Vec2,
    long_texels: f32,
    half_width_texels: f32,
    light: f32,
    paleness: f32,
    tilt: Vec2,
}

impl Piece {
    fn leaf(random: &mut impl Rng) -> Self {
        let long_texels = random.random_range(LONG_TEXELS[0]..LONG_TEXELS[1]);
        Self {
            half_width_texels: HALF_WIDTH * long_texels * random.random_range(0.7..1.2),
            light: random.random_range(0.35..0.85),
            // Most have rotted for some time; few have come down lately.
            paleness: random.random_range(0.0_f32..1.0).powi(2),
            ..Self::somewhere(long_texels, random)
        }
    }

    fn twig(random: &mut impl Rng) -> Self {
        let long_texels = LONG_TEXELS[1] * random.random_range(1.0..3.5);
        Self {
            half_width_texels: random.random_range(0.9..1.8),
            light: random.random_range(0.2..0.45),
            paleness: random.random_range(0.2..0.5),
            ..Self::somewhere(long_texels, random)
        }
    }

    fn somewhere(long_texels: f32, random: &mut impl Rng) -> Self {
        let mut anywhere = || random.random_range(0.0..1.0_f32);
        Self {
            middle: SIZE as f32 * Vec2::new(anywhere(), anywhere()),
            along: Vec2::from_angle(TAU * anywhere()),
            tilt: TILT * anywhere().sqrt() * Vec2::from_angle(TAU * anywhere()),
            long_texels,
            half_width_texels: 0.0,
            light: 0.0,
            paleness: 0.0,
        }
    }

    /// Lays it over what lies there already. What reaches over the border comes in on the other side.
    fn lay_on(&self, image: &mut LinearImage) {
        let reach = (0.5 * self.long_texels).ceil() as i32 + 1;
        let (x, y) = (self.middle.x as i32, self.middle.y as i32);
        for (row, column) in (-reach..=reach).flat_map(|row| (-reach..=reach).map(move |column| (row, column))) {
            let from_middle = Vec2::new((x + column) as f32, (y + row) as f32) + 0.5 - self.middle;
            let Some(texel) = self.texel(from_middle) else { continue };
            let wrapped = |at: i32| at.rem_euclid(SIZE as i32) as usize;
            image.texels[wrapped(y + row) * SIZE + wrapped(x + column)] = texel;
        }
    }

    /// Its texel that far from its middle; none beside it.
    fn texel(&self, from_middle: Vec2) -> Option<[f32; 4]> {
        let side = self.along.perp();
        let (along, across) = (from_middle.dot(self.along), from_middle.dot(side));
        let share = along / self.long_texels + 0.5;
        if !(0.0..=1.0).contains(&share) {
            return None;
        }
        let half_width = self.half_width_texels * (PI * share).sin();
        let out = across.abs() / half_width.max(1e-3);
        if out > 1.0 {
            return None;
        }
        // Its edge lies in its own shade, and its midrib is a furrow.
        let rib = if across.abs() < 0.7 { 0.8 } else { 1.0 };
        let light = self.light * rib * (1.0 - 0.35 * out.powi(3));
        let slope = self.tilt + FOLD * across.signum() * out * side;
        let [right, down] = (0.5 + 0.5 * slope.clamp(Vec2::NEG_ONE, Vec2::ONE)).to_array();
        Some([light, self.paleness, right, down])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texel(texture: &TextureData, x: usize, y: usize) -> [f32; 4] {
        std::array::from_fn(|channel| f32::from(texture.mips[0][4 * (y * SIZE + x) + channel]) / 255.0)
    }

    #[test]
    fn leaves_cover_the_ground() {
        let texture = litter_texture();
        let bare = (0..SIZE * SIZE).filter(|index| {
            texel(&texture, index % SIZE, index / SIZE)[1] < 0.105
                && texel(&texture, index % SIZE, index / SIZE)[0] < 0.125
        });
        let share = bare.count() as f32 / (SIZE * SIZE) as f32;
        // With pieces at random, exp(-layers) of the ground stays bare.
        assert!(share < 2.0 * (-LAYERS).exp(), "{share}");
    }

    #[test]
    fn slopes_have_no_direction_in_common() {
        let texture = litter_texture();
        let last = texture.mips.last().unwrap();
        for channel in [2, 3] {
            assert!((i32::from(last[channel]) - 128).abs() < 8, "{}", last[channel]);
        }
    }

    /// Leaves end at borders no more often than elsewhere.
    #[test]
    fn the_texture_tiles() {
        let texture = litter_texture();
        let step = |x: usize| -> f32 {
            let rows = (0..SIZE).map(|y| (texel(&texture, x, y)[0] - texel(&texture, (x + 1) % SIZE, y)[0]).abs());
            rows.sum::<f32>() / SIZE as f32
        };
        let inside = (0..SIZE - 1).map(step).sum::<f32>() / (SIZE - 1) as f32;
        assert!(step(SIZE - 1) < 1.4 * inside, "{} across, {inside} inside", step(SIZE - 1));
    }
}
