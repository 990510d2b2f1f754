//! What rays hit, gathered in texels, and made textures with mips.
//!
//! A texel keeps sums over its rays. A mip has the means of those sums, so that empty texels add no colour. Where no ray
//! hit anything, colour comes from the coarser mips, so that no dark rim shows when textures are filtered.

use bevy::math::Vec3;

use crate::texture::{HALF_A_STEP, MASK_CUT_OFF, Texels, TextureData, colour_bytes, linear_bytes};

/// How much a texel's coverage is mixed with that of the next coarser mip, for a mask. The few rays of a texel make few
/// steps of coverage; this makes steps between them, and the outline a little smoother.
const SOFTNESS: f32 = 0.25;

/// What one ray hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::lod) struct Sample {
    /// Light that is scattered there of white light, linear, with the shade of the crown.
    pub colour: [f32; 3],
    /// Unit normal of the surface, tree-local: leaves face as their vertices do, whichever side is hit.
    pub normal: Vec3,
    /// Share of the species' translucency, 0 to 1; 0 for wood.
    pub translucency: f32,
    /// How far along the ray, 0 to 1. No texture keeps it; tests know by it that rays hit the same thing.
    pub depth: f32,
}

/// What the alpha of a texel means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::lod) enum Alpha {
    /// Whether it passes a mask: bent so that as many texels of a tile pass the cut-off, in every mip, as rays hit the tree.
    Mask,
    /// The share of its rays that hit something.
    Coverage,
}

/// Means over the rays of a texel, those that hit nothing counting as 0.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(in crate::lod) struct Texel {
    colour: Vec3,
    normal: Vec3,
    translucency: f32,
    /// Share of rays that hit something.
    pub coverage: f32,
}

/// The surface that is seen in a texel.
#[derive(Clone, Copy)]
struct Surface {
    colour: Vec3,
    /// Mean of unit normals: the shorter, the more they differ.
    normal: Vec3,
    translucency: f32,
}

/// Of a texel of whose surroundings nothing is known.
const UNKNOWN: Surface = Surface { colour: Vec3::ZERO, normal: Vec3::ZERO, translucency: 0.0 };

impl Texel {
    /// Adds what a ray hit that is `share` of the texel.
    pub fn add(&mut self, sample: &Sample, share: f32) {
        self.colour += Vec3::from_array(sample.colour) * share;
        self.normal += sample.normal * share;
        self.translucency += sample.translucency * share;
        self.coverage += share;
    }

    fn mean(texels: [&Self; 4]) -> Self {
        let mean = |value: fn(&Self) -> f32| 0.25 * texels.iter().map(|texel| value(texel)).sum::<f32>();
        let mean_vector = |value: fn(&Self) -> Vec3| 0.25 * texels.iter().map(|texel| value(texel)).sum::<Vec3>();
        Self {
            colour: mean_vector(|texel| texel.colour),
            normal: mean_vector(|texel| texel.normal),
            translucency: mean(|texel| texel.translucency),
            coverage: mean(|texel| texel.coverage),
        }
    }

    /// The surface that its rays hit; without hits, that of its surroundings.
    fn surface_or(&self, surroundings: Surface) -> Surface {
        if self.coverage <= 0.0 {
            return surroundings;
        }
        Surface {
            colour: self.colour / self.coverage,
            normal: self.normal / self.coverage,
            translucency: self.translucency / self.coverage,
        }
    }
}

/// Texels in rows from the top.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::lod) struct TexelGrid {
    pub width: usize,
    pub height: usize,
    pub texels: Vec<Texel>,
}

/// A grid with its mips, ready to become textures.
pub(in crate::lod) struct TexelMips {
    width: usize,
    height: usize,
    /// From the finest.
    mips: Vec<Mip>,
}

struct Mip {
    width: usize,
    surfaces: Vec<Surface>,
    alphas: Vec<f32>,
}

impl TexelGrid {
    pub fn new(width: usize, height: usize) -> Self {
        Self { width, height, texels: vec![Texel::default(); width * height] }
    }

    /// Adds what each ray of a tile hit, by its column and row: `per_texel` x `per_texel` rays to a texel.
    pub fn add_rays(
        &mut self,
        [left, top]: [usize; 2],
        [width, height]: [usize; 2],
        per_texel: usize,
        sample: impl Fn(usize, usize) -> Option<Sample>,
    ) {
        let share = 1.0 / (per_texel * per_texel) as f32;
        for row in 0..height * per_texel {
            let first = (top + row / per_texel) * self.width + left;
            for column in 0..width * per_texel {
                if let Some(sample) = sample(column, row) {
                    self.texels[first + column / per_texel].add(&sample, share);
                }
            }
        }
    }

    /// Share of all rays that hit something.
    pub fn coverage(&self) -> f32 {
        self.texels.iter().map(|texel| texel.coverage).sum::<f32>() / self.texels.len() as f32
    }

    /// Mean colour of what was hit, linear.
    pub fn mean_colour(&self) -> [f32; 3] {
        let (colour, coverage) = self
            .texels
            .iter()
            .fold((Vec3::ZERO, 0.0), |(colour, coverage), texel| (colour + texel.colour, coverage + texel.coverage));
        (colour / coverage.max(1e-6)).to_array()
    }

    fn halved(&self) -> Self {
        let (width, height) = (self.width.div_ceil(2), self.height.div_ceil(2));
        let at = |x: usize, y: usize| &self.texels[y.min(self.height - 1) * self.width + x.min(self.width - 1)];
        let texel = |index: usize| {
            let (x, y) = (2 * (index % width), 2 * (index / width));
            Texel::mean([at(x, y), at(x + 1, y), at(x, y + 1), at(x + 1, y + 1)])
        };
        Self { width, height, texels: (0..width * height).map(texel).collect() }
    }

    /// Makes the mips of a grid of tiles of `tile_width` x `tile_height` texels, powers of two, until a tile's shorter side
    /// is `least` texels. Nothing mixes tiles: each is as if it were alone.
    pub fn with_mips(self, [tile_width, tile_height]: [usize; 2], least: usize, alpha: Alpha) -> TexelMips {
        let (width, height) = (self.width, self.height);
        let shorter = tile_width.min(tile_height);
        let mut grids = vec![self];
        for mip in 1..=shorter.ilog2() as usize {
            let half = grids[mip - 1].halved();
            grids.push(half);
        }
        // From the coarsest, which gives colours to the empty texels of the finer ones.
        let mut mips: Vec<Mip> = Vec::with_capacity(grids.len());
        for (mip, grid) in grids.iter().enumerate().rev() {
            let surfaces = grid.surfaces(mips.last());
            let alphas = match alpha {
                Alpha::Mask => grid.mask(grids.get(mip + 1), [tile_width >> mip, tile_height >> mip]),
                Alpha::Coverage => grid.texels.iter().map(|texel| texel.coverage).collect(),
            };
            mips.push(Mip { width: grid.width, surfaces, alphas });
        }
        mips.reverse();
        mips.truncate((shorter / least.clamp(1, shorter)).ilog2() as usize + 1);
        TexelMips { width, height, mips }
    }

    /// The index of a texel's place in the next coarser mip, which is `coarser_width` wide.
    fn coarser(&self, index: usize, coarser_width: usize) -> usize {
        index / self.width / 2 * coarser_width + index % self.width / 2
    }

    fn surfaces(&self, coarser: Option<&Mip>) -> Vec<Surface> {
        let surroundings = |index: usize| coarser.map_or(UNKNOWN, |mip| mip.surfaces[self.coarser(index, mip.width)]);
        self.texels.iter().enumerate().map(|(index, texel)| texel.surface_or(surroundings(index))).collect()
    }

    /// Alpha of all texels, for a mask.
    fn mask(&self, coarser: Option<&Self>, tile: [usize; 2]) -> Vec<f32> {
        let soft = |(index, texel): (usize, &Texel)| {
            let around = coarser.map_or(texel.coverage, |grid| grid.texels[self.coarser(index, grid.width)].coverage);
            texel.coverage + SOFTNESS * (around - texel.coverage)
        };
        let mut alphas: Vec<f32> = self.texels.iter().enumerate().map(soft).collect();
        for top in (0..self.height).step_by(tile[1]) {
            for left in (0..self.width).step_by(tile[0]) {
                let rows = top..top + tile[1];
                let places: Vec<usize> =
                    rows.flat_map(|y| y * self.width + left..y * self.width + left + tile[0]).collect();
                self.keep_coverage(&places, &mut alphas);
            }
        }
        alphas
    }

    /// Bends the alphas of a tile so that as many pass the cut-off as rays hit the tree: the faintest of them lands just
    /// above it, 0 and 1 stay where they are.
    fn keep_coverage(&self, places: &[usize], alphas: &mut [f32]) {
        let coverage: f32 = places.iter().map(|&place| self.texels[place].coverage).sum();
        let Some(last) = (coverage.round() as usize).checked_sub(1) else { return };
        let mut sorted: Vec<f32> = places.iter().map(|&place| alphas[place]).collect();
        let (_, &mut faintest, _) = sorted.select_nth_unstable_by(last, |a, b| b.total_cmp(a));
        let passing = MASK_CUT_OFF + HALF_A_STEP;
        let faintest = faintest.clamp(1e-3, 0.999);
        for &place in places {
            let alpha = alphas[place];
            alphas[place] = if alpha < faintest {
                alpha / faintest * (MASK_CUT_OFF - HALF_A_STEP)
            } else {
                passing + (1.0 - passing) * ((alpha - faintest) / (1.0 - faintest)).min(1.0)
            };
        }
    }
}

impl TexelMips {
    /// sRGB colour, and alpha.
    pub fn colour_texture(&self) -> TextureData {
        let bytes = |surface: &Surface, alpha: f32| colour_bytes(&surface.colour.extend(alpha).to_array());
        self.texture(Texels::Colour, bytes)
    }

    /// Linear: half the mean normal and a half in red, green and blue, translucency in alpha.
    pub fn surface_texture(&self) -> TextureData {
        let bytes = |surface: &Surface, _: f32| {
            linear_bytes(&(0.5 + 0.5 * surface.normal).extend(surface.translucency).to_array())
        };
        self.texture(Texels::Linear, bytes)
    }

    fn texture(&self, texels: Texels, bytes: impl Fn(&Surface, f32) -> [u8; 4]) -> TextureData {
        let mip = |mip: &Mip| {
            mip.surfaces.iter().zip(&mip.alphas).flat_map(|(one, &alpha)| bytes(one, alpha)).collect::<Vec<u8>>()
        };
        TextureData {
            width: self.width as u32,
            height: self.height as u32,
            mips: self.mips.iter().map(mip).collect(),
            texels,
        }
    }
}
