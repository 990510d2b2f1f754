//! The texture on a polygon of an impressionist crown.
//!
//! The paper's triangles are plain. Here a Fourier texture may eat into their edges: with `b` the least barycentric
//! coordinate (0 at an edge, 1/3 in the middle) and `F` the rank of the texture's value among all (0..1), a texel is
//! drawn where
//!
//! ```text
//! F > raggedness (1 - 3 b)^2
//! ```
//!
//! which leaves the plain triangle at raggedness 0 and its middle always. In winter the triangle bears a fan of forking
//! twigs instead, whose root is the anchor.

use bevy::math::{Vec2, Vec3};
use rand::{Rng, RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};

use super::impressionist_settings::{CrownForm, ImpressionistCrown};
use crate::{
    texture::fourier::FourierTexture,
    texture::{LinearImage, TextureData, linear},
};

/// Side of the texture, texels.
const SIZE: usize = 256;
/// Texels drawn per texel of the texture, in each direction.
const OVERSAMPLING: usize = 2;
/// Brightness of the dark parts of a polygon against the bright ones.
const DAPPLE: f32 = 0.55;
/// Colour of what is not drawn, against what is: where mips mix them, the edge darkens.
const GROUND: f32 = 0.7;
/// Forkings of a winter polygon's twigs.
const FORKINGS: u32 = 4;

pub(super) fn polygon_texture(crown: &ImpressionistCrown, seed: u64) -> TextureData {
    let colour = linear(rgb(crown.hue_deg, crown.saturation, crown.greatest_brightness));
    let side = SIZE * OVERSAMPLING;
    let ground = colour.map(|channel| channel * GROUND);
    let mut canvas = LinearImage::filled(side, [ground[0], ground[1], ground[2], 0.0]);
    match crown.form {
        CrownForm::Winter => draw_twigs(&mut canvas, colour, seed),
        CrownForm::Normal | CrownForm::Conifer => draw_leaves(&mut canvas, colour, crown.raggedness, seed),
    }
    canvas.downsampled().into_mask_texture()
}

fn draw_leaves(canvas: &mut LinearImage, colour: [f32; 3], raggedness: f32, seed: u64) {
    let texture = FourierTexture { first_frequency_rad: 24.0, offset: 0.6, seed, ..FourierTexture::default() };
    // The settings are constant and valid; without waves the triangle would be plain.
    let Ok(waves) = texture.waves() else { return };
    let side = canvas.width;
    let place = |index: usize| Vec2::new((index % side) as f32 + 0.5, (index / side) as f32 + 0.5) / side as f32;
    let values: Vec<f32> = (0..side * side).map(|index| waves.at(place(index))).collect();
    let mut ranks = values.clone();
    ranks.sort_by(f32::total_cmp);
    for (index, value) in values.iter().enumerate() {
        let edge = barycentric(place(index)).min_element();
        let rank = ranks.partition_point(|other| other < value) as f32 / ranks.len() as f32;
        if edge >= 0.0 && rank >= raggedness * (1.0 - 3.0 * edge).powi(2) {
            let tone = DAPPLE + (1.0 - DAPPLE) * rank;
            canvas.texels[index] = [colour[0] * tone, colour[1] * tone, colour[2] * tone, 1.0];
        }
    }
}

/// Barycentric coordinates in the triangle (0.5, 1), (1, 0), (0, 0).
fn barycentric(uv: Vec2) -> Vec3 {
    let anchor = uv.y;
    let right = uv.x - 0.5 * uv.y;
    Vec3::new(anchor, right, 1.0 - anchor - right)
}

/// A stroke of the brush.
struct Twig {
    from: Vec2,
    direction: Vec2,
    length: f32,
    radius: f32,
}

fn draw_twigs(canvas: &mut LinearImage, colour: [f32; 3], seed: u64) {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
    let mut twigs: Vec<Twig> = [-0.3_f32, 0.0, 0.3]
        .into_iter()
        .map(|angle| Twig {
            from: Vec2::new(0.5, 1.0),
            direction: Vec2::from_angle(angle).rotate(Vec2::NEG_Y),
            length: 0.36,
            radius: 0.012,
        })
        .collect();
    for _ in 0..=FORKINGS {
        twigs.iter().for_each(|twig| twig.stroke(canvas, colour));
        twigs = twigs.iter().flat_map(|twig| twig.fork(&mut random)).collect();
    }
}

impl Twig {
    /// Two thinner twigs, from its tip and from a place before it.
    fn fork(&self, random: &mut impl Rng) -> [Self; 2] {
        let mut side = |sign: f32, at: f32| Self {
            from: self.from + self.direction * (at * self.length),
            direction: Vec2::from_angle(sign * random.random_range(0.1..0.5)).rotate(self.direction),
            length: self.length * random.random_range(0.6..0.8),
            radius: 0.72 * self.radius,
        };
        let sign = if self.direction.x < 0.0 { 1.0 } else { -1.0 };
        [side(sign, 1.0), side(-sign, 0.55)]
    }

    fn stroke(&self, canvas: &mut LinearImage, colour: [f32; 3]) {
        let side = canvas.width as f32;
        let to = self.from + self.direction * self.length;
        let low = (self.from.min(to) - self.radius).clamp(Vec2::ZERO, Vec2::ONE) * side;
        let high = (self.from.max(to) + self.radius).clamp(Vec2::ZERO, Vec2::ONE) * side;
        for y in low.y as usize..high.y as usize {
            for x in low.x as usize..high.x as usize {
                let uv = Vec2::new(x as f32 + 0.5, y as f32 + 0.5) / side;
                let along = (uv - self.from).dot(self.direction).clamp(0.0, self.length);
                let off = uv.distance(self.from + self.direction * along) / self.radius;
                if off < 1.0 && barycentric(uv).min_element() >= 0.0 {
                    let tone = 1.05 - 0.3 * off * off;
                    canvas.texels[y * canvas.width + x] = [colour[0] * tone, colour[1] * tone, colour[2] * tone, 1.0];
                }
            }
        }
    }
}

/// sRGB of a hue (degrees), saturation and value: Smith, "Color gamut transform pairs", SIGGRAPH 1978.
pub(super) fn rgb(hue_deg: f32, saturation: f32, value: f32) -> [f32; 3] {
    [5.0, 3.0, 1.0].map(|shift| {
        let place = (shift + hue_deg / 60.0).rem_euclid(6.0);
        value * (1.0 - saturation * place.min(4.0 - place).clamp(0.0, 1.0))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::texture::test_masks::drawn_share;

    #[test]
    fn hues_give_the_primary_colours() {
        assert_eq!(rgb(0.0, 1.0, 1.0), [1.0, 0.0, 0.0]);
        assert_eq!(rgb(60.0, 1.0, 0.5), [0.5, 0.5, 0.0]);
        assert_eq!(rgb(120.0, 1.0, 1.0), [0.0, 1.0, 0.0]);
        assert_eq!(rgb(240.0, 0.5, 1.0), [0.5, 0.5, 1.0]);
        assert_eq!(rgb(360.0, 1.0, 1.0), [1.0, 0.0, 0.0]);
        assert_eq!(rgb(200.0, 0.0, 0.3), [0.3; 3]);
    }

    #[test]
    fn a_plain_triangle_fills_half_the_square_and_ragged_ones_less() {
        let textured =
            |raggedness| polygon_texture(&ImpressionistCrown { raggedness, ..ImpressionistCrown::default() }, 3);
        let shares = [0.0, 0.3, 0.6, 1.0].map(|raggedness| drawn_share(&textured(raggedness), 0));
        assert!((shares[0] - 0.5).abs() < 0.005, "{shares:?}");
        assert!(shares.windows(2).all(|pair| pair[1] < pair[0]) && shares[3] > 0.2, "{shares:?}");
    }

    #[test]
    fn mips_keep_the_coverage_of_polygons() {
        for form in [CrownForm::Normal, CrownForm::Winter, CrownForm::Conifer] {
            let texture = polygon_texture(&ImpressionistCrown::of_form(form), 3);
            let full = drawn_share(&texture, 0);
            assert!(full > 0.05, "{form:?}: {full}");
            // Down to 16 x 16 texels.
            (1..5).for_each(|mip| assert!((drawn_share(&texture, mip) - full).abs() < 0.03, "{form:?}, mip {mip}"));
        }
    }
}
