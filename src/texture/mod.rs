//! Textures made on the CPU: images with mips, and textures as functions of place. Pure, and independent of all other
//! rooms.

mod blur;
mod encoding;
pub mod fourier;
mod linear_image;
#[cfg(test)]
pub(crate) mod test_masks;
mod texture_data;

pub(crate) use blur::blurred;
pub(crate) use encoding::{HALF_A_STEP, byte, colour_bytes, linear, linear_bytes, mix};
pub(crate) use linear_image::LinearImage;
pub use texture_data::{MASK_CUT_OFF, Texels, TextureData};
