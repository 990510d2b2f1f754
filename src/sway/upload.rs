//! Sends what changed to the graphics processor: the clock each frame, a wind's tables when a new wind begins.

use super::{
    active::{ActiveSway, leaf_clock_s, wrapped_time_s},
    material::SwayMaterial,
    response::WindResponse,
    rows::{FrameRow, slot_rows},
};
use crate::wind::WindClock;
use bevy::{asset::RenderAssetUsages, prelude::*, render::storage::ShaderBuffer};
use std::sync::Arc;

/// The buffers that all swaying materials share.
#[derive(Resource)]
pub(super) struct WindBuffers {
    /// Slots A and B, see [`ActiveSway`].
    pub slots: [Handle<ShaderBuffer>; 2],
    /// One [`FrameRow`].
    pub frame: Handle<ShaderBuffer>,
    /// What was last sent to each slot, and its size in bytes.
    sent: [Option<(Arc<WindResponse>, usize)>; 2],
}

impl FromWorld for WindBuffers {
    fn from_world(world: &mut World) -> Self {
        let mut buffers = world.resource_mut::<Assets<ShaderBuffer>>();
        // A slot without a wind is never read (`FrameRow::ready`, weight 0); it only has to be there.
        let mut empty = |bytes: &[u8]| buffers.add(ShaderBuffer::new(bytes, RenderAssetUsages::RENDER_WORLD));
        Self {
            slots: [empty(&[0; 64]), empty(&[0; 64])],
            frame: empty(bytemuck::bytes_of(&FrameRow::default())),
            sent: [None, None],
        }
    }
}

/// Rewrites a slot when another wind has moved into it; its weight is 0 at that moment.
pub(super) fn upload_tables(
    sway: Res<ActiveSway>,
    mut winds: ResMut<WindBuffers>,
    mut buffers: ResMut<Assets<ShaderBuffer>>,
    mut materials: ResMut<Assets<SwayMaterial>>,
    mut stale_materials: Local<u8>,
) {
    for (slot, response) in sway.slots().into_iter().enumerate() {
        let Some(response) = response else { continue };
        if winds.sent[slot].as_ref().is_some_and(|(sent, _)| Arc::ptr_eq(sent, response)) {
            continue;
        }
        let rows = slot_rows(response);
        let bytes: &[u8] = bytemuck::cast_slice(&rows);
        if let Some(mut buffer) = buffers.get_mut(&winds.slots[slot]) {
            buffer.data = Some(bytes.to_vec());
        }
        if winds.sent[slot].as_ref().is_none_or(|(_, size)| *size != bytes.len()) {
            *stale_materials = 2;
        }
        winds.sent[slot] = Some((response.clone(), bytes.len()));
    }
    // A buffer of another size is another buffer: whoever is bound to it must be bound anew, and once more in the next
    // frame, since nothing says that the buffer is prepared before the material.
    if *stale_materials > 0 {
        *stale_materials -= 1;
        // Iterating mutably marks every material as changed.
        materials.iter_mut().for_each(drop);
    }
}

/// Writes the clock of this frame. In place: the materials that read it do not change.
pub(super) fn upload_frame(
    sway: Res<ActiveSway>,
    clock: Res<WindClock>,
    winds: Res<WindBuffers>,
    mut buffers: ResMut<Assets<ShaderBuffer>>,
) {
    let [a, b] = sway.slots();
    let seconds = |slot: Option<&Arc<WindResponse>>, time_s: f64| {
        slot.map_or(0.0, |response| wrapped_time_s(response, time_s) as f32)
    };
    let (now, before) = (clock.time_s, clock.previous_s);
    let row = FrameRow {
        time_s: [seconds(a, now), seconds(b, now), seconds(a, before), seconds(b, before)],
        blend: sway.blends(),
        leaf_time_s: [leaf_clock_s(now), leaf_clock_s(before)],
        ready: if sway.is_ready() { 1.0 } else { 0.0 },
        padding: [0.0; 3],
    };
    if let Some(mut buffer) = buffers.get_mut(&winds.frame) {
        // Extraction takes the bytes away, so a few are allocated anew each frame: 48, whatever the forest.
        buffer.data = Some(bytemuck::bytes_of(&row).to_vec());
    }
}
