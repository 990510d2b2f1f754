//! The paper's medium level: a cone for the trunk, and around it an envelope of leaves.
//!
//! "This envelope is texture mapped with a translucent cylindrical projection of the 3D high resolution representation
//! [...] performed by ray-tracing, with a camera that spins around the plant" (Setas et al., section 4.1.2). Rays run level
//! from outside to the axis, and see leaves and branches, but no stem. They end there because the far half of the envelope
//! is drawn, too: what a ray misses on this side is looked for on the other by the texture of that side, so that the crown
//! is as dense as it should be when both faces of the envelope are drawn.
//!
//! Its animation has two phases. All vertices hang on the stem: the envelope "oscillates as the main trunk of the high
//! resolution model does". And "the deformation of the texture is obtained by generating a set of images of the high
//! resolution representation in different positions of the animation sequence": the texture holds images of even moments
//! of a sway that repeats itself. They show only what moves relative to the stem, all other branches with the leaves that
//! ride on them, in the gusts of a fresh breeze (Beaufort 5, 9.4 m/s, with a turbulence intensity of 0.2), by the beams'
//! own gain; each branch has a phase and a heading of its own, so that the images suit winds from all sides. Leaves do not
//! flutter.

use bevy::math::{Vec2, Vec3};
use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};
use std::f32::consts::PI;

use super::{
    breeze,
    film::{Alpha, Film},
    profile::{CrownProfile, crown_points},
    scene::Scene,
    settings::CylinderSettings,
    spin::{Spin, around},
    stem::Stem,
};
use crate::{
    texture::TextureData,
    tree::{Species, TreeModel, mesh::WoodVertices},
};

/// How high the ends of the envelope bulge, in radii of the last ring, and how far into the texture they mirror it.
const CAP_RISE: f32 = 0.3;
const CAP_TEXTURE: f32 = 0.12;
/// The texture has mips until the shorter side of an image is so many texels.
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
    /// Images in both textures, below one another: image `k` is of the moment `k / images` of the sway, and the first
    /// follows on the last. A single image is of the tree at rest.
    pub images: u32,
    /// What the envelope wears, in each image u around (it repeats), v from the top down: colour, sRGB, spread beyond the
    /// leaves; in alpha the share of rays that hit something before the axis, bent so that the cut-off of
    /// [a mask](crate::texture::MASK_CUT_OFF) keeps that share in every mip of every image. As high as all images are; no
    /// texel of any mip knows of another image, so only a filter can mix them ([`place_in`](Self::place_in)).
    pub colour: TextureData,
    /// Linear, in the same places: in red, green and blue half the mean tree-local normal and a half, in alpha the
    /// share of the species' translucency (0 for wood).
    pub surface: TextureData,
    /// Share of rays that hit something, of all images.
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
    /// Once around, and from the top (0) to the base (1) of any one image.
    pub uvs: Vec<[f32; 2]>,
    /// Index of a beam of the stem (whole), place on it 0..1, phase (0), ambient light (1: it is in the texture).
    pub sway: Vec<[f32; 4]>,
    /// Triangles, counter-clockwise from outside.
    pub indices: Vec<u32>,
}

impl CylinderLevel {
    /// Fits the envelope and looks at the tree from all around, at each moment of its sway; none where there is no crown.
    /// The `scene` is of the `model` at rest.
    #[must_use]
    pub fn bake(scene: &Scene, species: &Species, model: &TreeModel, settings: &CylinderSettings) -> Option<Self> {
        let points = crown_points(model);
        let profile = CrownProfile::around(&points, settings.stretches as usize, settings.enclosed)?;
        let stem = Stem::of(&model.skeleton);
        let film = sequence(scene, model, &profile, settings);
        let (cover, mean_colour) = (film.cover(), film.colour());
        let developed = film.developed(
            [settings.width_texels, settings.height_texels].map(|texels| texels as usize),
            LEAST_TEXELS,
            Alpha::Mask,
        );
        Some(Self {
            envelope: envelope(&profile, &stem, settings),
            trunk: stem.cone(species.wood.bark.tile_m),
            images: settings.images,
            colour: developed.colour,
            surface: developed.surface,
            profile,
            cover,
            mean_colour,
        })
    }

    /// Where a place `uv` of the envelope lies in the textures, in an image of the sequence (it repeats). In `mip` and all
    /// finer ones a linear filter there takes nothing of other images: v keeps half a texel of the mip from the border.
    #[must_use]
    pub fn place_in(&self, image: u32, uv: Vec2, mip: u32) -> Vec2 {
        let coarsest = self.colour.mips.len() as u32 - 1;
        let texel = self.images as f32 / (self.colour.height >> mip.min(coarsest)) as f32;
        let v = uv.y.clamp(0.5 * texel, 1.0 - 0.5 * texel);
        Vec2::new(uv.x, ((image % self.images) as f32 + v) / self.images as f32)
    }
}

/// The cylindrical projections of all moments, below one another.
pub(super) fn sequence(scene: &Scene, model: &TreeModel, profile: &CrownProfile, settings: &CylinderSettings) -> Film {
    let tile = [settings.width_texels, settings.height_texels].map(|texels| texels as usize);
    let rays = settings.rays as usize;
    let from_axis_m = |point: Vec3| Vec2::new(point.x, point.z).distance(profile.axis);
    let reach_m = scene.corners.iter().map(|corner| from_axis_m(corner.position)).fold(0.0, f32::max);
    let mut film = Film::new(tile[0], tile[1] * settings.images as usize);
    for image in 0..settings.images {
        let posed = scene.posed(model, &breeze::poses(model, image, settings.images));
        let spin = Spin::new(&posed, profile, tile.map(|texels| texels * rays));
        let corner = [0, image as usize * tile[1]];
        film.record(corner, tile, rays, |column, row| spin.sample(column, row, reach_m));
    }
    film
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
