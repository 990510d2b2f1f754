//! The textures of a bark: normals and occlusion from the heights of its pattern, colour from its parts.

use bevy::math::Vec2;

use super::{
    Bark,
    pattern::{Pattern, Point},
};
use crate::texture::{LinearImage, TextureData, blurred, linear, mix};

/// The textures of a bark; all tile in both directions, u around the branch, v along it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BarkTextures {
    /// Colour, sRGB, opaque.
    pub base_colour: TextureData,
    /// Tangent-space normals, +x along u, +y against v (up in the image), linear.
    pub normal: TextureData,
    /// Ambient occlusion in red (1 is open), roughness in green, metal (none) in blue, linear, as glTF has it: one image
    /// for both `occlusion_texture` and `metallic_roughness_texture`.
    pub surface: TextureData,
}

/// Side of the textures, texels.
pub(super) const SIZE: usize = 512;
/// How far furrows shade themselves, texels.
const OCCLUSION_REACH: usize = 9;
/// Occlusion for a furrow as deep as a plate is wide.
const OCCLUSION: f32 = 1.5;
/// Share of the occlusion that darkens the colour as well, because furrows shade direct light, too.
const OCCLUSION_IN_COLOUR: f32 = 0.6;

/// Renders the textures of a bark.
#[must_use]
pub fn bark_textures(bark: &Bark, seed: u64) -> BarkTextures {
    let pattern = Pattern::new(bark, seed as u32 ^ (seed >> 32) as u32);
    let points: Vec<Point> = (0..SIZE * SIZE)
        .map(|index| {
            let texel = Vec2::new((index % SIZE) as f32 + 0.5, (index / SIZE) as f32 + 0.5);
            pattern.at(texel / SIZE as f32)
        })
        .collect();
    let heights: Vec<f32> = points.iter().map(|point| point.height).collect();
    let around = blurred(&heights, SIZE, OCCLUSION_REACH);
    let colours = Colours::of(bark);
    let mut base_colour = LinearImage::filled(SIZE, [0.0; 4]);
    let mut normal = LinearImage::filled(SIZE, [0.0; 4]);
    let mut surface = LinearImage::filled(SIZE, [0.0; 4]);
    let slope = bark.depth * SIZE as f32 / (2.0 * bark.plates_around as f32);
    for (index, point) in points.iter().enumerate() {
        let sunk = (around[index] - point.height).max(0.0);
        let open = 1.0 / (1.0 + OCCLUSION * (0.3 + bark.depth) * sunk * 2.0);
        base_colour.texels[index] = colours.at(point, 1.0 - OCCLUSION_IN_COLOUR * (1.0 - open));
        surface.texels[index] = [open, 0.95 - 0.12 * point.face, 0.0, 1.0];
        let lean = gradient(&heights, index % SIZE, index / SIZE) * slope;
        normal.texels[index] = [-lean.x, lean.y, 1.0, 1.0];
    }
    BarkTextures {
        base_colour: base_colour.into_colour_texture(),
        normal: normal.into_normal_texture(),
        surface: surface.into_linear_texture(),
    }
}

/// Linear colours.
struct Colours {
    face: [f32; 3],
    furrow: [f32; 3],
    accent: [f32; 3],
    lichen: [f32; 3],
}

impl Colours {
    fn of(bark: &Bark) -> Self {
        Self {
            face: linear(bark.colour),
            furrow: linear(bark.furrow_colour),
            accent: linear(bark.accent_colour),
            lichen: linear(bark.lichen_colour),
        }
    }

    fn at(&self, point: &Point, light: f32) -> [f32; 4] {
        let bare = mix(self.face, self.accent, point.accent);
        let face = mix(bare, self.lichen, 0.8 * point.lichen).map(|channel| channel * point.tone);
        let [red, green, blue] = mix(self.furrow, face, point.face).map(|channel| channel * light);
        [red, green, blue, 1.0]
    }
}

/// Rise over two texels, towards +u and +v.
fn gradient(heights: &[f32], x: usize, y: usize) -> Vec2 {
    let height = |x: usize, y: usize| heights[(y % SIZE) * SIZE + x % SIZE];
    Vec2::new(height(x + 1, y) - height(x + SIZE - 1, y), height(x, y + 1) - height(x, y + SIZE - 1))
}

#[cfg(test)]
mod tests;
