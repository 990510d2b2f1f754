//! Sends what changed to the graphics processor: the clock each frame, a wind's tables when a new wind begins, and the rows
//! of those trees that come, go, move, or are seen or no longer seen.

use super::{
    active::{ActiveSway, leaf_clock_s, wrapped_time_s},
    compute::PoseJob,
    detail::{LADDER, Sight},
    draw::DrawPath,
    material::SwayMaterial,
    response::WindResponse,
    rows::{FrameRow, POSE_BYTES},
    stand::Stand,
    table::{Table, with_reserve},
    writes::BufferWrites,
};
use crate::{retire::retire, tree::Season, wind::WindClock};
use bevy::{asset::RenderAssetUsages, ecs::system::SystemParam, prelude::*, render::storage::ShaderBuffer};
use bytemuck::Pod;
use std::sync::Arc;

/// Bytes of a buffer of which nothing is known yet. The frame's has room in that, and keeps it.
const FIRST_BYTES: usize = 256;

/// The buffers that all trees share.
#[derive(Resource)]
pub(super) struct StandBuffers {
    /// Winds of slot A and B, see [`ActiveSway`].
    pub winds: [Handle<ShaderBuffer>; 2],
    pub beams: Handle<ShaderBuffer>,
    pub trees: Handle<ShaderBuffer>,
    /// What is posed, a workgroup each.
    pub chunks: Handle<ShaderBuffer>,
    pub frame: Handle<ShaderBuffer>,
    /// Two halves, this frame's and the last frame's, which change places each frame.
    pub poses: Handle<ShaderBuffer>,
    /// Poses that a half has room for.
    pose_capacity: u32,
    /// Whether the first half is this frame's.
    first_half: bool,
    /// What was last sent to the slots.
    sent: [Option<Arc<WindResponse>>; 2],
    /// What the last frame was posed for: time, and weight of slot B.
    posed: Option<(f64, f32)>,
    /// Frames for which materials must still be bound anew.
    stale_materials: u8,
    /// Whether the winds of slot A and B have room on this device.
    fits: [bool; 2],
}

impl FromWorld for StandBuffers {
    fn from_world(world: &mut World) -> Self {
        let mut buffers = world.resource_mut::<Assets<ShaderBuffer>>();
        // An empty table is never read; it only has to be there.
        let mut empty = || buffers.add(ShaderBuffer::with_size(FIRST_BYTES as u64, RenderAssetUsages::RENDER_WORLD));
        Self {
            winds: [empty(), empty()],
            beams: empty(),
            trees: empty(),
            chunks: empty(),
            frame: empty(),
            poses: empty(),
            pose_capacity: 0,
            first_half: false,
            sent: [None, None],
            posed: None,
            stale_materials: 0,
            fits: [true; 2],
        }
    }
}

/// The tables of all trees that sway and of the wind, for shaders of your own.
///
/// To draw what rides on trees, import `bevy_windwood::beam`, which has the layouts and `carry`, and find a tree's row in
/// the low 16 bits of its mesh tag. To read the wind, import `bevy_windwood::wind`, which has `velocity_at`, and bind
/// `frame` at 103 and `winds` at 105 and 106 of the material's group.
///
/// The resource counts as changed whenever a buffer has been replaced by one of another size: then touch the materials that
/// are bound to it, so that they are bound anew.
#[derive(Resource, Clone)]
pub struct StandTables {
    /// `array<BeamPose>`: this frame's and the last frame's.
    pub poses: Handle<ShaderBuffer>,
    /// `array<BeamRow>`.
    pub beams: Handle<ShaderBuffer>,
    /// `array<TreeRow>`.
    pub trees: Handle<ShaderBuffer>,
    /// One `Frame`.
    pub frame: Handle<ShaderBuffer>,
    /// `array<vec4<f32>>`: the winds of slot A and B, between which `frame` says how to fade.
    pub winds: [Handle<ShaderBuffer>; 2],
}

impl FromWorld for StandTables {
    fn from_world(world: &mut World) -> Self {
        let StandBuffers { poses, beams, trees, frame, winds, .. } = world.resource::<StandBuffers>();
        Self {
            poses: poses.clone(),
            beams: beams.clone(),
            trees: trees.clone(),
            frame: frame.clone(),
            winds: winds.clone(),
        }
    }
}

/// Buffers and the materials that are bound to them.
#[derive(SystemParam)]
pub(super) struct Uploads<'w> {
    shared: ResMut<'w, StandBuffers>,
    buffers: ResMut<'w, Assets<ShaderBuffer>>,
    writes: ResMut<'w, BufferWrites>,
    materials: ResMut<'w, Assets<SwayMaterial>>,
    tables: ResMut<'w, StandTables>,
}

impl Uploads<'_> {
    /// Sends the rows of a table that were written, and says whether it has outgrown its buffer and got another.
    fn send<T: Pod + Default>(&mut self, handle: &Handle<ShaderBuffer>, table: &mut Table<T>) -> bool {
        let is_renewed = table.make_room();
        if is_renewed {
            self.renew(handle, table.bytes());
        }
        let size = table.bytes() as u64;
        table.send(|first, rows| {
            let offset = u64::from(first) * size_of::<T>() as u64;
            self.writes.write(handle, size, offset, bytemuck::cast_slice(rows));
        });
        is_renewed
    }

    /// Makes room for poses, with a reserve, and says whether there was too little.
    fn make_room(&mut self, poses: u32) -> bool {
        let is_short = poses > self.shared.pose_capacity;
        if is_short {
            self.shared.pose_capacity = with_reserve(poses);
            let handle = self.shared.poses.clone();
            self.renew(&handle, 2 * self.shared.pose_capacity as usize * POSE_BYTES);
        }
        is_short
    }

    /// Another buffer in place of one.
    fn renew(&mut self, handle: &Handle<ShaderBuffer>, bytes: usize) {
        if let Some(mut buffer) = self.buffers.get_mut(handle) {
            *buffer = ShaderBuffer::with_size(bytes as u64, RenderAssetUsages::RENDER_WORLD);
        }
    }

    /// Binds materials to buffers that were replaced: in this frame and once more in the next, since nothing says that a
    /// buffer is prepared before a material.
    fn rebind(&mut self) {
        if self.shared.stale_materials > 0 {
            self.shared.stale_materials -= 1;
            // Iterating mutably marks every material as changed.
            self.materials.iter_mut().for_each(drop);
            // Others who are bound to the tables see this.
            self.tables.set_changed();
        }
    }
}

/// Rewrites a slot when another wind has moved into it; its weight is 0 at that moment. Under a wind whose tables are too
/// large for the device trees stand at rest.
pub(super) fn upload_winds(sway: Res<ActiveSway>, path: Res<DrawPath>, mut warned: Local<bool>, mut uploads: Uploads) {
    for (slot, response) in sway.slots().into_iter().enumerate() {
        let Some(response) = response else { continue };
        if uploads.shared.sent[slot].as_ref().is_some_and(|sent| Arc::ptr_eq(sent, response)) {
            continue;
        }
        let packed = response.take_packed();
        let (bytes, limit) = (packed.len() as u64, path.table_limit_bytes);
        uploads.shared.fits[slot] = bytes <= limit;
        if bytes <= limit {
            let handle = uploads.shared.winds[slot].clone();
            if let Some(mut buffer) = uploads.buffers.get_mut(&handle) {
                let is_resized = buffer.buffer_size() != bytes;
                *buffer = ShaderBuffer::new(packed, RenderAssetUsages::RENDER_WORLD);
                if is_resized {
                    uploads.shared.stale_materials = 2;
                }
            }
        } else if !*warned {
            warn!("windwood: the tables of this wind have {bytes} bytes, the device allows {limit}; trees stand still");
            *warned = true;
        }
        uploads.shared.sent[slot].replace(response.clone()).into_iter().for_each(retire);
    }
}

/// Sends the rows that were written since the last frame, and the clock of this one.
pub(super) fn upload_frame(
    sway: Res<ActiveSway>,
    clock: Res<WindClock>,
    season: Res<Season>,
    sight: Res<Sight>,
    mut stand: ResMut<Stand>,
    mut uploads: Uploads,
    mut job: ResMut<PoseJob>,
) {
    let stand = &mut *stand;
    let rows_changed = stand.trees.has_news() || stand.beams.has_news();
    stand.tidy();
    let StandBuffers { trees, beams, chunks, .. } = &*uploads.shared;
    let [trees, beams, chunks] = [trees, beams, chunks].map(Handle::clone);
    let renewed = [
        uploads.send(&trees, &mut stand.trees),
        uploads.send(&beams, &mut stand.beams),
        uploads.make_room(stand.pose_count()),
    ];
    if renewed.contains(&true) {
        uploads.shared.stale_materials = 2;
    }
    // No material is bound to these.
    uploads.send(&chunks, &mut stand.chunks.table);
    job.chunks = stand.chunks.table.len();
    uploads.rebind();

    let shared = &mut *uploads.shared;
    let [blend, previous_blend] = sway.blends();
    shared.first_half = !shared.first_half;
    job.both = rows_changed || shared.posed != Some((clock.previous_s, previous_blend));
    shared.posed = Some((clock.time_s, blend));
    let row = FrameRow {
        year: season.wrapped(),
        level_ends: sight.ladder.ends,
        cards_from_m: sight.ladder.cards_from_m,
        fade: sight.ladder.fade,
        height_tolerance: LADDER,
        ..frame_row(&sway, &clock, shared, job.chunks)
    };
    uploads.writes.write(&uploads.shared.frame, FIRST_BYTES as u64, 0, bytemuck::bytes_of(&row));
}

fn frame_row(sway: &ActiveSway, clock: &WindClock, shared: &StandBuffers, chunk_count: u32) -> FrameRow {
    let [a, b] = sway.slots();
    let seconds = |slot: Option<&Arc<WindResponse>>, time_s: f64| {
        slot.map_or(0.0, |response| wrapped_time_s(response, time_s) as f32)
    };
    let (now, before) = (clock.time_s, clock.previous_s);
    let halves = if shared.first_half { [0, shared.pose_capacity] } else { [shared.pose_capacity, 0] };
    FrameRow {
        time_s: [seconds(a, now), seconds(b, now), seconds(a, before), seconds(b, before)],
        blend: sway.blends(),
        leaf_time_s: [leaf_clock_s(now), leaf_clock_s(before)],
        poses_now: halves[0],
        poses_before: halves[1],
        ready: u32::from(sway.is_ready() && shared.fits == [true; 2]),
        chunk_count,
        ..default()
    }
}

impl FromWorld for PoseJob {
    fn from_world(world: &mut World) -> Self {
        let shared = world.resource::<StandBuffers>();
        let [a, b] = shared.winds.clone();
        let StandBuffers { beams, trees, chunks, frame, poses, .. } = shared;
        let [beams, trees, chunks, frame, poses] = [beams, trees, chunks, frame, poses].map(Handle::clone);
        Self { buffers: [a, b, beams, trees, chunks, frame, poses], chunks: 0, both: true }
    }
}
