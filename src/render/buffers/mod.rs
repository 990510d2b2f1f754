//! GPU buffers: which there are, and how parts of them are written.

pub(crate) mod buffer_writes;
pub(crate) mod dirty_table;
pub(crate) mod sway_buffers;
pub(crate) mod table_uploads;
