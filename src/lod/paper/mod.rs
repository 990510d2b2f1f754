//! The lower levels of Setas, Gomes & Rebordão, section 4.1.2: an envelope of leaves around the trunk, and four polygons.

pub(super) mod cylindrical;
pub(super) mod envelope;
mod main_stem;
pub(super) mod polygons;
pub(super) mod profile;
pub(super) mod sway_frames;
