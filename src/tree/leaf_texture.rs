//! The picture of one spray: a twig with its leaves, cut out by its alpha.
//!
//! The twig runs along the diagonal of the square from its lower left to its upper right corner, as the cards of
//! [`leaf_mesh`](super::leaf_mesh) want it. It is drawn in coordinates (along, across): along is 0 at the twig's root
//! and 1 at its tip, across in the same unit, so that the square is the region `|across| <= min(along, 1 - along)`.
//! Leaves are painted from the lowest to the topmost, each a closed-form outline with midrib and veins; what lies
//! below is darker. All is painted at twice the resolution and averaged.

use bevy::{math::Vec2, reflect::Reflect};
use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};
use serde::{Deserialize, Serialize};

use super::{
    foliage::Foliage,
    species::{SpeciesError, require, require_colour},
    texture::{Canvas, TextureData, linear, mix},
};

/// The leaves of a spray.
#[derive(Clone, Copy, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Leaf {
    /// Its shape.
    pub shape: LeafShape,
    /// Colour of a grown leaf, sRGB 0 to 1.
    pub colour: [f32; 3],
    /// Colour of a young one, sRGB 0 to 1.
    pub young_colour: [f32; 3],
    /// Colour of the twig, sRGB 0 to 1.
    pub twig_colour: [f32; 3],
    /// Length of a leaf as a share of the spray's, 0.01 to 0.6.
    pub length: f32,
    /// Width of a leaf as a share of its length, 0.02 to 1.
    pub width: f32,
    /// Side shoots of the spray, 0 to 40.
    pub shoots: u32,
    /// Distance between leaves along a shoot as a share of a leaf's length, 0.05 to 2.
    pub spacing: f32,
}

/// Outlines of leaves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Reflect, Serialize, Deserialize)]
pub enum LeafShape {
    /// Widest beyond the middle, with rounded lobes: an oak's.
    #[default]
    Lobed,
    /// Widest at the middle, pointed: a beech's.
    Oval,
    /// A needle.
    Needle,
}

impl Default for Leaf {
    fn default() -> Self {
        Self {
            shape: LeafShape::Lobed,
            colour: [0.22, 0.36, 0.11],
            young_colour: [0.42, 0.52, 0.16],
            twig_colour: [0.30, 0.25, 0.17],
            length: 0.2,
            width: 0.56,
            shoots: 7,
            spacing: 0.42,
        }
    }
}

impl Leaf {
    pub(super) fn validate(&self) -> Result<(), SpeciesError> {
        require_colour("colour", self.colour)?;
        require_colour("young_colour", self.young_colour)?;
        require_colour("twig_colour", self.twig_colour)?;
        require("length", self.length, 0.01..=0.6)?;
        require("width", self.width, 0.02..=1.0)?;
        require("shoots", self.shoots as f32, 0.0..=40.0)?;
        require("spacing", self.spacing, 0.05..=2.0)
    }
}

/// Side of the texture, texels.
const SIZE: usize = 512;
/// Texels painted per texel of the texture, in each direction.
const OVERSAMPLING: usize = 2;
/// Angle of the side shoots to the twig, radians.
const SHOOT_ANGLE_RAD: f32 = 0.85;
/// Brightness of the lowest leaves of a spray against the topmost.
const LOWEST_SHADE: f32 = 0.5;
/// Share of a broad-leaved shoot that bears no leaves.
const BARE_SHARE: f32 = 0.5;
/// Angles of the leaves at a shoot's tip, radians.
const ROSETTE_RAD: [f32; 5] = [0.0, 0.6, -0.55, 1.25, -1.2];
/// Margin of the square that stays empty, so that no leaf is cut straight.
const MARGIN: f32 = 0.02;

/// Paints a spray: colour and mask.
#[must_use]
pub fn leaf_texture(foliage: &Foliage, seed: u64) -> TextureData {
    let leaf = &foliage.leaf;
    let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
    let shoots = shoots(leaf, &mut random);
    let mut blades = Vec::new();
    shoots.iter().for_each(|shoot| shoot.leaf_out(leaf, &mut blades, &mut random));
    // Painter's order: sprays are seen from above, where the lighter leaves are.
    blades.sort_by(|a, b| a.level.total_cmp(&b.level));

    let ground = mix(linear(leaf.colour), [0.0; 3], 0.3);
    let mut painter = Painter::new(leaf, ground);
    shoots.iter().for_each(|shoot| painter.twig(shoot));
    blades.iter().for_each(|blade| painter.blade(blade));
    painter.canvas.downsampled().into_mask_texture()
}

/// A stretch of twig.
struct Shoot {
    root: Vec2,
    tip: Vec2,
    radius: f32,
}

/// A leaf on the drawing.
struct Blade {
    root: Vec2,
    direction: Vec2,
    length: f32,
    /// 0 lowest to 1 topmost.
    level: f32,
    /// 0 grown to 1 young.
    youth: f32,
    tone: f32,
}

/// The main shoot and its side shoots, left and right by turns, as long as the square allows.
fn shoots(leaf: &Leaf, random: &mut Xoshiro256PlusPlus) -> Vec<Shoot> {
    let reach = 0.96 - 0.85 * leaf.length;
    let mut shoots = vec![Shoot { root: Vec2::ZERO, tip: Vec2::new(reach, 0.0), radius: 0.0065 }];
    for index in 0..leaf.shoots {
        let share = (index as f32 + random.random_range(0.3..0.7)) / leaf.shoots as f32;
        let root = Vec2::new(0.08 + 0.76 * share, 0.0);
        let side = if index % 2 == 0 { 1.0 } else { -1.0 };
        let angle = SHOOT_ANGLE_RAD * random.random_range(0.85..1.1);
        let direction = Vec2::new(angle.cos(), side * angle.sin());
        let room = (room(root, direction) - 0.85 * leaf.length).max(0.25 * leaf.length);
        let length = room * random.random_range(0.65..1.0);
        shoots.push(Shoot { root, tip: root + direction * length, radius: 0.004 });
    }
    shoots
}

/// Distance from `root` along `direction` to the outline of the spray, to within a step.
fn room(root: Vec2, direction: Vec2) -> f32 {
    const STEP: f32 = 0.01;
    (1..100).map(|step| STEP * step as f32).take_while(|&far| inside(root + direction * far)).last().unwrap_or(0.0)
}

/// Whether a point lies in the spray's outline: the square, its far corners rounded off, for sprays are no diamonds.
fn inside(point: Vec2) -> bool {
    let in_square = point.y.abs() < point.x.min(1.0 - point.x) - MARGIN;
    let rounded = (point - Vec2::new(0.5, 0.0)) / Vec2::new(0.47, 0.42);
    in_square && (point.x < 0.3 || rounded.length_squared() < 1.0)
}

impl Shoot {
    /// Leaves along both sides and at the tip.
    fn leaf_out(&self, leaf: &Leaf, blades: &mut Vec<Blade>, random: &mut Xoshiro256PlusPlus) {
        let length = self.root.distance(self.tip);
        let direction = (self.tip - self.root).normalize_or(Vec2::X);
        let needles = leaf.shape == LeafShape::Needle;
        let step = leaf.spacing * leaf.length;
        // Broad leaves crowd towards the tips, so that a spray keeps gaps that show from afar.
        let mut along = if needles { 0.0 } else { BARE_SHARE * length };
        let mut side = if random.random::<bool>() { 1.0 } else { -1.0 };
        while along < length {
            let share = along / length.max(1e-3);
            let angle = side * if needles { random.random_range(0.25..1.05) } else { random.random_range(0.6..1.25) };
            self.grow(leaf, along, direction.rotate(Vec2::from_angle(angle)), share, blades, random);
            side = -side;
            along += step * random.random_range(0.7..1.3);
        }
        for angle in ROSETTE_RAD {
            let angle = angle + random.random_range(-0.2..0.2);
            self.grow(leaf, length, direction.rotate(Vec2::from_angle(angle)), 1.0, blades, random);
        }
    }

    fn grow(
        &self,
        leaf: &Leaf,
        along: f32,
        direction: Vec2,
        youth: f32,
        blades: &mut Vec<Blade>,
        random: &mut Xoshiro256PlusPlus,
    ) {
        let axis = (self.tip - self.root).normalize_or(Vec2::X);
        let root = self.root + axis * along;
        let length = leaf.length * (1.0 - 0.3 * youth * youth) * random.random_range(0.8..1.1);
        let middle = root + direction * (0.6 * length);
        let half = direction.perp() * (0.5 * leaf.width * length);
        let blade =
            Blade { root, direction, length, level: random.random(), youth: youth * youth, tone: random.random() };
        if [root + direction * length, middle + half, middle - half].into_iter().all(inside) {
            blades.push(blade);
        }
    }
}

struct Painter<'a> {
    leaf: &'a Leaf,
    canvas: Canvas,
    colour: [f32; 3],
    young: [f32; 3],
    bark: [f32; 3],
}

impl<'a> Painter<'a> {
    fn new(leaf: &'a Leaf, ground: [f32; 3]) -> Self {
        let canvas = Canvas::filled(SIZE * OVERSAMPLING, [ground[0], ground[1], ground[2], 0.0]);
        let (colour, young) = (linear(leaf.colour), linear(leaf.young_colour));
        Self { leaf, canvas, colour, young, bark: linear(leaf.twig_colour) }
    }

    fn twig(&mut self, shoot: &Shoot) {
        let axis = shoot.tip - shoot.root;
        let (radius, bark) = (shoot.radius, self.bark);
        let middle = shoot.root + 0.5 * axis;
        self.stamp(middle, 0.5 * axis.length() + radius, |point| {
            let share = ((point - shoot.root).dot(axis) / axis.length_squared()).clamp(0.0, 1.0);
            let off = point.distance(shoot.root + axis * share) / (radius * (1.0 - 0.5 * share));
            (off < 1.0).then(|| bark.map(|channel| channel * (1.1 - 0.6 * off * off)))
        });
    }

    fn blade(&mut self, blade: &Blade) {
        let shade = LOWEST_SHADE + (1.0 - LOWEST_SHADE) * blade.level;
        let base = mix(self.colour, self.young, (0.7 * blade.youth + 0.35 * blade.tone).min(1.0));
        let tone = shade * (0.85 + 0.3 * blade.tone);
        let (shape, width) = (self.leaf.shape, self.leaf.width);
        let middle = blade.root + blade.direction * (0.5 * blade.length);
        self.stamp(middle, 0.62 * blade.length, |point| {
            let local = (point - blade.root) / blade.length;
            let along = local.dot(blade.direction);
            let across = local.dot(blade.direction.perp()) / (0.5 * width);
            let relief = relief(shape, along, across)?;
            Some(base.map(|channel| channel * tone * relief))
        });
    }

    /// Paints what `paint` answers within `radius` of `centre`.
    fn stamp(&mut self, centre: Vec2, radius: f32, paint: impl Fn(Vec2) -> Option<[f32; 3]>) {
        let size = self.canvas.width as f32;
        // (along, across) to the unit square: x = along + across, y = 1 - along + across.
        let middle = Vec2::new(centre.x + centre.y, 1.0 - centre.x + centre.y) * size;
        let reach = Vec2::splat(radius * std::f32::consts::SQRT_2 * size + 1.0);
        let low = (middle - reach).clamp(Vec2::ZERO, Vec2::splat(size)).as_uvec2();
        let high = (middle + reach).clamp(Vec2::ZERO, Vec2::splat(size)).as_uvec2();
        for y in low.y..high.y {
            for x in low.x..high.x {
                let (u, v) = ((x as f32 + 0.5) / size, (y as f32 + 0.5) / size);
                let point = Vec2::new(0.5 * (u + 1.0 - v), 0.5 * (u + v - 1.0));
                if let Some([red, green, blue]) = paint(point) {
                    self.canvas.texels[y as usize * self.canvas.width + x as usize] = [red, green, blue, 1.0];
                }
            }
        }
    }
}

/// Brightness of a leaf at a place on it, `None` outside: `along` 0..1 from root to tip, `across` in half widths.
fn relief(shape: LeafShape, along: f32, across: f32) -> Option<f32> {
    if !(0.0..1.0).contains(&along) {
        return None;
    }
    let off = across.abs();
    if off > 1.05 {
        return None;
    }
    // Lobes and veins lean forward: both follow this slanted coordinate.
    let slanted = along - 0.16 * off;
    let (outline, lobes) = match shape {
        LeafShape::Lobed => {
            let body = (std::f32::consts::PI * along.powf(1.35)).sin().max(0.0).powf(0.75);
            (body * (0.80 + 0.22 * lobe_wave(slanted)), lobe_wave(slanted))
        }
        LeafShape::Oval => ((std::f32::consts::PI * along).sin(), lobe_wave(1.6 * slanted)),
        LeafShape::Needle => return (off < (4.0 * (1.0 - along)).min(1.0)).then_some(1.15 - 0.3 * off),
    };
    let petiole = if along < 0.14 { 0.05 } else { 0.0 };
    if off > outline.max(petiole) {
        return None;
    }
    let midrib = if off < 0.055 * (1.2 - along) { 1.35 } else { 1.0 };
    let vein = if lobes > 0.965 && off > 0.03 { 1.16 } else { 1.0 };
    let half = if across > 0.0 { 1.06 } else { 0.92 };
    let edge = 1.0 - 0.12 * (off / outline.max(0.05)).powi(4);
    Some(midrib * vein * half * edge)
}

/// One crest per lobe.
fn lobe_wave(slanted: f32) -> f32 {
    (std::f32::consts::TAU * (4.6 * slanted + 0.35)).cos()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tree::texture::MASK_CUT_OFF;

    fn drawn_share(mip: &[u8]) -> f32 {
        let drawn = mip.chunks_exact(4).filter(|texel| f32::from(texel[3]) / 255.0 > MASK_CUT_OFF).count();
        drawn as f32 / (mip.len() / 4) as f32
    }

    fn foliage(shape: LeafShape) -> Foliage {
        let leaf = match shape {
            LeafShape::Needle => Leaf { shape, length: 0.06, width: 0.1, shoots: 20, spacing: 0.15, ..Leaf::default() },
            LeafShape::Lobed | LeafShape::Oval => Leaf { shape, ..Leaf::default() },
        };
        Foliage { leaf, ..Foliage::default() }
    }

    #[test]
    fn distance_does_not_thin_the_leaves() {
        for shape in [LeafShape::Lobed, LeafShape::Oval, LeafShape::Needle] {
            let texture = leaf_texture(&foliage(shape), 4);
            let full = drawn_share(&texture.mips[0]);
            assert!((0.2..0.85).contains(&full), "{shape:?}: {full} of the card is leaf");
            // Down to 16 x 16 texels, of which one is 0.4%.
            for mip in &texture.mips[1..6] {
                assert!((drawn_share(mip) - full).abs() < 0.03, "{shape:?}: {} against {full}", drawn_share(mip));
            }
        }
    }

    #[test]
    fn no_leaf_is_cut_by_the_square_except_the_twig_at_its_root() {
        let texture = leaf_texture(&foliage(LeafShape::Lobed), 4);
        let drawn = |x: usize, y: usize| texture.mips[0][4 * (y * SIZE + x) + 3] > 127;
        let edge = (0..SIZE).flat_map(|k| [(k, 0), (SIZE - 1, k), (0, k), (k, SIZE - 1)]);
        let cut = edge.filter(|&(x, y)| drawn(x, y) && !(x < 12 && y > SIZE - 12)).count();
        assert_eq!(cut, 0);
    }

    #[test]
    fn extreme_leaves_are_painted_too() {
        for (length, shoots, spacing) in [(0.6, 0, 2.0), (0.01, 40, 0.3)] {
            let leaf = Leaf { length, shoots, spacing, ..Leaf::default() };
            leaf.validate().unwrap();
            assert_eq!(leaf_texture(&Foliage { leaf, ..Foliage::default() }, 1).mips.len(), 10);
        }
    }
}
