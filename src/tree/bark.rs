//! Bark: plates parted by furrows, drawn as a height field that tiles.
//!
//! Plates are the cells of a jittered grid, longer along the branch than around it (Worley 1996): the difference of
//! the distances to the nearest and the second nearest centre is 0 in a furrow and grows towards the plate's middle.
//! The plane is warped by periodic gradient noise (Perlin 1985) before, so that furrows wind, and roughened after.

use bevy::{math::Vec2, reflect::Reflect};
use serde::{Deserialize, Serialize};

use super::{
    species::{SpeciesError, require, require_colour},
    texture::{Canvas, TextureData, linear, mix},
};

/// What the bark of a species looks like.
#[derive(Clone, Copy, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Bark {
    /// Colour of the plates, sRGB 0 to 1.
    pub colour: [f32; 3],
    /// Colour in the furrows, sRGB 0 to 1.
    pub furrow_colour: [f32; 3],
    /// Lichen and algae on the plates, sRGB 0 to 1.
    pub lichen_colour: [f32; 3],
    /// How much of the plates they cover, 0 to 1.
    pub lichen: f32,
    /// Side of the square that repeats, m: 0.05 to 10.
    pub tile_m: f32,
    /// Plates around that square, 1 to 32.
    pub plates_around: u32,
    /// Plates along it, 1 to 32.
    pub plates_along: u32,
    /// Width of the furrows as a share of a plate's, 0.02 to 1.
    pub furrow_width: f32,
    /// How much furrows wind, as a share of a plate, 0 to 2.
    pub winding: f32,
    /// Depth of the furrows as a share of a plate's width, 0 to 1.
    pub depth: f32,
    /// Roughness of the plates' faces, 0 to 1.
    pub roughness: f32,
}

impl Default for Bark {
    /// A pedunculate oak's: long ridges, deep furrows.
    fn default() -> Self {
        Self {
            colour: [0.46, 0.41, 0.35],
            furrow_colour: [0.15, 0.12, 0.10],
            lichen_colour: [0.47, 0.49, 0.38],
            lichen: 0.35,
            tile_m: 0.9,
            plates_around: 11,
            plates_along: 4,
            furrow_width: 0.45,
            winding: 0.55,
            depth: 0.5,
            roughness: 0.5,
        }
    }
}

impl Bark {
    pub(super) fn validate(&self) -> Result<(), SpeciesError> {
        require_colour("colour", self.colour)?;
        require_colour("furrow_colour", self.furrow_colour)?;
        require_colour("lichen_colour", self.lichen_colour)?;
        require("lichen", self.lichen, 0.0..=1.0)?;
        require("tile_m", self.tile_m, 0.05..=10.0)?;
        require("plates_around", self.plates_around as f32, 1.0..=32.0)?;
        require("plates_along", self.plates_along as f32, 1.0..=32.0)?;
        require("furrow_width", self.furrow_width, 0.02..=1.0)?;
        require("winding", self.winding, 0.0..=2.0)?;
        require("depth", self.depth, 0.0..=1.0)?;
        require("roughness", self.roughness, 0.0..=1.0)
    }
}

/// The two textures of a bark; both tile in both directions, u around the branch, v along it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BarkTextures {
    /// Colour, sRGB, opaque.
    pub base_colour: TextureData,
    /// Tangent-space normals, +x along u, +y against v (up in the image), linear.
    pub normal: TextureData,
}

/// Side of the textures, texels.
const SIZE: usize = 512;

/// Paints a bark.
#[must_use]
pub fn bark_textures(bark: &Bark, seed: u64) -> BarkTextures {
    let surface = Surface {
        bark,
        colour: linear(bark.colour),
        furrow: linear(bark.furrow_colour),
        lichen: linear(bark.lichen_colour),
        seed: seed as u32 ^ (seed >> 32) as u32,
    };
    let points: Vec<Point> = (0..SIZE * SIZE)
        .map(|index| {
            let texel = Vec2::new((index % SIZE) as f32 + 0.5, (index / SIZE) as f32 + 0.5);
            surface.at(texel / SIZE as f32)
        })
        .collect();
    let mut base_colour = Canvas::filled(SIZE, [0.0; 4]);
    let mut normal = Canvas::filled(SIZE, [0.0; 4]);
    for (index, point) in points.iter().enumerate() {
        base_colour.texels[index] = surface.colour(point);
        normal.texels[index] = surface.normal(&points, index % SIZE, index / SIZE);
    }
    BarkTextures { base_colour: base_colour.into_colour_texture(), normal: normal.into_normal_texture() }
}

/// One texel's worth of bark.
#[derive(Clone, Copy)]
struct Point {
    /// 0 at the bottom of a furrow to 1 on a plate.
    plate: f32,
    /// Height in plate widths.
    height: f32,
    /// Fine grain, -1..1.
    grain: f32,
    /// Tone of this plate, 0..1.
    tone: f32,
    /// Lichen, 0..1.
    lichen: f32,
}

struct Surface<'a> {
    bark: &'a Bark,
    /// Linear colours of plates, furrows and lichen.
    colour: [f32; 3],
    furrow: [f32; 3],
    lichen: [f32; 3],
    seed: u32,
}

impl Surface<'_> {
    fn at(&self, uv: Vec2) -> Point {
        let bark = self.bark;
        let plates = Vec2::new(bark.plates_around as f32, bark.plates_along as f32);
        let warp = Vec2::new(self.noise(uv, 6, 5, 1) + 0.5 * self.noise(uv, 14, 12, 2), self.noise(uv, 7, 4, 3));
        let fine_warp = self.noise(uv, 40, 20, 4);
        let cells = uv * plates + warp * bark.winding + Vec2::X * (0.12 * fine_warp);
        let (edge, tone) = self.cell(cells);
        let grain = 0.6 * self.noise(uv, 96, 24, 5) + 0.4 * self.noise(uv, 128, 128, 6);
        let plate = smoothstep(0.0, bark.furrow_width, edge + 0.10 * grain * bark.roughness);
        let crack = smoothstep(0.55, 0.8, self.noise(uv, 24, 40, 7).abs() + 0.3 * grain.abs());
        let height = plate * (0.75 + 0.25 * tone) + bark.roughness * (0.14 * grain - 0.12 * crack * plate);
        let patches = self.noise(uv, 5, 5, 8) + 0.5 * self.noise(uv, 17, 17, 9) + 0.35 * grain;
        let lichen = smoothstep(0.75 - bark.lichen, 1.15 - bark.lichen, patches) * plate;
        Point { plate, height, grain, tone, lichen }
    }

    fn colour(&self, point: &Point) -> [f32; 4] {
        let plate = mix(self.colour, self.lichen, 0.8 * point.lichen);
        let shade = 0.75 + 0.35 * point.tone + 0.35 * point.grain * self.bark.roughness;
        let colour = mix(self.furrow, plate.map(|channel| channel * shade), point.plate);
        [colour[0], colour[1], colour[2], 1.0]
    }

    fn normal(&self, points: &[Point], x: usize, y: usize) -> [f32; 4] {
        let height = |x: usize, y: usize| points[(y % SIZE) * SIZE + x % SIZE].height;
        let scale = self.bark.depth * SIZE as f32 / (2.0 * self.bark.plates_around as f32);
        let along_u = (height(x + 1, y) - height(x + SIZE - 1, y)) * scale;
        let along_v = (height(x, y + 1) - height(x, y + SIZE - 1)) * scale;
        [-along_u, along_v, 1.0, 1.0]
    }

    /// Difference of the distances to the two nearest plate centres, and the nearest plate's tone.
    fn cell(&self, point: Vec2) -> (f32, f32) {
        let (columns, rows) = (self.bark.plates_around as i32, self.bark.plates_along as i32);
        let home = point.floor();
        let (home_x, home_y) = ((home.x as i32).rem_euclid(columns), (home.y as i32).rem_euclid(rows));
        let (mut nearest, mut second, mut tone) = (f32::INFINITY, f32::INFINITY, 0.0);
        for step in 0..9 {
            let (dx, dy) = (step % 3 - 1, step / 3 - 1);
            let hash = self.hash(wrapped(home_x + dx, columns), wrapped(home_y + dy, rows), 0);
            let jitter = Vec2::new(unit(hash), unit(hash.rotate_left(11)));
            let centre = home + Vec2::new(dx as f32, dy as f32) + jitter;
            let distance = centre.distance_squared(point);
            if distance < nearest {
                (second, nearest, tone) = (nearest, distance, unit(hash.rotate_left(23)));
            } else {
                second = second.min(distance);
            }
        }
        (second.sqrt() - nearest.sqrt(), tone)
    }

    /// Gradient noise of whole periods over the tile, about -1..1; `uv` within 0..1.
    fn noise(&self, uv: Vec2, columns: i32, rows: i32, salt: u32) -> f32 {
        let point = uv * Vec2::new(columns as f32, rows as f32);
        // `uv` is not negative, so truncation is the floor (which is a call on plain x86-64).
        let (home_x, home_y) = (point.x as i32, point.y as i32);
        let within = point - Vec2::new(home_x as f32, home_y as f32);
        let corner = |dx: i32, dy: i32| {
            let hash = self.hash(wrapped(home_x + dx, columns), wrapped(home_y + dy, rows), salt);
            GRADIENTS[(hash & 7) as usize].dot(within - Vec2::new(dx as f32, dy as f32))
        };
        let fade = within * within * (Vec2::splat(3.0) - 2.0 * within);
        let top = corner(0, 0) + (corner(1, 0) - corner(0, 0)) * fade.x;
        let bottom = corner(0, 1) + (corner(1, 1) - corner(0, 1)) * fade.x;
        1.4 * (top + (bottom - top) * fade.y)
    }

    /// Mixes lattice point, salt and seed (the finaliser of `MurmurHash3`).
    fn hash(&self, x: i32, y: i32, salt: u32) -> u32 {
        let mut hash = self.seed ^ (x as u32).wrapping_mul(0x9e37_79b1) ^ (y as u32).wrapping_mul(0x85eb_ca77);
        hash ^= salt.wrapping_mul(0xc2b2_ae3d);
        hash = (hash ^ (hash >> 16)).wrapping_mul(0x85eb_ca6b);
        hash = (hash ^ (hash >> 13)).wrapping_mul(0xc2b2_ae35);
        hash ^ (hash >> 16)
    }
}

const DIAGONAL: f32 = std::f32::consts::FRAC_1_SQRT_2;

/// The directions in which gradient noise may rise.
const GRADIENTS: [Vec2; 8] = [
    Vec2::X,
    Vec2::NEG_X,
    Vec2::Y,
    Vec2::NEG_Y,
    Vec2::splat(DIAGONAL),
    Vec2::splat(-DIAGONAL),
    Vec2::new(DIAGONAL, -DIAGONAL),
    Vec2::new(-DIAGONAL, DIAGONAL),
];

/// The lattice point past the last is the first again, and the one before the first the last.
fn wrapped(index: i32, count: i32) -> i32 {
    match index {
        _ if index >= count => index - count,
        _ if index < 0 => index + count,
        _ => index,
    }
}

/// The low bits as a share of one.
fn unit(hash: u32) -> f32 {
    (hash & 0xffff) as f32 / 65_536.0
}

fn smoothstep(low: f32, high: f32, value: f32) -> f32 {
    let share = ((value - low) / (high - low)).clamp(0.0, 1.0);
    share * share * (3.0 - 2.0 * share)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Mean difference of the colours of two columns (or rows) of texels, 0..255.
    fn difference(texture: &TextureData, first: impl Fn(usize) -> usize, second: impl Fn(usize) -> usize) -> f32 {
        let texel = |index: usize| &texture.mips[0][4 * index..4 * index + 3];
        let apart = |k: usize| -> f32 {
            texel(first(k)).iter().zip(texel(second(k))).map(|(&a, &b)| f32::from(a.abs_diff(b))).sum()
        };
        (0..SIZE).map(apart).sum::<f32>() / (3 * SIZE) as f32
    }

    #[test]
    fn bark_tiles_without_a_seam() {
        let textures = bark_textures(&Bark::default(), 3);
        for texture in [&textures.base_colour, &textures.normal] {
            let column = |x: usize| move |y: usize| y * SIZE + x;
            let row = |y: usize| move |x: usize| y * SIZE + x;
            let across_seam = difference(texture, column(SIZE - 1), column(0));
            let inside: f32 =
                (1..9).map(|k| difference(texture, column(50 * k), column(50 * k + 1))).sum::<f32>() / 8.0;
            // A seam would differ like strangers, several times as much as neighbours do.
            assert!(across_seam < 1.7 * inside, "{across_seam} across the seam, {inside} inside");
            let across_seam = difference(texture, row(SIZE - 1), row(0));
            let inside: f32 = (1..9).map(|k| difference(texture, row(50 * k), row(50 * k + 1))).sum::<f32>() / 8.0;
            assert!(across_seam < 1.7 * inside, "{across_seam} across the seam, {inside} inside");
        }
    }

    #[test]
    fn bark_repeats_for_its_seed_only() {
        let bark = Bark { plates_around: 5, ..Bark::default() };
        assert_eq!(bark_textures(&bark, 1), bark_textures(&bark, 1));
        assert_ne!(bark_textures(&bark, 1), bark_textures(&bark, 2));
    }

    #[test]
    fn extreme_barks_are_painted_too() {
        for plates in [1, 32] {
            let bark =
                Bark { plates_around: plates, plates_along: plates, winding: 2.0, depth: 1.0, ..Bark::default() };
            bark.validate().unwrap();
            assert_eq!(bark_textures(&bark, 9).normal.mips[0].len(), 4 * SIZE * SIZE);
        }
    }
}
