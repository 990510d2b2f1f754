//! The tables as the shaders read them. Each layout here has its twin in `render/shaders/instances.wesl` or `wind.wesl`.

use crate::{dynamics::pose::BeamDynamics, sway::response::WindResponse};
use bytemuck::{Pod, Zeroable};

/// `BeamRow` of the shader: one beam of a model.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub(super) struct BeamRow {
    base: [f32; 3],
    length_m: f32,
    direction: [f32; 3],
    attach: f32,
    gain: f32,
    class_coordinate: f32,
    parent: u32,
    padding: u32,
}

impl From<&BeamDynamics> for BeamRow {
    fn from(beam: &BeamDynamics) -> Self {
        Self {
            base: beam.base.to_array(),
            length_m: beam.length_m,
            direction: beam.direction.to_array(),
            attach: beam.attach,
            gain: beam.gain,
            class_coordinate: beam.class,
            parent: beam.parent,
            padding: 0,
        }
    }
}

/// `Frame` of the shader: the clock of one frame.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub(super) struct FrameRow {
    /// Now and one frame ago, s, each wrapped into the periods of slot A and slot B: a now, b now, a before, b before.
    pub time_s: [f32; 4],
    /// Weight of slot B now and one frame ago.
    pub blend: [f32; 2],
    /// Now and one frame ago in the period of the leaves' flutter, s.
    pub leaf_time_s: [f32; 2],
    /// First pose of this frame's half and of the last frame's.
    pub poses_now: u32,
    pub poses_before: u32,
    /// 1 once there is a wind, 0 before.
    pub ready: u32,
    /// Chunks of beams that are posed, see [`pose_chunk`].
    pub chunk_count: u32,
    /// Time of the year, 0..1.
    pub year: f32,
    /// Where levels 0, 1 and 2 of a tree end, per metre of its height.
    pub level_ends: [f32; 3],
    /// Nowhere nearer than this do cards stand for trees, m.
    pub cards_from_m: f32,
    /// Over this share of a distance, to either side, levels fade.
    pub fade: f32,
    /// Heights of a tree and its impostor differ by less than this factor.
    pub height_tolerance: f32,
    pub padding: f32,
}

/// `TreeRow` of the shader: one tree. Without beams it is a row that nobody has, or a tree that is not posed: at rest.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub(super) struct TreeRow {
    pub rotation: [f32; 4],
    pub position: [f32; 3],
    pub scale: f32,
    pub first_beam: u32,
    pub beam_count: u32,
    pub first_pose: u32,
    /// See [`TreeRow::season_and_height`].
    pub season_and_height: u32,
}

impl TreeRow {
    /// How far it is ahead of the season, -0.5 to 0.5 years in steps of 8 minutes, and its height, m, to 256 m in steps of
    /// 4 mm.
    pub fn season_and_height(season_shift: f32, height_m: f32) -> u32 {
        let season = (season_shift * 65_536.0 + 32_768.0).round().clamp(0.0, 65_535.0) as u32;
        let height = (height_m * 256.0).round().clamp(0.0, 65_535.0) as u32;
        season | height << 16
    }
}

/// Size of a `BeamPose` of the shader: three vec4.
pub(super) const POSE_BYTES: usize = 48;

/// Beams that a workgroup poses; `WORKGROUP` of the shader.
pub(super) const CHUNK: u32 = 64;

/// The beams from `64 chunk` on of a row's tree, as the shader reads them: the row in the low half.
pub(super) fn pose_chunk(row: u32, chunk: u32) -> u32 {
    row | chunk << 16
}

/// Rows of `vec4` before the direction map in a slot; `HEADER` of the shader.
const HEADER: usize = 4;

/// One wind as the shader reads it, in rows of `vec4`: header, direction map, responses, velocities.
pub(super) fn pack_slot(wind: &WindResponse) -> Vec<u8> {
    let (frame, table, map) = (wind.field.frame(), &wind.table, wind.basis.map());
    let along = frame.along;
    let across = frame.across;
    let spacing = wind.field.settings().resolution.column_spacing_m;
    let header: [[f32; 4]; HEADER] = [
        [along.x, along.y, along.z, wind.field.convective_speed_m_s()],
        [across.x, across.y, across.z, spacing],
        [table.classes.count as f32, table.columns as f32, table.samples as f32, table.time_step_s],
        [map.size() as f32, 1.0 / table.classes.ratio.ln(), 0.0, 0.0],
    ];
    let parts: [&[u8]; 4] = [
        bytemuck::cast_slice(&header),
        bytemuck::cast_slice(map.texels()),
        bytemuck::cast_slice(&table.values),
        bytemuck::cast_slice(&table.velocities),
    ];
    parts.concat()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_have_the_sizes_that_the_shader_strides_by() {
        assert_eq!(size_of::<BeamRow>(), 48);
        assert_eq!(size_of::<FrameRow>(), 80);
        assert_eq!(size_of::<TreeRow>(), 48);
    }

    #[test]
    fn season_and_height_share_a_word() {
        let word = TreeRow::season_and_height(-0.25, 31.5);
        assert_eq!(((word & 0xffff) as f32 - 32_768.0) / 65_536.0, -0.25);
        assert_eq!((word >> 16) as f32 / 256.0, 31.5);
        assert_eq!(TreeRow::season_and_height(f32::NAN, -3.0), 0);
    }
}
