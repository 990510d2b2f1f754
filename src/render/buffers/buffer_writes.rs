//! Writes parts of GPU buffers, without an allocation a frame.
//!
//! Why not as the data of a [`ShaderBuffer`]: that is uploaded as a whole. In a forest of five thousand trees some rows change in
//! most frames, and uploading all of them took a millisecond of the frame.

use bevy::{
    prelude::*,
    render::{
        ExtractSchedule, MainWorld, Render, RenderApp, RenderSystems,
        render_asset::RenderAssets,
        renderer::RenderQueue,
        storage::{GpuShaderBuffer, ShaderBuffer},
    },
};
use std::{cmp::Ordering, ops::Range};

/// Memory that stays for the writes of later frames: those of some ten thousand rows.
const KEPT_BYTES: usize = 1 << 20;

/// Pending writes in their order: in the main world since the last extraction, in the render world until they are done.
#[derive(Resource, Default)]
pub(crate) struct BufferWrites {
    writes: Vec<Write>,
    bytes: Vec<u8>,
}

struct Write {
    buffer: AssetId<ShaderBuffer>,
    /// The size of the buffer that the write is meant for.
    size: u64,
    offset: u64,
    bytes: Range<usize>,
}

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<BufferWrites>();
    let Some(render_app) = app.get_sub_app_mut(RenderApp) else { return };
    render_app
        .init_resource::<BufferWrites>()
        .add_systems(ExtractSchedule, extract_writes)
        .add_systems(Render, write_buffers.in_set(RenderSystems::PrepareResources));
}

impl BufferWrites {
    /// Writes bytes into a buffer at an offset, once the buffer has that `size`. All sizes are multiples of 4 bytes.
    pub fn write(&mut self, buffer: &Handle<ShaderBuffer>, size: u64, offset: u64, bytes: &[u8]) {
        let begin = self.bytes.len();
        self.bytes.extend_from_slice(bytes);
        self.writes.push(Write { buffer: buffer.id(), size, offset, bytes: begin..self.bytes.len() });
    }

    /// Moves all writes to the end of another list.
    fn append_to(&mut self, other: &mut Self) {
        if other.writes.is_empty() {
            std::mem::swap(self, other);
            return;
        }
        let moved = other.bytes.len();
        other.bytes.append(&mut self.bytes);
        let moves = self.writes.drain(..);
        other
            .writes
            .extend(moves.map(|write| Write { bytes: write.bytes.start + moved..write.bytes.end + moved, ..write }));
    }
}

fn extract_writes(mut main: ResMut<MainWorld>, mut writes: ResMut<BufferWrites>) {
    if let Some(mut pending) = main.get_resource_mut::<BufferWrites>() {
        pending.bypass_change_detection().append_to(&mut writes);
    }
}

/// Does the pending writes. A buffer that grows is replaced by the engine in this frame or the next. Writes for the new one wait for
/// it; writes for the old one are dropped, since the new one is written as a whole.
fn write_buffers(
    mut writes: ResMut<BufferWrites>,
    buffers: Res<RenderAssets<GpuShaderBuffer>>,
    queue: Res<RenderQueue>,
) {
    let BufferWrites { writes, bytes } = &mut *writes;
    writes.retain(|write| {
        let Some(there) = buffers.get(write.buffer) else { return true };
        let age = there.buffer.size().cmp(&write.size);
        if age == Ordering::Equal {
            queue.write_buffer(&there.buffer, write.offset, &bytes[write.bytes.clone()]);
        }
        age == Ordering::Less
    });
    if writes.is_empty() {
        bytes.clear();
        // What is left of a table that was written as a whole would never be needed again.
        bytes.shrink_to(KEPT_BYTES);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn waiting_writes_come_first_and_keep_their_bytes() {
        let buffer = Handle::default();
        let (mut pending, mut waiting) = (BufferWrites::default(), BufferWrites::default());
        for round in 0..3_u8 {
            pending.write(&buffer, 64, 0, &[round; 4]);
            pending.write(&buffer, 64, 8, &[round, 9, 9, 9]);
            pending.append_to(&mut waiting);
            assert!(pending.writes.is_empty() && pending.bytes.is_empty());
        }
        let there: Vec<_> =
            waiting.writes.iter().map(|write| (write.offset, waiting.bytes[write.bytes.clone()][0])).collect();
        assert_eq!(there, [(0, 0), (8, 0), (0, 1), (8, 1), (0, 2), (8, 2)]);
    }
}
