//! The systems, and what a game's own systems ask.

#[cfg(feature = "avian")]
pub(super) mod avian;
pub(super) mod canopy_wind;
pub(super) mod colliders;
pub(super) mod listen;
#[cfg(feature = "picking")]
pub(super) mod picking;
pub(super) mod rays;
