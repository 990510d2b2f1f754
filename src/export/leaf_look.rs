//! Leaves at a time of the year: what of a colour is in the texture, what in the vertices, and which sprays are bare.
//!
//! A renderer of glTF multiplies the texture with the colours of the vertices and knows no seasons. So the texture has the mean colour of
//! the season, and each vertex has the rest:
//!
//! ```text
//! texture = gain  R(texel, mean season)
//! vertex  = R(S shade, own season) / (gain R(S, mean season))
//! ```
//!
//! with `S` the mean colour of the foliage in summer and `R` the recolouring. The product is exact for a texel of that colour; in summer,
//! where `R` changes nothing, for all. Colours of vertices are at most 1 in a file, so the texture is lightened by `gain`, channel by
//! channel: as far as the lightest vertex asks for, and the texture has room.

use crate::{
    texture::{MASK_CUT_OFF, TextureData, colour_bytes, linear},
    tree::{
        Species,
        phenology::Phenology,
        recolour::{Recolouring, SeasonColour, leafness},
        textures::SpeciesTextures,
        vertices::LeafVertices,
    },
};
use bevy::math::Vec3;

/// Texels with less leaf in them are twigs, as in the renderer's shader.
const TWIG_LEAFNESS: f32 = 0.35;
/// Leaves that have shrunk to less are left out.
const LEAST_SIZE: f32 = 0.02;
/// Vertices are at most so many times as light as the mean.
const GREATEST_FACTOR: f32 = 4.0;
/// The mip whose texels tell how light the texture is, and the share of them that must stay below white.
const ROOM_MIP: usize = 2;
const ROOM_SHARE: f32 = 0.95;

/// How the leaves of a species look at a time of the year.
pub(super) struct LeafLook<'a> {
    phenology: &'a Phenology,
    colours: Recolouring,
    year: f32,
    /// The tree's own shade, -0.5 to 0.5.
    own: f32,
    are_ellipsoids: bool,
    /// Mean colour in summer, light.
    summer: Vec3,
    mean: SeasonColour,
    gain: Vec3,
}

/// What is seen of a leaf or a spray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum LeafState {
    /// All of it.
    InLeaf,
    /// Its twigs.
    Bare,
    /// It is so much smaller, 0 to 1.
    Shrunk(f32),
    /// Nothing.
    Gone,
}

impl<'a> LeafLook<'a> {
    /// The leaves of all these meshes, of trees of one species, share a texture.
    pub fn new(
        species: &'a Species,
        textures: &SpeciesTextures,
        meshes: &[&LeafVertices],
        (year, tint): (f32, f32),
    ) -> Self {
        let summer = textures.foliage_colour();
        let mut look = Self {
            phenology: &species.phenology,
            colours: Recolouring::new(&species.phenology, summer),
            year,
            own: 0.5 * tint,
            are_ellipsoids: species.has_ellipsoids(),
            summer: Vec3::from_array(linear(summer)),
            mean: SeasonColour::default(),
            gain: Vec3::ONE,
        };
        let leaves = || meshes.iter().flat_map(|mesh| mesh.sway.iter().zip(&mesh.axis));
        look.mean = mean(leaves().map(|(sway, axis)| look.season(sway[2], axis[3]).0));
        let factors = leaves().map(|(sway, axis)| look.factor(sway, axis));
        look.gain = factors.fold(Vec3::ONE, Vec3::max).min(look.room(&textures.foliage)).max(Vec3::ONE);
        look
    }

    /// The colour of a vertex, linear, each channel 0 to 1.
    pub fn colour(&self, sway: &[f32; 4], axis: &[f32; 4]) -> Vec3 {
        (self.factor(sway, axis) / self.gain).clamp(Vec3::ZERO, Vec3::ONE)
    }

    /// How much lighter the texture is than the mean leaf, 1 or more, by channel.
    pub fn gain(&self) -> Vec3 {
        self.gain
    }

    /// Whether the leaf of a vertex is there.
    pub fn state(&self, sway: &[f32; 4], axis: &[f32; 4]) -> LeafState {
        let phase = sway[2];
        let (_, size) = self.season(phase, axis[3]);
        if self.are_ellipsoids {
            return if size < LEAST_SIZE { LeafState::Gone } else { LeafState::Shrunk(size) };
        }
        // The renderer lets the leaves of a spray fall one by one; here whole sprays are bare, as many as are due.
        let rank = (61.8034 * phase).fract();
        if size > 0.02 + 0.96 * rank { LeafState::InLeaf } else { LeafState::Bare }
    }

    /// The texture of leaves in the mean colour of the season, so many times as light.
    pub fn texture(&self, summer: &TextureData, gain: Vec3) -> TextureData {
        self.recoloured(summer, gain, |_, alpha| alpha)
    }

    /// The same with the twigs alone.
    pub fn bare_texture(&self, summer: &TextureData, gain: Vec3) -> TextureData {
        self.recoloured(summer, gain, |light, alpha| if leafness(light) < TWIG_LEAFNESS { alpha } else { 0 })
    }

    fn recoloured(&self, summer: &TextureData, gain: Vec3, alpha: impl Fn(Vec3, u8) -> u8) -> TextureData {
        let light = light_of_bytes();
        let texel = |texel: &[u8]| {
            let own = Vec3::from_array(std::array::from_fn(|channel| light[usize::from(texel[channel])]));
            let [red, green, blue] = (gain * self.colours.of(own, self.mean)).to_array();
            let [red, green, blue, _] = colour_bytes(&[red, green, blue, 1.0]);
            [red, green, blue, alpha(own, texel[3])]
        };
        let mips = summer.mips.iter().map(|mip| mip.chunks_exact(4).flat_map(texel).collect());
        TextureData { mips: mips.collect(), ..*summer }
    }

    /// By how much nearly all texels that are drawn can be lightened before they are white, by channel.
    fn room(&self, summer: &TextureData) -> Vec3 {
        let light = light_of_bytes();
        let mip = summer.mips.get(ROOM_MIP).or(summer.mips.last()).map_or(&[][..], Vec::as_slice);
        let drawn = mip.chunks_exact(4).filter(|texel| f32::from(texel[3]) > 255.0 * MASK_CUT_OFF);
        let colour = |texel: &[u8]| {
            let own = std::array::from_fn(|channel| light[usize::from(texel[channel])]);
            self.colours.of(Vec3::from_array(own), self.mean)
        };
        let colours: Vec<Vec3> = drawn.map(colour).collect();
        let light_one = |channel: usize| {
            let mut values: Vec<f32> = colours.iter().map(|colour| colour[channel]).collect();
            let place = (ROOM_SHARE * values.len() as f32) as usize;
            if place < values.len() { *values.select_nth_unstable_by(place, f32::total_cmp).1 } else { 1.0 }
        };
        Vec3::from_array(std::array::from_fn(light_one)).max(Vec3::splat(1e-3)).recip()
    }

    /// Colour of the season and share of the leaves of a spray, by its phase and its tint.
    fn season(&self, phase: f32, tint: f32) -> (SeasonColour, f32) {
        let lag = tint - 0.5 + self.own;
        let leaves = self.phenology.leaves(self.year, lag, phase);
        let tone = (0.5 + 1.5 * lag + 0.5 * (phase - 0.5)).clamp(0.0, 1.0);
        (SeasonColour { change: leaves.autumn - leaves.youth, tone }, leaves.size)
    }

    /// What the mean colour of the season is multiplied with for a vertex.
    fn factor(&self, sway: &[f32; 4], axis: &[f32; 4]) -> Vec3 {
        let own = self.colours.of(self.summer * self.shade(sway[3], axis[3]), self.season(sway[2], axis[3]).0);
        let mean = self.colours.of(self.summer, self.mean).max(Vec3::splat(1e-4));
        (own / mean).clamp(Vec3::ZERO, Vec3::splat(GREATEST_FACTOR))
    }

    /// Light lost in the crown and natural variation, as in the renderer's `leaf_shade.wesl`. But all of that loss is in the colour: other
    /// renderers do not know how much of the sky's light arrives.
    fn shade(&self, light: f32, tint: f32) -> Vec3 {
        let light = (0.25 + 0.75 * light) * (0.85 + 0.35 * tint);
        let warmth = tint + self.own;
        light * Vec3::new(0.92 + 0.2 * warmth, 1.0 + 0.06 * self.own, 1.05 - 0.25 * warmth)
    }
}

/// The light of each byte of a colour.
fn light_of_bytes() -> [f32; 256] {
    std::array::from_fn(|byte| linear([byte as f32 / 255.0; 3])[0])
}

fn mean(colours: impl Iterator<Item = SeasonColour>) -> SeasonColour {
    let (mut sum, mut count) = (SeasonColour::default(), 0.0_f32);
    for colour in colours {
        sum.change += colour.change;
        sum.tone += colour.tone;
        count += 1.0;
    }
    let count = count.max(1.0);
    SeasonColour { change: sum.change / count, tone: sum.tone / count }
}
