//! The textures of one spray, a twig with its leaves: colour with an alpha mask, and normals.
//!
//! The twig runs along the diagonal of the square from its lower left to its upper right corner, as the cards of
//! `leaf_mesh.rs` expect it. Leaves are drawn from the lowest to the topmost. Coverage comes from
//! the signed distance to the margin, in texels. Each leaf shades what lies below it.

use bevy::math::Vec2;

use super::{
    blade::{Blade, Place},
    settings::Leaf,
    spray::{PlacedLeaf, Shoot, spray},
};
use crate::{
    texture::{
        LinearImage, TextureData,
        fourier::{Combination, FourierTexture, FourierWaves},
        linear, mix,
    },
    tree::{foliage::Foliage, green_wood::GreenWood},
};

pub use bare_spray::bare_spray_texture;

/// The two textures of a spray.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LeafTextures {
    /// Colour, sRGB, and mask.
    pub base_colour: TextureData,
    /// Tangent-space normals, +x along u, +y against v, linear; in alpha the share of light that comes through, against
    /// the species': less in veins, none in twigs.
    pub normal: TextureData,
}

/// Side of the texture, texels.
const SIZE: usize = 512;
/// Brightness of the lowest leaves of a spray against the topmost.
const LOWEST_SHADE: f32 = 0.55;
/// Darkness of the shade of a leaf, and how far it reaches beyond the leaf, in lengths of the spray.
const SHADE: f32 = 0.38;
const SHADE_REACH: f32 = 0.012;

/// Renders the textures of a spray, whose twig and side shoots may be green.
#[must_use]
pub fn leaf_textures(foliage: &Foliage, green: &GreenWood, seed: u64) -> LeafTextures {
    let leaf = &foliage.leaf;
    let (shoots, mut leaves) = spray(leaf, seed);
    // The topmost leaves come last: sprays are seen from above, where the lighter leaves are.
    leaves.sort_by(|a, b| a.level.total_cmp(&b.level));

    let blade = Blade::new(leaf);
    let mut canvas = SprayCanvas::new(leaf, SIZE);
    let [twig, side_shoots] = green.of_spray(leaf.twig_colour);
    // A quarter of the leaves is below the twigs.
    let below = leaves.len() / 4;
    leaves[..below].iter().for_each(|leaf| canvas.leaf(&blade, leaf));
    for (index, shoot) in shoots.iter().enumerate() {
        canvas.twig(shoot, if index == 0 { twig } else { side_shoots });
    }
    leaves[below..].iter().for_each(|leaf| canvas.leaf(&blade, leaf));
    LeafTextures { base_colour: canvas.colours.into_mask_texture(), normal: canvas.normals.into_normal_texture() }
}

/// What is blended over a texel: coverage, colour, normal and translucency; or shade, where nothing covers it.
struct Fragment {
    coverage: f32,
    shade: f32,
    colour: [f32; 3],
    normal: [f32; 4],
}

/// A few waves to a leaf.
fn waves(leaf: &Leaf) -> Option<FourierWaves> {
    let texture = FourierTexture {
        terms: 4,
        first_frequency_rad: std::f32::consts::TAU / leaf.length.max(0.05),
        combination: Combination::Sum,
        ..FourierTexture::default()
    };
    (leaf.mottle > 0.0).then(|| texture.waves().ok()).flatten()
}

struct SprayCanvas {
    /// Side, texels.
    size: usize,
    /// How far the Fourier texture darkens and lightens leaves; no waves where it does not.
    mottle: f32,
    waves: Option<FourierWaves>,
    colours: LinearImage,
    normals: LinearImage,
    colour: [f32; 3],
    young: [f32; 3],
    back: [f32; 3],
}

impl SprayCanvas {
    fn new(leaf: &Leaf, size: usize) -> Self {
        let colour = linear(leaf.colour);
        let ground = mix(colour, [0.0; 3], 0.3);
        Self {
            size,
            mottle: leaf.mottle,
            waves: waves(leaf),
            colours: LinearImage::filled(size, [ground[0], ground[1], ground[2], 0.0]),
            normals: LinearImage::filled(size, [0.0, 0.0, 1.0, 1.0]),
            colour,
            young: linear(leaf.young_colour),
            back: linear(leaf.back_colour),
        }
    }

    /// Texels in a unit of length: the twig runs along the diagonal.
    fn texels(size: usize) -> f32 {
        size as f32 * std::f32::consts::SQRT_2
    }

    fn twig(&mut self, shoot: &Shoot, bark: [f32; 3]) {
        let axis = shoot.tip - shoot.root;
        let (radius, texels) = (shoot.radius, Self::texels(self.size));
        let direction = axis.normalize_or(Vec2::X);
        self.draw(shoot.root + 0.5 * axis, 0.5 * axis.length() + 2.0 * radius, |point| {
            let share = ((point - shoot.root).dot(axis) / axis.length_squared().max(1e-9)).clamp(0.0, 1.0);
            let tapered = radius * (1.0 - 0.5 * share);
            let side = (point - shoot.root - axis * share).dot(direction.perp()) / tapered;
            let off = point.distance(shoot.root + axis * share);
            let coverage = (0.5 + (tapered - off) * texels).clamp(0.0, 1.0);
            let lit = 1.1 - 0.5 * side.clamp(-1.0, 1.0).powi(2);
            let normal = normal(direction.perp() * side.clamp(-0.9, 0.9), 0.0);
            Some(Fragment { coverage, shade: 0.0, colour: bark.map(|channel| channel * lit), normal })
        });
    }

    fn leaf(&mut self, blade: &Blade, leaf: &PlacedLeaf) {
        let level = LOWEST_SHADE + (1.0 - LOWEST_SHADE) * leaf.level;
        let grown = mix(self.colour, self.young, (0.75 * leaf.youth + 0.35 * leaf.tone).min(1.0));
        let base = if leaf.turned { mix(grown, self.back, 0.85) } else { grown };
        let tone = level * (0.85 + 0.3 * leaf.tone);
        let texels = leaf.length * leaf.projected.min_element() * Self::texels(self.size);
        let middle = leaf.root + leaf.direction * (0.5 * leaf.length);
        let (mottle, waves) = (self.mottle, self.waves.clone());
        let mottling = |point: Vec2| waves.as_ref().map_or(1.0, |waves| 1.0 + mottle * (waves.at(point) - 0.5));
        // Bent leaves reach a little further.
        self.draw(middle, (blade.reach() + leaf.bend.abs()) * leaf.length, |point| {
            let place = blade.at(leaf.local(point))?;
            let coverage = (0.5 + place.inside * texels).clamp(0.0, 1.0);
            let near = 1.0 + place.inside * leaf.length / SHADE_REACH;
            let shade = SHADE * near.clamp(0.0, 1.0);
            if coverage <= 0.0 && shade <= 0.0 {
                return None;
            }
            let side = if leaf.turned { -1.0 } else { 1.0 };
            let tone = tone * mottling(point);
            let slope = leaf.direction * place.slope.x + leaf.direction.perp() * place.slope.y;
            Some(Fragment {
                coverage,
                shade,
                colour: colour(base, tone, leaf, &place),
                normal: normal(-side * slope, 1.0 - 0.55 * place.vein),
            })
        });
    }

    /// Blends the fragments of a shape that lies within `radius` of `centre`.
    fn draw(&mut self, centre: Vec2, radius: f32, shape: impl Fn(Vec2) -> Option<Fragment>) {
        let (across, size) = (self.size, self.size as f32);
        // (along, across) to the unit square: x = along + across, y = 1 - along + across.
        let middle = Vec2::new(centre.x + centre.y, 1.0 - centre.x + centre.y) * size;
        let reach = Vec2::splat(radius * std::f32::consts::SQRT_2 * size + 1.0);
        let low = (middle - reach).clamp(Vec2::ZERO, Vec2::splat(size)).as_uvec2();
        let high = (middle + reach).clamp(Vec2::ZERO, Vec2::splat(size)).as_uvec2();
        for y in low.y..high.y {
            for x in low.x..high.x {
                let (u, v) = ((x as f32 + 0.5) / size, (y as f32 + 0.5) / size);
                let point = Vec2::new(0.5 * (u + 1.0 - v), 0.5 * (u + v - 1.0));
                if let Some(fragment) = shape(point) {
                    self.blend(y as usize * across + x as usize, &fragment);
                }
            }
        }
    }

    /// One texel: what is there is shaded, then covered (Porter & Duff 1984, "over").
    fn blend(&mut self, index: usize, fragment: &Fragment) {
        let below = &mut self.colours.texels[index];
        let kept = below[3] * (1.0 - fragment.coverage);
        let alpha = kept + fragment.coverage;
        if alpha > 0.0 {
            for (channel, &over) in below[..3].iter_mut().zip(&fragment.colour) {
                let shaded = *channel * (1.0 - fragment.shade);
                *channel = (kept * shaded + fragment.coverage * over) / alpha;
            }
            below[3] = alpha;
        }
        let normal = &mut self.normals.texels[index];
        for (channel, &over) in normal.iter_mut().zip(&fragment.normal) {
            *channel += (over - *channel) * fragment.coverage;
        }
    }
}

/// Colour of a place on a leaf: paler veins, one half a little brighter, a darker rim.
fn colour(base: [f32; 3], tone: f32, leaf: &PlacedLeaf, place: &Place) -> [f32; 3] {
    let light = 1.0 + 0.5 * place.slope.y.clamp(-0.3, 0.3) * if leaf.turned { -1.0 } else { 1.0 };
    let rim = 0.84 + 0.16 * (place.inside / 0.03).clamp(0.0, 1.0);
    let pale = mix(base, [0.42, 0.50, 0.20], if leaf.turned { 0.45 } else { 0.35 });
    mix(base, pale, place.vein).map(|channel| channel * tone * light * rim)
}

/// A normal that leans by `lean` (along, across), as the texture sees it, and a translucency.
fn normal(lean: Vec2, translucency: f32) -> [f32; 4] {
    const HALF: f32 = std::f32::consts::FRAC_1_SQRT_2;
    // u = along + across, up = along - across.
    [HALF * (lean.x + lean.y), HALF * (lean.x - lean.y), 1.0, translucency]
}

mod bare_spray;
#[cfg(test)]
mod tests;
