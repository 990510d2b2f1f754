//! Pictures made on the processor: the canvas on which bark, leaves and ground are painted, with mips, and textures as
//! functions of place, before they are pixels. Pure, and knowing no other room.

mod blur;
pub mod canvas;
pub mod fourier;

pub(crate) use blur::blurred;
pub(crate) use canvas::{Canvas, HALF_A_STEP, byte, colour_bytes, linear, linear_bytes, mix};
pub use canvas::{MASK_CUT_OFF, Texels, TextureData};
