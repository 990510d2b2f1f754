//! Carries bytes into buffers of the graphics processor: only those that changed, and without an allocation a frame.
//!
//! Why not as the data of a [`ShaderBuffer`]: that is sent as a whole. In a wood of five thousand trees some rows change in
//! most frames, and to send all for them took a millisecond of the frame.

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

/// What is to be written, in this order; in the main world since the last extraction, in the render world until it is done.
#[derive(Resource, Default)]
pub(super) struct BufferWrites {
    writes: Vec<Write>,
    bytes: Vec<u8>,
}

struct Write {
    buffer: AssetId<ShaderBuffer>,
    /// The size of the buffer for which it is meant.
    size: u64,
    offset: u64,
    bytes: Range<usize>,
}

pub(super) fn plugin(app: &mut App) {
    app.init_resource::<BufferWrites>();
    let Some(render_app) = app.get_sub_app_mut(RenderApp) else { return };
    render_app
        .init_resource::<BufferWrites>()
        .add_systems(ExtractSchedule, take_writes)
        .add_systems(Render, write_buffers.in_set(RenderSystems::PrepareResources));
}

impl BufferWrites {
    /// Has bytes written into a buffer at an offset, as soon as it has that `size`; all of them are multiples of 4 bytes.
    pub fn write(&mut self, buffer: &Handle<ShaderBuffer>, size: u64, offset: u64, bytes: &[u8]) {
        let begin = self.bytes.len();
        self.bytes.extend_from_slice(bytes);
        self.writes.push(Write { buffer: buffer.id(), size, offset, bytes: begin..self.bytes.len() });
    }

    /// Moves all of it over to the end of another.
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

fn take_writes(mut main: ResMut<MainWorld>, mut writes: ResMut<BufferWrites>) {
    if let Some(mut sent) = main.get_resource_mut::<BufferWrites>() {
        sent.bypass_change_detection().append_to(&mut writes);
    }
}

/// A buffer that grows is replaced by the engine in this frame or the next: what is meant for the new one waits for it, and
/// what was meant for the old one is in the new one's, which is written as a whole.
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
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_waits_goes_first_and_keeps_its_bytes() {
        let buffer = Handle::default();
        let (mut sent, mut waiting) = (BufferWrites::default(), BufferWrites::default());
        for round in 0..3_u8 {
            sent.write(&buffer, 64, 0, &[round; 4]);
            sent.write(&buffer, 64, 8, &[round, 9, 9, 9]);
            sent.append_to(&mut waiting);
            assert!(sent.writes.is_empty() && sent.bytes.is_empty());
        }
        let there: Vec<_> =
            waiting.writes.iter().map(|write| (write.offset, waiting.bytes[write.bytes.clone()][0])).collect();
        assert_eq!(there, [(0, 0), (8, 0), (0, 1), (8, 1), (0, 2), (8, 2)]);
    }
}
