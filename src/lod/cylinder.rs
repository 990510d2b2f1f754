//! The paper's medium level: a cone for the trunk, and around it an envelope of leaves.
//!
//! "This envelope is texture mapped with a translucent cylindrical projection of the 3D high resolution representation
//! [...] performed by ray-tracing, with a camera that spins around the plant" (Setas et al., section 4.1.2). Rays run level
//! from outside to the axis, and see leaves and branches, but no stem. They end there because the far half of the envelope
//! is drawn, too: what a ray misses on this side is looked for on the other by the texture of that side, so that the crown
//! is as dense as it should be when both faces of the envelope are drawn.
//!
//! All vertices hang on the stem: the envelope "oscillates as the main trunk of the high resolution model does". The paper
//! also deforms the texture, by a set of images; this does not.

use bevy::math::Vec3;
use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};
use std::f32::consts::{PI, TAU};

use super::{
    film::Film,
    profile::{CrownProfile, crown_points},
    scene::{Scene, Sight},
    settings::CylinderSettings,
    stem::Stem,
};
use crate::{
    texture::TextureData,
    tree::{Species, TreeModel, mesh::WoodVertices},
};

/// How high the ends of the envelope bulge, in radii of the last ring, and how far into the texture they mirror it.
const CAP_RISE: f32 = 0.3;
const CAP_TEXTURE: f32 = 0.12;
/// The texture has mips until its shorter side is so many texels.
const LEAST_TEXELS: usize = 4;

/// The medium level of one tree.
#[derive(Clone, Debug, PartialEq)]
pub struct CylinderLevel {
    /// The smooth shape of the crown.
    pub profile: CrownProfile,
    /// The envelope of leaves; to be drawn from both sides.
    pub envelope: EnvelopeVertices,
    /// The cone of the trunk; the bark's own textures fit it.
    pub trunk: WoodVertices,
    /// What the envelope wears, u around (it repeats), v from the top down: colour, sRGB, spread beyond the leaves; in alpha
    /// the share of rays that hit something before the axis, bent so that the cut-off of
    /// [a mask](crate::texture::MASK_CUT_OFF) keeps that share in every mip.
    pub colour: TextureData,
    /// Linear: in red and green the [place](super::place_of_normal) of the tree-local normal, in blue the distance from the
    /// axis as a share of the greatest, in alpha the share of the species' translucency (0 for wood).
    pub surface: TextureData,
    /// Share of rays that hit something.
    pub cover: f32,
    /// Mean colour of what they hit, linear.
    pub mean_colour: [f32; 3],
}

/// Vertices of an envelope of leaves.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EnvelopeVertices {
    /// Rest positions, local to the tree, m.
    pub positions: Vec<[f32; 3]>,
    /// Unit normals of the smooth envelope.
    pub normals: Vec<[f32; 3]>,
    /// Once around, and from the top (0) to the base (1).
    pub uvs: Vec<[f32; 2]>,
    /// Index of a beam of the stem (whole), place on it 0..1, phase (0), ambient light (1: it is in the texture).
    pub sway: Vec<[f32; 4]>,
    /// Triangles, counter-clockwise from outside.
    pub indices: Vec<u32>,
}

impl CylinderLevel {
    /// Fits the envelope and looks at the tree from all around; none where there is no crown.
    #[must_use]
    pub fn bake(scene: &Scene, species: &Species, model: &TreeModel, settings: &CylinderSettings) -> Option<Self> {
        let points = crown_points(model);
        let profile = CrownProfile::around(&points, settings.stretches as usize, settings.enclosed)?;
        let stem = Stem::of(&model.skeleton);
        let film = spin(scene, &profile, settings);
        let (cover, mean_colour) = (film.cover(), film.colour());
        let (width, height) = (film.width, film.height);
        let developed = film.developed(width, height, LEAST_TEXELS);
        Some(Self {
            envelope: envelope(&profile, &stem, settings),
            trunk: stem.cone(species.wood.bark.tile_m),
            colour: developed.colour,
            surface: developed.surface,
            profile,
            cover,
            mean_colour,
        })
    }
}

/// The cylindrical projection, by a camera that turns around the tree.
fn spin(scene: &Scene, profile: &CrownProfile, settings: &CylinderSettings) -> Film {
    let (width, height) = (settings.width_texels as usize, settings.height_texels as usize);
    let rays = settings.rays as usize;
    let axis = Vec3::new(profile.axis.x, 0.0, profile.axis.y);
    let from_axis_m = |point: Vec3| (point - axis).with_y(0.0).length();
    let reach_m = scene.corners.iter().map(|corner| from_axis_m(corner.position)).fold(0.0, f32::max) + 0.1;
    let mut film = Film::new(width, height);
    let share = 1.0 / (rays * rays) as f32;
    for column in 0..width * rays {
        let outwards = around((column as f32 + 0.5) / (width * rays) as f32);
        for row in 0..height * rays {
            let down = (row as f32 + 0.5) / (height * rays) as f32;
            let height_m = profile.top_m + (profile.base_m - profile.top_m) * down;
            let from = axis + outwards * reach_m + Vec3::Y * height_m;
            if let Some(hit) = scene.cast(from, -outwards, reach_m, Sight::Crown) {
                let out = (1.0 - hit.distance_m / reach_m).clamp(0.0, 1.0);
                film.texels[row / rays * width + column / rays].add(&hit.sample(out), share);
            }
        }
    }
    film
}

/// The way out of the axis at a share of the turn; counter-clockwise from above, so that u runs to the right outside.
fn around(share: f32) -> Vec3 {
    let (sin, cos) = (TAU * share).sin_cos();
    Vec3::new(cos, 0.0, -sin)
}

fn envelope(profile: &CrownProfile, stem: &Stem, settings: &CylinderSettings) -> EnvelopeVertices {
    let (sides, stretches) = (settings.sides, settings.stretches);
    let mut random = Xoshiro256PlusPlus::seed_from_u64(settings.seed);
    let mut out = EnvelopeVertices::default();
    let axis = |height_m: f32| Vec3::new(profile.axis.x, height_m, profile.axis.y);
    // The chords of a ring are to enclose what the circle does.
    let corner = 1.0 / (PI / sides as f32).cos();
    let step_m = (profile.top_m - profile.base_m) / stretches as f32;
    for ring in 0..=stretches {
        let height_m = profile.top_m - ring as f32 * step_m;
        let slope = (profile.radius_m(height_m - step_m) - profile.radius_m(height_m + step_m)) / (2.0 * step_m);
        let rough: Vec<f32> =
            (0..sides).map(|_| 1.0 + settings.roughness * random.random_range(-1.0..=1.0_f32)).collect();
        for side in 0..=sides {
            let turn = side as f32 / sides as f32;
            // The seam's two vertices must be one point.
            let outwards = around(if side == sides { 0.0 } else { turn });
            let radius_m = profile.radius_m(height_m) * corner * rough[(side % sides) as usize];
            let normal = (outwards + Vec3::Y * slope).normalize_or(outwards);
            let uv = [turn, ring as f32 / stretches as f32];
            out.push(axis(height_m) + outwards * radius_m, normal, uv, stem);
        }
    }
    for ring in 0..stretches {
        for low in (0..sides).map(|side| ring * (sides + 1) + side) {
            let below = low + sides + 1;
            out.indices.extend([low, below, low + 1, low + 1, below, below + 1]);
        }
    }
    let top = axis(profile.top_m + CAP_RISE * profile.radius_m(profile.top_m));
    out.close(0, sides, top, CAP_TEXTURE, stem);
    let base = axis(profile.base_m - CAP_RISE * profile.radius_m(profile.base_m));
    out.close(stretches * (sides + 1), sides, base, 1.0 - CAP_TEXTURE, stem);
    out
}

impl EnvelopeVertices {
    fn push(&mut self, position: Vec3, normal: Vec3, uv: [f32; 2], stem: &Stem) {
        let (beam, place) = stem.place(position.y);
        self.positions.push(position.to_array());
        self.normals.push(normal.to_array());
        self.uvs.push(uv);
        self.sway.push([beam as f32, place, 0.0, 1.0]);
    }

    /// Closes the ring that starts at `first` with a fan, an apex for each side, so that the texture runs on.
    fn close(&mut self, first: u32, sides: u32, apex: Vec3, v: f32, stem: &Stem) {
        let is_top = first == 0;
        let normal = if is_top { Vec3::Y } else { Vec3::NEG_Y };
        for side in 0..sides {
            let middle = self.positions.len() as u32;
            self.push(apex, normal, [(side as f32 + 0.5) / sides as f32, v], stem);
            let (low, next) = (first + side, first + side + 1);
            self.indices.extend(if is_top { [low, next, middle] } else { [next, low, middle] });
        }
    }
}
