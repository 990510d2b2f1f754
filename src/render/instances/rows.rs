//! Rows of the GPU tables. `render/shaders/instances.wesl` has the same layouts.

use crate::{
    dynamics::{
        beam::{BeamDynamics, BeamSway},
        second_mode::SecondMode,
    },
    tree::LeafSeason,
    wind::{Canopy, PackedCanopy},
};
use bevy::math::Vec3;
use bytemuck::{Pod, Zeroable};

/// `BeamRow` of the shader: one beam of a model.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub(crate) struct BeamRow {
    base: [f32; 3],
    length_m: f32,
    direction: [f32; 3],
    attach: f32,
    in_leaf: [f32; 4],
    bare: [f32; 4],
    loads: [u32; 4],
    parent: u32,
    leaf_season: u32,
    angle_limit_rad: f32,
    /// See [`packed_stiff_axis`].
    stiff_axis: u32,
}

impl BeamRow {
    /// A beam of a tree that has leaves in that season.
    pub fn new(beam: &BeamDynamics, leaf_season: LeafSeason) -> Self {
        let ([in_leaf, bare], loads) = sway_vectors(&beam.in_leaf, &beam.bare);
        Self {
            base: beam.base.to_array(),
            length_m: beam.length_m,
            direction: beam.direction.to_array(),
            attach: beam.attach,
            in_leaf,
            bare,
            loads,
            parent: beam.parent,
            leaf_season: leaf_season.bits(),
            angle_limit_rad: beam.angle_limit_rad,
            stiff_axis: packed_stiff_axis(beam),
        }
    }
}

/// The stiff axis of a beam by the two vectors of [`across`], in 16 bits with a sign each.
fn packed_stiff_axis(beam: &BeamDynamics) -> u32 {
    let [a, b] = across(beam.direction).map(|across| {
        let share = across.dot(beam.stiff_axis).clamp(-1.0, 1.0);
        u32::from((share * 32_767.0).round() as i16 as u16)
    });
    a | b << 16
}

/// Two unit vectors across a unit vector and each other (Duff et al. 2017, J. Comput. Graph. Tech. 6): those of `stiff_axis_of` in the shader,
/// for -0 as well, for which glam's `any_orthonormal_pair` has others.
fn across(direction: Vec3) -> [Vec3; 2] {
    let Vec3 { x, y, z } = direction;
    let sign = if z < 0.0 { -1.0 } else { 1.0 };
    let (a, b) = (-1.0 / (sign + z), -x * y / (sign + z));
    [Vec3::new(1.0 + sign * x * x * a, sign * b, -sign * x), Vec3::new(b, sign + y * y * a, -y)]
}

/// `LeafySway` of the shader: a sway in leaf and bare, and what both have of the load and of a second frequency.
pub(crate) fn sway_vectors(in_leaf: &BeamSway, bare: &BeamSway) -> ([[f32; 4]; 2], [u32; 4]) {
    let vector = |sway: &BeamSway| [sway.gain, sway.class, sway.averaging_speed_m_s, sway.drag_damping_s_m];
    let both = [in_leaf, bare];
    let [leafy_m, bare_m] = both.map(|sway| sway.load_height_m.to_bits());
    // In steps of 3e-5.
    let [a, b] = both.map(|sway| u32::from((sway.drag_exponent.clamp(-1.0, 1.0) * 32_767.0).round() as i16 as u16));
    let [[c, d], [e, f]] = both.map(|sway| {
        let of_most = sway.second.class_offset / SecondMode::MOST_OFFSET;
        [of_most, sway.second.share].map(|value| (value.clamp(-1.0, 1.0) * 127.0).round() as i8 as u8)
    });
    ([vector(in_leaf), vector(bare)], [leafy_m, bare_m, a | b << 16, u32::from_le_bytes([c, d, e, f])])
}

/// `Frame` of the shader: the values of one frame.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub(crate) struct FrameRow {
    /// Now and one frame ago, s, each wrapped into the periods of slot A and slot B: a now, b now, a before, b before.
    pub time_s: [f32; 4],
    /// Weight of slot B now and one frame ago.
    pub blend: [f32; 2],
    /// Now and one frame ago in the period of the leaves' flutter, s.
    pub leaf_time_s: [f32; 2],
    /// First pose of this frame's half and of the last frame's; the same where there is one half, for no camera asks for motion vectors.
    pub poses_now: u32,
    pub poses_before: u32,
    /// 1 once there is a wind, 0 before.
    pub ready: u32,
    /// Workgroups of the pose pass.
    pub workgroup_count: u32,
    /// Time of the year, 0..1.
    pub year: f32,
    /// Where LOD levels 0, 1 and 2 of a tree end, per metre of its height.
    pub lod_ends: [f32; 3],
    /// Levels fade over this share of a distance, to either side.
    pub fade: f32,
    /// The same between a tree and its impostor.
    pub impostor_fade: f32,
    /// Trees fade so much later than their impostors come, as a factor of the distance.
    pub fade_lag: f32,
    /// Of `viewers`, those that are set.
    pub viewer_count: u32,
    /// From here on impostors cast the shadows of trees in a sun's maps, per metre of their height.
    pub shadow_end: f32,
    /// First row of this frame's half of what is added to trees that are awake, and of the last frame's.
    pub live_now: u32,
    pub live_before: u32,
    /// Of `sources`, `pushers` and `trails`, those that are set: now and one frame ago.
    pub source_counts: [u32; 2],
    pub pusher_counts: [u32; 2],
    pub trail_counts: [u32; 2],
    /// `viewers` begins at a multiple of 16 bytes.
    pub padding: [u32; 3],
    /// The cameras: place, and the factor of [`LodViewer::factor`](crate::render::lod::viewers::LodViewer::factor).
    pub viewers: [[f32; 4]; MAX_VIEWERS],
    /// What a game blows and pushes: rows of now, then those of one frame ago.
    pub sources: [SourceRow; 2 * MOST_SOURCES],
    pub pushers: [PusherRow; 2 * MOST_PUSHERS],
    /// Where these were in the last moments.
    pub trails: [TrailRow; 2 * MOST_TRAILS],
}

/// `SourceRow` of the shader: a [`SourceFlow`](crate::wind::SourceFlow).
#[repr(transparent)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub(crate) struct SourceRow(pub [[f32; 4]; 3]);

/// `PusherRow` of the shader: both ends of a capsule, each with its radius.
#[repr(transparent)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub(crate) struct PusherRow(pub [[f32; 4]; 2]);

/// `TrailRow` of the shader: both ends of a capsule where a stretch of its way begins, with its radius and how long ago that was, and where it
/// ends, with how long ago that was.
#[repr(transparent)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub(crate) struct TrailRow(pub [[f32; 4]; 4]);

/// Sources and pushers that grass and fires feel at once.
pub(crate) const MOST_SOURCES: usize = 16;
pub(crate) const MOST_PUSHERS: usize = 16;
/// Stretches of the ways of pushers on which grass swings back: a walker has ten.
pub(crate) const MOST_TRAILS: usize = 64;

/// `TreeRow` of the shader: one tree. A row without beams is unused, or that of a tree without poses, which stands at rest.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub(crate) struct TreeRow {
    pub rotation: [f32; 4],
    pub position: [f32; 3],
    /// Negative for a tree that is mirrored.
    pub scale: f32,
    pub first_beam: u32,
    /// See [`TreeRow::set_beams`] and [`TreeRow::set_growth_fade`].
    beams_and_fade: u32,
    pub first_pose: u32,
    /// See [`TreeRow::season_and_height`].
    pub season_and_height: u32,
    /// See [`TreeRow::impostor`].
    pub impostor: u32,
    /// A [`PackedCanopy`].
    pub canopy_profile: u32,
    pub canopy_exposure: u32,
    /// One more than the first of its rows among those of trees that are awake; 0 for a tree that sleeps.
    pub live: u32,
}

/// Farther than anything, m.
pub(crate) const NO_IMPOSTOR_M: f32 = 1e30;

impl TreeRow {
    /// In the open, without poses.
    pub fn new(first_beam: u32) -> Self {
        let mut row = Self { first_beam, impostor: Self::NO_IMPOSTOR, ..Self::default() };
        row.set_canopy(Canopy::OPEN);
        row
    }

    /// Beams that are posed; 0 for a tree without poses.
    #[cfg(test)]
    pub fn beams(&self) -> u32 {
        self.beams_and_fade & 0xffff
    }

    pub fn set_beams(&mut self, beams: u32) {
        self.beams_and_fade = self.beams_and_fade & !0xffff | beams.min(0xffff);
    }

    /// How much of a shape has faded while its tree grows, 0 to 1, or has still to come, -1 to 0; 0 for any other. It has 16 bits.
    pub fn set_growth_fade(&mut self, fade: f32) {
        let bits = (fade.clamp(-1.0, 1.0) * 32_767.0).round() as i16 as u16;
        self.beams_and_fade = self.beams_and_fade & 0xffff | u32::from(bits) << 16;
    }

    pub fn set_canopy(&mut self, PackedCanopy { profile, exposure }: PackedCanopy) {
        (self.canopy_profile, self.canopy_exposure) = (profile, exposure);
    }

    /// Where no impostor stands for a tree.
    pub const NO_IMPOSTOR: u32 = u32::MAX;

    /// From where on an impostor stands for it, m, in steps of half a metre, and the height of that, m, in steps of 4 mm. Both are rounded
    /// up: a tree may fade late, but not early.
    pub fn impostor(from_m: f32, height_m: f32) -> u32 {
        let from = (from_m * 2.0).ceil().clamp(0.0, 65_534.0) as u32;
        let height = (height_m * 256.0).ceil().clamp(0.0, 65_535.0) as u32;
        from | height << 16
    }

    /// How far it is ahead of the season, -0.5 to 0.5 years in steps of 8 minutes, and its height, m, to 256 m in steps of
    /// 4 mm.
    pub fn season_and_height(season_shift: f32, height_m: f32) -> u32 {
        let season = (season_shift * 65_536.0 + 32_768.0).round().clamp(0.0, 65_535.0) as u32;
        let height = (height_m * 256.0).round().clamp(0.0, 65_535.0) as u32;
        season | height << 16
    }
}

/// Size of a `BeamPose` of the shader: two vec4.
pub(crate) const POSE_BYTES: usize = 32;

/// Cameras whose picture sizes the shaders know.
pub(crate) const MAX_VIEWERS: usize = 8;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        dynamics::test_beams::{OAK, upright},
        render::buffers::sway_buffers::FRAME_BYTES,
    };

    #[test]
    fn rows_have_the_sizes_of_the_shader() {
        assert_eq!(size_of::<BeamRow>(), 96);
        assert_eq!(size_of::<FrameRow>() as u64, FRAME_BYTES);
        assert_eq!(size_of::<TreeRow>(), 64);
    }

    #[test]
    fn stiff_axes_are_packed_across_their_beams() {
        for direction in [Vec3::Y, Vec3::NEG_Z, Vec3::new(0.48, 0.6, -0.64), Vec3::new(-0.8, 0.0, 0.6)] {
            let [a, b] = across(direction);
            let dots = [a.dot(direction), b.dot(direction), a.dot(b), a.length() - 1.0, b.length() - 1.0];
            assert!(dots.iter().all(|dot| dot.abs() < 1e-6), "{direction}: {dots:?}");
            let stiff_axis = 0.3 * a - 0.5 * b;
            let packed = packed_stiff_axis(&BeamDynamics { direction, stiff_axis, ..upright(OAK, 1.0) });
            let [of_a, of_b] = [packed as u16, (packed >> 16) as u16].map(|bits| f32::from(bits as i16) / 32_767.0);
            assert!((a * of_a + b * of_b).distance(stiff_axis) < 5e-5, "{direction}");
        }
    }

    /// As `second_mode` and `drag_exponent` of the shader unpack them.
    #[test]
    fn second_frequencies_are_packed_without_rounding() {
        for (offset, share) in [(3.2, 0.41), (-15.9, 1.0), (7.999, 0.004), (f32::NAN, 0.5), (2.0, f32::NAN)] {
            let [leafy, bare] = [SecondMode::rounded(offset, share), SecondMode::rounded(1.0, 0.25)];
            let [in_leaf, bare] = [leafy, bare].map(|second| BeamSway { second, ..OAK });
            let (_, [.., exponents, modes]) = sway_vectors(&in_leaf, &bare);
            let unpacked = modes.to_le_bytes().map(|byte| f32::from(byte.cast_signed()) / 127.0);
            for (sway, [of_most, share]) in
                [in_leaf, bare].iter().zip([[unpacked[0], unpacked[1]], [unpacked[2], unpacked[3]]])
            {
                assert!(
                    (of_most * SecondMode::MOST_OFFSET - sway.second.class_offset).abs() < 1e-5,
                    "{offset} {share}"
                );
                assert!((share - sway.second.share).abs() < 1e-6, "{offset} {share}");
            }
            let exponent = f32::from((exponents as u16).cast_signed()) / 32_767.0;
            assert!((exponent - OAK.drag_exponent).abs() < 2e-5);
        }
    }

    #[test]
    fn beams_and_the_fade_of_growth_share_a_word() {
        let mut row = TreeRow::new(0);
        for (beams, fade) in [(0, 0.0), (65_535, -1.0), (700, 0.999), (1, -1e-3), (7, f32::NAN)] {
            row.set_growth_fade(fade);
            row.set_beams(beams);
            let back = ((row.beams_and_fade >> 16) as u16).cast_signed();
            assert_eq!(row.beams(), beams);
            assert!((f32::from(back) / 32_767.0 - fade).abs() < 2e-5 || fade.is_nan() && back == 0, "{fade}: {back}");
        }
    }

    #[test]
    fn season_and_height_are_packed_into_a_word() {
        let word = TreeRow::season_and_height(-0.25, 31.5);
        assert_eq!(((word & 0xffff) as f32 - 32_768.0) / 65_536.0, -0.25);
        assert_eq!((word >> 16) as f32 / 256.0, 31.5);
        assert_eq!(TreeRow::season_and_height(f32::NAN, -3.0), 0);
    }
}
