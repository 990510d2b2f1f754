//! Uploads what changed: the values of the frame, the tables of a wind when a new one begins, and the rows of those trees that come, go,
//! move, or become visible or hidden.

use super::{
    frame_bodies::write_bodies,
    live_upload::LiveUploads,
    pose_pass::{PoseBuffers, PoseDispatch},
};
use crate::{
    background::drop_in_background,
    render::{
        buffers::{
            dirty_table::with_reserve,
            sway_buffers::{FRAME_BYTES, SwayBuffers, empty_buffer},
            table_uploads::TableUploads,
        },
        capabilities::RenderCapabilities,
        gpu::wind_table::pack_wind,
        instances::{
            rows::{FrameRow, POSE_BYTES},
            tables::InstanceTables,
        },
        lod::{thresholds::FADE_LAG, viewers::LodViewers},
    },
    sway::{ActiveSway, Pushers, WindResponse, leaf_clock_s, wrapped_time_s},
    tree::Season,
    wind::{WindClock, WindSources},
};
use bevy::{
    asset::RenderAssetUsages,
    core_pipeline::prepass::MotionVectorPrepass,
    ecs::system::SystemParam,
    prelude::*,
    render::storage::ShaderBuffer,
    tasks::{AsyncComputeTaskPool, Task, block_on, poll_once},
};
use bytemuck::Zeroable;
use std::sync::Arc;

/// What was uploaded so far.
#[derive(Resource)]
pub(crate) struct UploadState {
    workgroups: Handle<ShaderBuffer>,
    /// Poses that a half of the buffer holds.
    pose_capacity: u32,
    /// Whether there is a half for the last frame.
    has_previous_half: bool,
    /// Whether the first half is this frame's.
    is_first_half: bool,
    /// The winds in the slots A and B.
    winds: [Option<Arc<WindResponse>>; 2],
    /// What the last frame was posed for: time, and weight of slot B.
    posed: Option<(f64, f32)>,
    /// Whether the winds of the slots fit on this device.
    fits: [bool; 2],
}

impl FromWorld for UploadState {
    fn from_world(world: &mut World) -> Self {
        Self {
            workgroups: empty_buffer(&mut world.resource_mut::<Assets<ShaderBuffer>>()),
            pose_capacity: 0,
            has_previous_half: false,
            is_first_half: false,
            winds: [None, None],
            posed: None,
            fits: [true; 2],
        }
    }
}

impl FromWorld for PoseDispatch {
    fn from_world(world: &mut World) -> Self {
        let workgroups = world.resource::<UploadState>().workgroups.clone();
        let shared = world.resource::<SwayBuffers>().clone();
        let live = world.resource::<LiveUploads>().buffer.clone();
        Self { buffers: PoseBuffers { shared, workgroups, live }, workgroups: 0, is_previous_due: true }
    }
}

/// The incoming wind's tables as one buffer, packed in the background: they are some 10 MB.
#[derive(Resource, Default)]
pub(crate) struct PackedWind(Option<(Arc<WindResponse>, Packing)>);

enum Packing {
    Running(Task<Vec<u8>>),
    Done(Vec<u8>),
}

impl PackedWind {
    /// The packed tables of a wind, once; they are packed now if they were not before.
    fn take(&mut self, response: &Arc<WindResponse>) -> Vec<u8> {
        match self.0.take_if(|(packed, _)| Arc::ptr_eq(packed, response)) {
            Some((_, Packing::Done(packed))) => packed,
            Some((_, Packing::Running(task))) => block_on(task),
            None => pack_wind(response),
        }
    }
}

/// Packs the tables of an incoming wind in the background, and lets it begin once that is done.
pub(crate) fn pack_incoming_wind(mut sway: ResMut<ActiveSway>, mut packed: ResMut<PackedWind>) {
    let Some(incoming) = sway.incoming().cloned() else { return };
    match &mut packed.0 {
        Some((response, packing)) if Arc::ptr_eq(response, &incoming) => {
            if let Packing::Running(task) = packing
                && let Some(bytes) = block_on(poll_once(task))
            {
                *packing = Packing::Done(bytes);
                sway.release_incoming();
            }
        }
        other => {
            let response = incoming.clone();
            let task = AsyncComputeTaskPool::get().spawn(async move { pack_wind(&response) });
            *other = Some((incoming, Packing::Running(task)));
        }
    }
}

/// The buffers of trees, and what is in them.
#[derive(SystemParam)]
pub(crate) struct Uploads<'w> {
    shared: Res<'w, SwayBuffers>,
    state: ResMut<'w, UploadState>,
    tables: TableUploads<'w>,
}

impl Uploads<'_> {
    /// Grows the buffer of poses, with a reserve. It has a half for the last frame from the first camera on that asks for motion vectors.
    fn grow_poses(&mut self, tables: &mut InstanceTables, most_poses: u32, needs_previous: bool) {
        let state = &mut *self.state;
        let (poses, gets_half) = (tables.pose_count(), needs_previous && !state.has_previous_half);
        if poses > state.pose_capacity {
            state.pose_capacity = with_reserve(poses).min(most_poses).max(poses);
        } else if !gets_half {
            return;
        }
        state.has_previous_half |= gets_half;
        if gets_half {
            state.posed = None;
        }
        tables.pose_capacity = state.pose_capacity * if state.has_previous_half { 2 } else { 1 };
        self.tables.replace(&self.shared.poses, u64::from(tables.pose_capacity.max(1)) * POSE_BYTES as u64);
    }
}

/// All that was uploaded has gone, with the device.
pub(crate) fn forget_uploads(
    mut tables: ResMut<InstanceTables>,
    mut state: ResMut<UploadState>,
    mut live: ResMut<LiveUploads>,
) {
    tables.forget_buffers();
    live.forget_buffer();
    *state = UploadState {
        workgroups: state.workgroups.clone(),
        pose_capacity: 0,
        has_previous_half: false,
        winds: [None, None],
        posed: None,
        ..*state
    };
}

/// Rewrites a slot when another wind has moved into it; its weight is 0 at that moment. Under a wind whose tables are too large for the
/// device trees stand at rest.
pub(crate) fn upload_winds(
    sway: Res<ActiveSway>,
    capabilities: Res<RenderCapabilities>,
    mut packed: ResMut<PackedWind>,
    mut has_warned: Local<bool>,
    mut uploads: Uploads,
) {
    for (slot, response) in sway.slots().into_iter().enumerate() {
        let Some(response) = response else { continue };
        if uploads.state.winds[slot].as_ref().is_some_and(|uploaded| Arc::ptr_eq(uploaded, response)) {
            continue;
        }
        let packed = packed.take(response);
        let (bytes, limit) = (packed.len() as u64, capabilities.max_table_bytes);
        uploads.state.fits[slot] = bytes <= limit;
        if bytes <= limit {
            let handle = uploads.shared.winds[slot].clone();
            if let Some(mut buffer) = uploads.tables.buffers.get_mut(&handle) {
                *buffer = ShaderBuffer::new(packed, RenderAssetUsages::RENDER_WORLD);
            }
        } else if !*has_warned {
            warn!("windwood: the tables of this wind have {bytes} bytes, the device allows {limit}; trees stand still");
            *has_warned = true;
        }
        uploads.state.winds[slot].replace(response.clone()).into_iter().for_each(drop_in_background);
    }
}

/// Uploads the rows that were written since the last frame, and the values of this one.
pub(crate) fn upload_frame(
    sway: Res<ActiveSway>,
    clock: Res<WindClock>,
    season: Res<Season>,
    viewers: Res<LodViewers>,
    (sources, pushers, live): (Res<WindSources>, Res<Pushers>, Res<LiveUploads>),
    (capabilities, moving): (Res<RenderCapabilities>, Query<(), With<MotionVectorPrepass>>),
    mut tables: ResMut<InstanceTables>,
    mut uploads: Uploads,
    mut dispatch: ResMut<PoseDispatch>,
) {
    let tables = &mut *tables;
    let has_new_rows = tables.trees.is_dirty() || tables.beams.is_dirty();
    tables.compact();
    let (shared, workgroups) = (uploads.shared.clone(), uploads.state.workgroups.clone());
    uploads.tables.upload(&shared.trees, &mut tables.trees);
    uploads.tables.upload(&shared.beams, &mut tables.beams);
    uploads.tables.upload(&workgroups, &mut tables.workgroups.table);
    uploads.grow_poses(tables, capabilities.max_poses, !moving.is_empty());

    let state = &mut *uploads.state;
    let [blend, previous_blend] = sway.blends();
    state.is_first_half = !state.is_first_half;
    dispatch.workgroups = tables.workgroups.table.len();
    let is_posed = !has_new_rows && state.posed == Some((clock.previous_s, previous_blend));
    dispatch.is_previous_due = state.has_previous_half && !is_posed;
    state.posed = Some((clock.time_s, blend));
    let mut row = frame_row(&sway, &clock, &season, &viewers, state, dispatch.workgroups);
    [row.live_now, row.live_before] = live.halves();
    write_bodies(&mut row, &sources, &pushers, |place| viewers.distance(place).m);
    uploads.tables.writes.write(&shared.frame, FRAME_BYTES, 0, bytemuck::bytes_of(&row));
}

fn frame_row(
    sway: &ActiveSway,
    clock: &WindClock,
    season: &Season,
    viewers: &LodViewers,
    state: &UploadState,
    workgroup_count: u32,
) -> FrameRow {
    let [a, b] = sway.slots();
    let seconds = |slot: Option<&Arc<WindResponse>>, time_s: f64| {
        slot.map_or(0.0, |response| wrapped_time_s(response, time_s) as f32)
    };
    let (now, before) = (clock.time_s, clock.previous_s);
    let halves = match (state.has_previous_half, state.is_first_half) {
        (false, _) => [0, 0],
        (true, true) => [0, state.pose_capacity],
        (true, false) => [state.pose_capacity, 0],
    };
    let mut row = FrameRow {
        time_s: [seconds(a, now), seconds(b, now), seconds(a, before), seconds(b, before)],
        blend: sway.blends(),
        leaf_time_s: [leaf_clock_s(now), leaf_clock_s(before)],
        poses_now: halves[0],
        poses_before: halves[1],
        ready: u32::from(sway.is_ready() && state.fits == [true; 2]),
        workgroup_count,
        year: season.wrapped(),
        lod_ends: viewers.thresholds.ends,
        fade: viewers.thresholds.fade,
        impostor_fade: viewers.thresholds.impostor_fade,
        fade_lag: FADE_LAG,
        viewer_count: 0,
        shadow_end: viewers.thresholds.shadow_end,
        ..FrameRow::zeroed()
    };
    for (place, viewer) in row.viewers.iter_mut().zip(viewers.iter()) {
        *place = viewer.eye.extend(viewer.factor()).to_array();
        row.viewer_count += 1;
    }
    row
}
