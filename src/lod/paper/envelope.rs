//! The paper's medium level: a cone for the trunk, and around it an envelope of leaves.
//!
//! "This envelope is texture mapped with a translucent cylindrical projection of the 3D high resolution representation
//! [...] performed by ray-tracing, with a camera that spins around the plant" (Setas et al., section 4.1.2). Rays run level
//! from outside to the axis, and hit leaves and branches, but no stem. They end there because the far half of the envelope
//! is drawn, too: what a ray misses on this side shows on the other in the texture of that side. So the crown is as
//! dense as it should be when both faces of the envelope are drawn.
//!
//! Its animation has two phases. All vertices hang on the stem: the envelope "oscillates as the main trunk of the high
//! resolution model does". And "the deformation of the texture is obtained by generating a set of images of the high
//! resolution representation in different positions of the animation sequence": the texture holds frames of a sway that
//! repeats itself ([`sway_frames`]). Leaves do not flutter.

use bevy::math::Vec3;
use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};
use std::f32::consts::PI;

use super::{
    cylindrical::{CylindricalRaster, outwards},
    main_stem::MainStem,
    profile::{CrownProfile, crown_points},
    sway_frames,
};
use crate::{
    lod::{
        bake::{
            scene::Scene,
            texels::{Alpha, TexelGrid},
        },
        settings::EnvelopeSettings,
    },
    texture::TextureData,
    tree::{Species, TreeModel, vertices::WoodVertices},
};

/// How high the ends of the envelope bulge, in radii of the last ring, and how far into the texture they mirror it.
const CAP_RISE: f32 = 0.3;
const CAP_TEXTURE: f32 = 0.12;
/// The texture has mips until the shorter side of a frame is so many texels.
const LEAST_TEXELS: usize = 4;

/// The medium level of one tree.
#[derive(Clone, Debug, PartialEq)]
pub struct EnvelopeLevel {
    /// The smooth shape of the crown.
    pub(in crate::lod) profile: CrownProfile,
    /// The envelope of leaves; to be drawn from both sides.
    pub envelope: EnvelopeVertices,
    /// The cone of the trunk; the bark's own textures fit it.
    pub trunk: WoodVertices,
    /// Frames of the animation, below one another: frame `k` is of the moment `k / frames` of the sway, and the first
    /// follows on the last. A single frame is of the tree at rest.
    pub frames: u32,
    /// The texture of the envelope, in each frame u around (it repeats), v from the top down: colour, sRGB, spread beyond
    /// the leaves; in alpha the share of rays that hit something before the axis, bent so that the cut-off of
    /// [a mask](crate::texture::MASK_CUT_OFF) keeps that share in every mip of every frame. As high as all frames are. No
    /// texel of any mip mixes frames, so only a filter can mix them: v has to keep half a texel of the mip from
    /// the borders of its frame.
    pub colour: TextureData,
    /// Share of rays that hit something, of all frames.
    pub(in crate::lod) coverage: f32,
    /// Mean colour of what they hit, linear.
    pub(in crate::lod) mean_colour: [f32; 3],
}

/// Vertices of an envelope of leaves.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EnvelopeVertices {
    /// Rest positions, local to the tree, m.
    pub positions: Vec<[f32; 3]>,
    /// Unit normals of the smooth envelope.
    pub normals: Vec<[f32; 3]>,
    /// Once around, and from the top (0) to the base (1) of any one frame.
    pub uvs: Vec<[f32; 2]>,
    /// Index of a beam of the stem (whole), place on it 0..1, phase (0), ambient light (1: it is in the texture).
    pub sway: Vec<[f32; 4]>,
    /// Triangles, counter-clockwise from outside.
    pub indices: Vec<u32>,
}

impl EnvelopeLevel {
    /// Fits the envelope and renders the tree from all around, at each moment of its sway; none where there is no crown.
    /// The `scene` is of the `model` at rest.
    #[must_use]
    pub fn bake(scene: &Scene, species: &Species, model: &TreeModel, settings: &EnvelopeSettings) -> Option<Self> {
        let points = crown_points(model);
        let profile = CrownProfile::around(&points, settings.segments as usize, settings.enclosed)?;
        let stem = MainStem::of(&model.skeleton);
        let texels = render_frames(scene, model, &profile, settings);
        let (coverage, mean_colour) = (texels.coverage(), texels.mean_colour());
        let frame_texels = [settings.width_texels, settings.height_texels].map(|texels| texels as usize);
        Some(Self {
            envelope: envelope(&profile, &stem, settings),
            trunk: stem.cone(species.wood.bark.tile_m),
            frames: settings.frames,
            colour: texels.with_mips(frame_texels, LEAST_TEXELS, Alpha::Mask).colour_texture(),
            profile,
            coverage,
            mean_colour,
        })
    }
}

/// The cylindrical projections at all moments, below one another.
pub(in crate::lod) fn render_frames(
    scene: &Scene,
    model: &TreeModel,
    profile: &CrownProfile,
    settings: &EnvelopeSettings,
) -> TexelGrid {
    let size = [settings.width_texels, settings.height_texels].map(|texels| texels as usize);
    let rays = settings.rays as usize;
    let reach_m = scene.vertices.iter().map(|vertex| profile.distance_m(vertex.position)).fold(0.0, f32::max);
    let mut texels = TexelGrid::new(size[0], size[1] * settings.frames as usize);
    for frame in 0..settings.frames {
        let posed = scene.posed(model, &sway_frames::poses(model, frame, settings.frames));
        let raster = CylindricalRaster::new(&posed, profile, size.map(|texels| texels * rays));
        let corner = [0, frame as usize * size[1]];
        texels.add_rays(corner, size, rays, |column, row| raster.sample(column, row, reach_m));
    }
    texels
}

fn envelope(profile: &CrownProfile, stem: &MainStem, settings: &EnvelopeSettings) -> EnvelopeVertices {
    let (sides, segments) = (settings.sides, settings.segments);
    let mut random = Xoshiro256PlusPlus::seed_from_u64(settings.seed);
    let mut out = EnvelopeVertices::default();
    let axis = |height_m: f32| Vec3::new(profile.axis.x, height_m, profile.axis.y);
    // The chords of a ring are to enclose what the circle does.
    let corner = 1.0 / (PI / sides as f32).cos();
    let step_m = (profile.top_m - profile.base_m) / segments as f32;
    for ring in 0..=segments {
        let height_m = profile.top_m - ring as f32 * step_m;
        let slope = (profile.radius_m(height_m - step_m) - profile.radius_m(height_m + step_m)) / (2.0 * step_m);
        let rough: Vec<f32> =
            (0..sides).map(|_| 1.0 + settings.roughness * random.random_range(-1.0..=1.0_f32)).collect();
        for side in 0..=sides {
            let turn = side as f32 / sides as f32;
            // The seam's two vertices must be one point.
            let outwards = outwards(if side == sides { 0.0 } else { turn });
            let radius_m = profile.radius_m(height_m) * corner * rough[(side % sides) as usize];
            let normal = (outwards + Vec3::Y * slope).normalize_or(outwards);
            let uv = [turn, ring as f32 / segments as f32];
            out.push(axis(height_m) + outwards * radius_m, normal, uv, stem);
        }
    }
    for ring in 0..segments {
        for low in (0..sides).map(|side| ring * (sides + 1) + side) {
            let below = low + sides + 1;
            out.indices.extend([low, below, low + 1, low + 1, below, below + 1]);
        }
    }
    let top = axis(profile.top_m + CAP_RISE * profile.radius_m(profile.top_m));
    out.close(0, sides, top, CAP_TEXTURE, stem);
    let base = axis(profile.base_m - CAP_RISE * profile.radius_m(profile.base_m));
    out.close(segments * (sides + 1), sides, base, 1.0 - CAP_TEXTURE, stem);
    out
}

impl EnvelopeVertices {
    fn push(&mut self, position: Vec3, normal: Vec3, uv: [f32; 2], stem: &MainStem) {
        let (beam, place) = stem.place(position.y);
        self.positions.push(position.to_array());
        self.normals.push(normal.to_array());
        self.uvs.push(uv);
        self.sway.push([beam as f32, place, 0.0, 1.0]);
    }

    /// Closes the ring that starts at `first` with a fan, an apex for each side, so that the texture runs on.
    fn close(&mut self, first: u32, sides: u32, apex: Vec3, v: f32, stem: &MainStem) {
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
