//! LOD selection: which levels of a tree are drawn, by its size on the pictures of the cameras.

pub(crate) mod select;
pub(crate) mod thresholds;
pub(crate) mod viewers;
pub(crate) mod want_parts;
