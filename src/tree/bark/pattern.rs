//! The patterns of bark: for each place on the tile the height of the surface, and which part of the bark is there.

use bevy::math::{FloatExt, Vec2};

use crate::texture::fourier::{FourierTexture, FourierWaves};

use super::{
    Bark, BarkPattern,
    noise::{Cells, Noise, hash, unit},
};

/// One texel's worth of bark.
#[derive(Clone, Copy, Default)]
pub(super) struct Point {
    /// Height in plate widths.
    pub height: f32,
    /// 0 at the bottom of a furrow to 1 on a face.
    pub face: f32,
    /// How much of the accent colour shows, 0..1.
    pub accent: f32,
    /// Lichen, 0..1.
    pub lichen: f32,
    /// Brightness against the face's colour, about 1.
    pub tone: f32,
}

/// A bark with all its noise drawn up.
pub(super) struct Pattern<'a> {
    bark: &'a Bark,
    cells: Cells,
    flakes: Cells,
    spots: Cells,
    warp: [Noise; 3],
    grain: [Noise; 2],
    patches: [Noise; 2],
    /// Only of the pattern that is made of them.
    waves: Option<FourierWaves>,
}

/// Whole waves over the unit square, so that the tile has no seam.
fn waves(bark: &Bark, seed: u32) -> Option<FourierWaves> {
    let first_frequency_rad = std::f32::consts::TAU;
    let texture =
        FourierTexture { first_frequency_rad, tiles: true, seed: u64::from(seed), ..FourierTexture::default() };
    (bark.pattern == BarkPattern::Fourier).then(|| texture.waves().ok()).flatten()
}

impl<'a> Pattern<'a> {
    pub(super) fn new(bark: &'a Bark, seed: u32) -> Self {
        let (around, along) = (bark.plates_around, bark.plates_along);
        let salt = |layer: u32| seed ^ hash(layer as i32, 17, 5);
        // Grain runs along the trunk, but around it on bark that peels.
        let grain = match bark.pattern {
            BarkPattern::Furrows | BarkPattern::Strips => (110, 20),
            BarkPattern::Plates | BarkPattern::Fourier => (80, 64),
            BarkPattern::Peeling | BarkPattern::Smooth => (10, 90),
        };
        Self {
            bark,
            cells: Cells::new(around, along, 1.0, salt(0)),
            flakes: Cells::new(3 * around, 3 * along, 1.0, salt(1)),
            spots: Cells::new(9, 9, 0.9, salt(2)),
            warp: [Noise::new(6, 4, salt(3)), Noise::new(6, 5, salt(4)), Noise::new(26, 14, salt(5))],
            grain: [Noise::new(grain.0, grain.1, salt(6)), Noise::new(128, 128, salt(7))],
            patches: [Noise::new(4, 4, salt(8)), Noise::new(17, 15, salt(9))],
            waves: waves(bark, seed),
        }
    }

    pub(super) fn at(&self, uv: Vec2) -> Point {
        let grain = 0.6 * self.grain[0].at(uv) + 0.4 * self.grain[1].at(uv);
        let warp = Vec2::new(self.warp[0].at(uv), self.warp[1].at(uv));
        let fine = self.warp[2].at(uv);
        let mut point = match self.bark.pattern {
            BarkPattern::Furrows => self.furrows(uv, warp, fine, grain),
            BarkPattern::Plates => self.plates(uv, warp, fine, grain),
            BarkPattern::Strips => self.strips(uv, warp, fine, grain),
            BarkPattern::Peeling => self.peeling(uv, warp, fine, grain),
            BarkPattern::Smooth => self.smooth(uv, warp, fine, grain),
            BarkPattern::Fourier => self.fourier(uv, grain),
        };
        let patches = self.patches[0].at(uv) + 0.5 * self.patches[1].at(uv) + 0.35 * grain;
        let covered = self.bark.lichen;
        let spread = patches.smoothstep(0.75 - covered, 1.15 - covered) * f32::from(u8::from(covered > 0.0));
        point.lichen = point.lichen.max(spread * point.face);
        point
    }

    /// Waves upon waves.
    fn fourier(&self, uv: Vec2, grain: f32) -> Point {
        let bark = self.bark;
        let periods = Vec2::new(bark.plates_around as f32, bark.plates_along as f32);
        let wave = self.waves.as_ref().map_or(0.5, |waves| waves.at(uv * periods));
        let face = wave.smoothstep(0.0, bark.furrow_width);
        Point {
            height: wave + 0.15 * bark.roughness * grain,
            face,
            accent: wave.smoothstep(0.55, 0.8),
            lichen: 0.0,
            tone: 0.75 + 0.4 * wave + 0.3 * grain * bark.roughness,
        }
    }

    /// Long ridges that part and meet, with cracks across. Furrows run along the trunk, now wide and deep, now nearly closed;
    /// where one ridge follows another there is no more than a dent.
    fn furrows(&self, uv: Vec2, warp: Vec2, fine: f32, grain: f32) -> Point {
        let bark = self.bark;
        let warp = warp * bark.winding + Vec2::new(0.16 * fine, 0.25 * fine);
        let cell = self.cells.at(uv, warp);
        let across = cell.to_second.x.abs() / cell.to_second.length().max(1e-3);
        let openness = (0.55 + 0.9 * self.patches[1].at(uv) + 0.5 * fine).clamp(0.15, 1.2);
        let depth = across.smoothstep(0.2, 0.75) * (0.35 + 0.65 * openness.min(1.0));
        let width = bark.furrow_width * (0.4 + 0.9 * openness);
        let closed = (cell.edge + 0.22 * grain * bark.roughness).smoothstep(0.0, width);
        let face = 1.0 - depth.max(0.25) * (1.0 - closed);
        let crack = self.flakes.at(uv, warp * 3.0 + Vec2::new(0.0, 0.4 * fine));
        let split = crack.edge.smoothstep(0.0, 0.16);
        let tone = unit(cell.hash >> 8);
        let height = face * (0.75 + 0.2 * tone) + bark.roughness * (0.13 * grain - 0.16 * (1.0 - split) * face);
        Point {
            height,
            face: face * (0.7 + 0.3 * split),
            accent: 0.5 * face.smoothstep(0.35, 0.75) * (1.0 - face.smoothstep(0.75, 1.0)),
            lichen: 0.0,
            tone: 0.8
                + 0.12 * tone
                + 0.5 * grain * bark.roughness
                + 0.16 * unit(crack.hash)
                + 0.1 * self.patches[0].at(uv),
        }
    }

    /// Flat plates of many thin flakes, with sharp cracks between, which gape here and are nearly closed there.
    fn plates(&self, uv: Vec2, warp: Vec2, fine: f32, grain: f32) -> Point {
        let bark = self.bark;
        let warp = warp * bark.winding + Vec2::new(0.10 * fine, 0.10 * fine) + 0.04 * grain;
        let cell = self.cells.at(uv, warp);
        let openness = (0.5 + 0.9 * self.patches[1].at(uv) + 0.6 * fine).clamp(0.1, 1.2);
        let width = bark.furrow_width * (0.4 + 0.9 * openness);
        let closed = (cell.edge + 0.15 * grain * bark.roughness).smoothstep(0.0, width);
        let face = 1.0 - (0.2 + 0.8 * openness.min(1.0)) * (1.0 - closed);
        let flake = self.flakes.at(uv, warp * 3.0 + 0.15 * grain);
        let level = unit(flake.hash >> 9);
        // Flakes come off from a plate's rim inward: the middle is the oldest, and highest.
        let terrace = 0.55 + 0.45 * (0.6 * level + 0.7 * cell.edge).min(1.0);
        let lip = flake.edge.smoothstep(0.0, 0.12);
        let height = face * terrace - bark.roughness * (0.10 * (1.0 - lip) * face - 0.07 * grain);
        Point {
            height,
            face: face * (0.8 + 0.2 * lip),
            accent: 0.8 * (level + 0.25 * fine + 0.15 * grain).smoothstep(0.2, 0.9) * face,
            lichen: 0.0,
            tone: 0.8 + 0.25 * unit(cell.hash >> 8) + 0.2 * (level - 0.5) + 0.25 * grain * bark.roughness,
        }
    }

    /// Long strips, each lifted at one edge, and grown together here and there.
    fn strips(&self, uv: Vec2, warp: Vec2, fine: f32, grain: f32) -> Point {
        let bark = self.bark;
        let warp = warp * bark.winding + Vec2::new(0.14 * fine + 0.06 * grain, 0.5 * fine);
        let cell = self.cells.at(uv, warp);
        let openness = (0.55 + 0.9 * self.patches[1].at(uv) + 0.5 * fine).clamp(0.1, 1.2);
        let width = bark.furrow_width * (0.4 + 0.9 * openness);
        let closed = (cell.edge + 0.06 * grain).smoothstep(0.0, width);
        let face = 1.0 - (0.2 + 0.8 * openness.min(1.0)) * (1.0 - closed);
        let lifted = (0.5 + 0.55 * cell.from.x).clamp(0.0, 1.0);
        let ends = cell.from.y.abs().smoothstep(0.1, 0.6);
        let tone = unit(cell.hash >> 8);
        Point {
            height: face * (0.35 + 0.5 * lifted + 0.15 * ends) + bark.roughness * 0.16 * grain,
            face: face * (0.75 + 0.25 * lifted),
            accent: (tone + 0.2 * fine).smoothstep(0.55, 0.9) * (1.0 - lifted) * face,
            lichen: 0.0,
            tone: 0.75 + 0.22 * tone + 0.18 * lifted + 0.4 * grain * bark.roughness,
        }
    }

    /// A birch: white sheets, dark dashes that breathe, black diamonds where branches were.
    fn peeling(&self, uv: Vec2, warp: Vec2, fine: f32, grain: f32) -> Point {
        let bark = self.bark;
        let sheet = 0.5 + 0.5 * (warp.y + 0.35 * grain);
        // Sheets end in ragged lines around the trunk: steps of a slow wave along it.
        let edge = ((uv.y * bark.plates_along as f32 + 0.35 * warp.x + 0.12 * fine + 0.05 * grain).fract() - 0.5).abs();
        let torn = edge.smoothstep(0.06, 0.0) * warp.y.smoothstep(0.0, 0.35);
        let dash = self.flakes.at(uv, Vec2::new(0.3 * fine, 0.1 * fine));
        let size = unit(dash.hash >> 5);
        let long = (dash.from / Vec2::new(0.12 + 0.34 * size * size, 0.055 + 0.04 * size)).length();
        let dash = (long + 0.2 * grain).smoothstep(1.1, 0.7) * f32::from(u8::from(dash.hash & 7 < 4));
        let scar = self.cells.at(uv, 0.12 * Vec2::new(fine, warp.x) + 0.05 * grain);
        let width = 0.28 + 0.24 * unit(scar.hash >> 4);
        let diamond = scar.from.x.abs() / width + scar.from.y.abs() / (0.8 * width) + 0.22 * fine + 0.2 * grain;
        let scar = diamond.smoothstep(1.0, 0.75) * f32::from(u8::from(scar.hash & 7 < 2));
        let dark = dash.max(scar);
        Point {
            height: 0.5 + 0.05 * sheet - 0.22 * dash - 0.3 * scar * (0.4 + 0.6 * grain.abs())
                + 0.12 * torn
                + bark.roughness * 0.05 * grain,
            face: 1.0 - dark,
            accent: (0.85 * torn + 0.45 * (warp.y + 0.3 * fine).smoothstep(0.1, 0.6)).min(1.0) * (1.0 - dark),
            lichen: 0.0,
            tone: 0.92 + 0.10 * grain + 0.06 * sheet,
        }
    }

    /// A beech: smooth and grey, low wrinkles around, spots of crusty lichen.
    fn smooth(&self, uv: Vec2, warp: Vec2, fine: f32, grain: f32) -> Point {
        let bark = self.bark;
        let wrinkle = (std::f32::consts::TAU
            * (uv.y * (3 * bark.plates_along) as f32 + 0.8 * warp.x * bark.winding + 0.25 * fine))
            .sin();
        let fold = wrinkle.smoothstep(0.75, 1.0) * (warp.y + 0.5 * fine).smoothstep(0.0, 0.5);
        let spot = self.spots.at(uv, 0.18 * Vec2::new(fine, warp.x) + 0.06 * grain);
        let radius = 0.15 + 0.42 * unit(spot.hash >> 6);
        let crust = (spot.from.length() + 0.16 * grain + 0.12 * fine).smoothstep(radius, radius - 0.2);
        let lichen = crust * f32::from(u8::from(unit(spot.hash) < bark.lichen));
        Point {
            height: 0.5 + 0.12 * warp.x - 0.10 * fold + 0.05 * lichen + bark.roughness * 0.06 * grain,
            face: 1.0 - 0.35 * fold,
            accent: (self.patches[0].at(uv) + 0.4 * fine).smoothstep(0.0, 0.8),
            lichen: lichen * (0.75 + 0.25 * grain),
            tone: 0.92 + 0.12 * warp.y + 0.10 * grain,
        }
    }
}
