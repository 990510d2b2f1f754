//! Textures as functions of place, before they are pixels: pure, and knowing no other room.

pub mod fourier;
