//! Maps as assets; systems and resources of drawn ground.

pub(super) mod elevation_loader;
#[cfg(feature = "render")]
pub(super) mod stream;
pub(super) mod terrain_file;
