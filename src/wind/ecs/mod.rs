//! The resources of the wind, with the systems that update them.

pub(super) mod active;
pub(super) mod clock;
pub(super) mod sources;
