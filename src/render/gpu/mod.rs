//! The GPU side: uploads and the pose pass.

mod frame_bodies;
pub(crate) mod live_upload;
pub(crate) mod pose_pass;
pub(crate) mod upload;
pub(crate) mod wind_table;
