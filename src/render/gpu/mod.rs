//! The GPU side: uploads and the pose pass.

pub(crate) mod pose_pass;
pub(crate) mod upload;
pub(crate) mod wind_table;
