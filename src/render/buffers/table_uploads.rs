//! Uploads tables: the rows that were written, into a buffer that grows with the table.

use super::{buffer_writes::BufferWrites, dirty_table::DirtyTable};
use bevy::{asset::RenderAssetUsages, ecs::system::SystemParam, prelude::*, render::storage::ShaderBuffer};
use bytemuck::Pod;

/// Buffers, and how they are written.
#[derive(SystemParam)]
pub(crate) struct TableUploads<'w> {
    pub buffers: ResMut<'w, Assets<ShaderBuffer>>,
    pub writes: ResMut<'w, BufferWrites>,
}

impl TableUploads<'_> {
    /// Uploads the rows of a table that were written. A table that has outgrown its buffer gets another.
    pub fn upload<T: Pod + Default>(&mut self, handle: &Handle<ShaderBuffer>, table: &mut DirtyTable<T>) {
        if table.grow_capacity() {
            self.replace(handle, table.bytes() as u64);
        }
        let size = table.bytes() as u64;
        table.upload(|first, rows| {
            let offset = u64::from(first) * size_of::<T>() as u64;
            self.writes.write(handle, size, offset, bytemuck::cast_slice(rows));
        });
    }

    /// Puts a buffer of another size in the place of one.
    pub fn replace(&mut self, handle: &Handle<ShaderBuffer>, bytes: u64) {
        if let Some(mut buffer) = self.buffers.get_mut(handle) {
            *buffer = ShaderBuffer::with_size(bytes, RenderAssetUsages::RENDER_WORLD);
        }
    }
}
