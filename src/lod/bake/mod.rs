//! From a tree's meshes to textures: rays, what they hit, and texels.
//!
//! A [`scene`] is a tree that rays can hit. A raster sends many rays through it at once: [`rasterise`] parallel ones, and
//! [`cylindrical`](super::paper::cylindrical) ones that lead to an axis. [`texels`] gathers what they hit into textures.

pub(super) mod rasterise;
pub(super) mod scene;
pub(super) mod texels;
mod texture_lookup;
