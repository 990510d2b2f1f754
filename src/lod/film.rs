//! What rays saw, gathered in texels, and made textures with mips.
//!
//! A texel keeps sums over its rays. Half the size is the mean of those sums, so that what is clear lends no colour; where
//! nothing was hit at all, colour comes from the coarser mips, so that no dark rim shows when textures are filtered.

use bevy::math::Vec3;

use crate::texture::{HALF_A_STEP, MASK_CUT_OFF, Texels, TextureData, colour_bytes, linear_bytes};

/// How much a texel's coverage is mixed with that of the next coarser mip. The few rays of a texel make few steps of
/// coverage; this makes steps between them, and the outline a little smoother.
const SOFTNESS: f32 = 0.25;

/// What one ray saw.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sample {
    pub colour: [f32; 3],
    pub normal: Vec3,
    pub translucency: f32,
    /// How far along its way, 0 to 1. No texture keeps it; tests know by it that rays saw the same thing.
    pub depth: f32,
}

/// What the alpha of a texel is to say.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Alpha {
    /// Whether it passes a mask: bent so that as many texels of a tile pass the cut-off, in every mip, as rays hit the tree.
    Mask,
    /// What share of its rays hit something.
    Share,
}

/// Means over the rays of a texel, those that saw nothing counting as nought.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Texel {
    colour: Vec3,
    normal: Vec3,
    translucency: f32,
    /// Share of rays that hit something.
    pub cover: f32,
}

impl Texel {
    /// Takes in a ray that is `share` of the texel.
    pub(super) fn add(&mut self, sample: &Sample, share: f32) {
        self.colour += Vec3::from_array(sample.colour) * share;
        self.normal += sample.normal * share;
        self.translucency += sample.translucency * share;
        self.cover += share;
    }

    fn mean(texels: [&Self; 4]) -> Self {
        let mean = |value: fn(&Self) -> f32| 0.25 * texels.iter().map(|texel| value(texel)).sum::<f32>();
        let mean_vector = |value: fn(&Self) -> Vec3| 0.25 * texels.iter().map(|texel| value(texel)).sum::<Vec3>();
        Self {
            colour: mean_vector(|texel| texel.colour),
            normal: mean_vector(|texel| texel.normal),
            translucency: mean(|texel| texel.translucency),
            cover: mean(|texel| texel.cover),
        }
    }
}

/// What a covered texel shows; `alpha` apart.
#[derive(Clone, Copy)]
struct Shown {
    colour: Vec3,
    /// Mean of unit normals: the shorter, the more they differ.
    normal: Vec3,
    translucency: f32,
}

/// Of a texel of whose surroundings nothing is known.
const UNSEEN: Shown = Shown { colour: Vec3::ZERO, normal: Vec3::ZERO, translucency: 0.0 };

impl Texel {
    fn shown(&self, around: Shown) -> Shown {
        if self.cover <= 0.0 {
            return around;
        }
        Shown {
            colour: self.colour / self.cover,
            normal: self.normal / self.cover,
            translucency: self.translucency / self.cover,
        }
    }
}

/// Texels in rows from the top.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Film {
    pub width: usize,
    pub height: usize,
    pub texels: Vec<Texel>,
}

/// The two textures that a film becomes.
pub(super) struct Developed {
    /// sRGB colour and coverage.
    pub colour: TextureData,
    /// Linear: half the mean normal and a half in red, green and blue, translucency in alpha.
    pub surface: TextureData,
}

impl Film {
    pub(super) fn new(width: usize, height: usize) -> Self {
        Self { width, height, texels: vec![Texel::default(); width * height] }
    }

    /// Records what each ray of a tile saw, by its column and row: `per_texel` x `per_texel` rays to a texel.
    pub(super) fn record(
        &mut self,
        [left, top]: [usize; 2],
        [width, height]: [usize; 2],
        per_texel: usize,
        seen: impl Fn(usize, usize) -> Option<Sample>,
    ) {
        let share = 1.0 / (per_texel * per_texel) as f32;
        for row in 0..height * per_texel {
            let first = (top + row / per_texel) * self.width + left;
            for column in 0..width * per_texel {
                if let Some(sample) = seen(column, row) {
                    self.texels[first + column / per_texel].add(&sample, share);
                }
            }
        }
    }

    /// Share of all rays that hit something.
    pub(super) fn cover(&self) -> f32 {
        self.texels.iter().map(|texel| texel.cover).sum::<f32>() / self.texels.len() as f32
    }

    /// Mean colour of what was hit, linear.
    pub(super) fn colour(&self) -> [f32; 3] {
        let (colour, cover) = self
            .texels
            .iter()
            .fold((Vec3::ZERO, 0.0), |(colour, cover), texel| (colour + texel.colour, cover + texel.cover));
        (colour / cover.max(1e-6)).to_array()
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

    /// Makes textures of a film of tiles of `tile_width` x `tile_height` texels, powers of two, with mips until a tile's
    /// shorter side is `least` texels. Nothing mixes tiles: each is as if it had been developed alone.
    pub(super) fn developed(self, [tile_width, tile_height]: [usize; 2], least: usize, alpha: Alpha) -> Developed {
        let (width, height) = (self.width as u32, self.height as u32);
        let shorter = tile_width.min(tile_height);
        let mut pyramid = vec![self];
        for mip in 1..=shorter.ilog2() as usize {
            let half = pyramid[mip - 1].halved();
            pyramid.push(half);
        }
        let mips = (shorter / least.clamp(1, shorter)).ilog2() as usize + 1;
        let mut colours = vec![Vec::new(); mips];
        let mut surfaces = vec![Vec::new(); mips];
        // From the coarsest, which lends colours to the finer ones.
        let mut around: Option<(usize, Vec<Shown>)> = None;
        for mip in (0..pyramid.len()).rev() {
            let film = &pyramid[mip];
            let shown = film.shown(around.as_ref());
            if mip < mips {
                let alphas = match alpha {
                    Alpha::Mask => film.mask(pyramid.get(mip + 1), [tile_width >> mip, tile_height >> mip]),
                    Alpha::Share => film.texels.iter().map(|texel| texel.cover).collect(),
                };
                colours[mip] = shown.iter().zip(&alphas).flat_map(|(texel, &alpha)| texel.colour(alpha)).collect();
                surfaces[mip] = shown.iter().flat_map(Shown::surface).collect();
            }
            around = Some((film.width, shown));
        }
        Developed {
            colour: TextureData { width, height, mips: colours, texels: Texels::Colour },
            surface: TextureData { width, height, mips: surfaces, texels: Texels::Linear },
        }
    }

    fn shown(&self, around: Option<&(usize, Vec<Shown>)>) -> Vec<Shown> {
        let lent = |index: usize| {
            around.map_or(UNSEEN, |(width, coarser)| coarser[index / self.width / 2 * width + index % self.width / 2])
        };
        self.texels.iter().enumerate().map(|(index, texel)| texel.shown(lent(index))).collect()
    }

    /// Alpha of all texels, for a mask.
    fn mask(&self, coarser: Option<&Self>, tile: [usize; 2]) -> Vec<f32> {
        let soft = |(index, texel): (usize, &Texel)| {
            let around = coarser.map_or(texel.cover, |coarser| {
                coarser.texels[index / self.width / 2 * coarser.width + index % self.width / 2].cover
            });
            texel.cover + SOFTNESS * (around - texel.cover)
        };
        let mut alphas: Vec<f32> = self.texels.iter().enumerate().map(soft).collect();
        for top in (0..self.height).step_by(tile[1]) {
            for left in (0..self.width).step_by(tile[0]) {
                let rows = top..top + tile[1];
                let places: Vec<usize> =
                    rows.flat_map(|y| y * self.width + left..y * self.width + left + tile[0]).collect();
                self.cut(&places, &mut alphas);
            }
        }
        alphas
    }

    /// Bends the alphas of a tile so that as many pass the cut-off as rays hit the tree: the faintest of them lands just
    /// above it, nought and one stay where they are.
    fn cut(&self, places: &[usize], alphas: &mut [f32]) {
        let cover: f32 = places.iter().map(|&place| self.texels[place].cover).sum();
        let Some(last) = (cover.round() as usize).checked_sub(1) else { return };
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

impl Shown {
    fn colour(&self, alpha: f32) -> [u8; 4] {
        colour_bytes(&self.colour.extend(alpha).to_array())
    }

    fn surface(&self) -> [u8; 4] {
        linear_bytes(&(0.5 + 0.5 * self.normal).extend(self.translucency).to_array())
    }
}
