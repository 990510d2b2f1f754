//! Pictures made on the CPU: the canvas on which bark, leaves and ground are painted, with mips.

pub mod canvas;

pub(crate) use canvas::{Canvas, linear, mix};
pub use canvas::{MASK_CUT_OFF, TextureData};
