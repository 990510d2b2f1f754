//! Forests that move in a physically synthesised wind.

pub mod dynamics;
pub mod sway;
pub mod tree;
pub mod wind;
